// A window on the screen: what the user does in it, and the picture and the panel that it shows.
#pragma once

#include <kolize/export.h>
#include <kolize/panel.h>

#include <cstdint>
#include <vector>

namespace kolize {

// Letters and digits have their (upper-case) ASCII codes. A key is where it stands on a US keyboard.
enum class Key : std::uint32_t {
    unknown = 0,
    space = ' ',
    minus = '-',
    period = '.',
    equal = '=',
    digit_0 = '0',
    digit_1,
    digit_2,
    digit_3,
    digit_4,
    digit_5,
    digit_6,
    digit_7,
    digit_8,
    digit_9,
    a = 'A',
    b,
    c,
    d,
    e,
    f,
    g,
    h,
    i,
    j,
    k,
    l,
    m,
    n,
    o,
    p,
    q,
    r,
    s,
    t,
    u,
    v,
    w,
    x,
    y,
    z,
    escape = 256,
    enter,
    tab,
    backspace,
    left,
    right,
    up,
    down,
    home,
    end,
    page_up,
    page_down,
    shift,
    control,
    alt,
    f1,
    f2,
    f3,
    f4,
    f5,
    f6,
    f7,
    f8,
    f9,
    f10,
    f11,
    f12
};

enum class WindowEventKind : std::uint32_t {
    key_down,  // once, however long it is held
    key_up,
    button_down,
    button_up,
    pointer,  // it moved
    scroll,
    resized,
    closed
};

struct WindowEvent {
    WindowEventKind kind = WindowEventKind::closed;
    Key key = Key::unknown;    // key_down, key_up; left and right shift are one key, and so on
    std::uint32_t button = 0;  // button_down, button_up: 0 left, 1 right, 2 middle
    bool control = false;      // held when it happened
    bool shift = false;
    // Pixels from the left and from the top: of the pointer; resized: the new width and height; scroll: notches to the
    // right and upward.
    double x = 0, y = 0;
};

class KOLIZE_API Window {
public:
    virtual ~Window() = default;
    virtual int width() const = 0;  // pixels
    virtual int height() const = 0;
    // Appends what has happened since the last call, but for what the panel took. Does not wait.
    virtual void poll(std::vector<WindowEvent>& events) = 0;
    // Shows the frame drawn last, and over it the panel, unless that is null; writes into the panel what the user did.
    virtual void present(Panel* panel) = 0;
};

}  // namespace kolize
