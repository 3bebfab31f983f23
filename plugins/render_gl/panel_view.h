// A panel by Dear ImGui. What the user does with keys and pointer is handed on to it by the window.
#pragma once

#include "imgui_context.h"

#include <kolize/window.h>

#include <array>
#include <bitset>
#include <map>
#include <string>

namespace kolize::gl {

class PanelView {
public:
    PanelView();

    void key(Key key, bool down, bool control, bool shift);
    void letter(unsigned int code);
    void pointer(double x, double y);
    void button(int number, bool down);
    void scroll(double x, double y);
    // Whether the user is busy with the panel.
    bool takes_keys() const;
    bool takes_pointer() const;

    // Draws it, unless it is null, on the window of this size, and writes what the user has changed.
    void show(Panel* panel, int width, int height);

private:
    void hand_over_input();
    void show_item(PanelItem& item);
    void show_value(PanelItem& item);
    void edit_number(PanelItem& item);
    void edit_word(PanelItem& item);

    ImGuiGuard context_;
    // What is held, and what was pressed since the last picture, however shortly.
    std::array<bool, 3> held_{}, pressed_{};  // buttons
    std::bitset<512> held_keys_, pressed_keys_;
    bool control_ = false, shift_ = false;  // of the last key that was pressed or let go
    bool pressed_control_ = false, pressed_shift_ = false;
    std::map<std::string, std::string> words_;  // texts that are being edited, by id
    std::map<std::string, double> numbers_;     // likewise
};

// Series on one scale from 0, the newest value at the right border; marks across.
void draw_graph(const PanelItem& item);

}  // namespace kolize::gl
