#include "window.h"

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stdexcept>

namespace kolize::gl {
namespace {

std::string last_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "GLFW gives no reason";
}

[[noreturn]] void refuse(const std::string& reason) {
    throw std::runtime_error("no window: " + reason +
                             " (without a display, kolize run --frames or --video draws, or Xvfb stands in for one)");
}

// Once a process; it stays, as the EGL display does.
void start_glfw() {
    static const bool started = glfwInit();
    if (!started) refuse(last_error());
}

GLFWwindow* open(const std::string& title, int width, int height) {
    start_glfw();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    GLFWwindow* const window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window) refuse(last_error());
    return window;
}

Key key_of(int code) {
    switch (code) {
    case GLFW_KEY_ESCAPE: return Key::escape;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER: return Key::enter;
    case GLFW_KEY_TAB: return Key::tab;
    case GLFW_KEY_BACKSPACE: return Key::backspace;
    case GLFW_KEY_LEFT: return Key::left;
    case GLFW_KEY_RIGHT: return Key::right;
    case GLFW_KEY_UP: return Key::up;
    case GLFW_KEY_DOWN: return Key::down;
    case GLFW_KEY_HOME: return Key::home;
    case GLFW_KEY_END: return Key::end;
    case GLFW_KEY_PAGE_UP: return Key::page_up;
    case GLFW_KEY_PAGE_DOWN: return Key::page_down;
    case GLFW_KEY_LEFT_SHIFT:
    case GLFW_KEY_RIGHT_SHIFT: return Key::shift;
    case GLFW_KEY_LEFT_CONTROL:
    case GLFW_KEY_RIGHT_CONTROL: return Key::control;
    case GLFW_KEY_LEFT_ALT:
    case GLFW_KEY_RIGHT_ALT: return Key::alt;
    case GLFW_KEY_KP_SUBTRACT: return Key::minus;
    case GLFW_KEY_KP_ADD: return Key::equal;
    default: break;
    }
    if (code >= GLFW_KEY_F1 && code <= GLFW_KEY_F12)
        return static_cast<Key>(static_cast<std::uint32_t>(Key::f1) + static_cast<std::uint32_t>(code - GLFW_KEY_F1));
    const bool has_name = (code >= GLFW_KEY_A && code <= GLFW_KEY_Z) || (code >= GLFW_KEY_0 && code <= GLFW_KEY_9) ||
                          code == GLFW_KEY_SPACE || code == GLFW_KEY_MINUS || code == GLFW_KEY_PERIOD ||
                          code == GLFW_KEY_EQUAL;
    return has_name ? static_cast<Key>(code) : Key::unknown;
}

}  // namespace

GlfwWindow::GlfwWindow(const std::string& title, int width, int height) : window_(open(title, width, height)) {
    make_current();
    glfwSwapInterval(1);
    glfwGetFramebufferSize(window_, &width_, &height_);
    panel_ = std::make_unique<PanelView>();
    listen();
}

GlfwWindow::~GlfwWindow() {
    make_current();
    panel_.reset();
    let_go();
    glfwDestroyWindow(window_);
}

void GlfwWindow::acquire() { glfwMakeContextCurrent(window_); }
void GlfwWindow::release() { glfwMakeContextCurrent(nullptr); }

GlfwWindow& GlfwWindow::of(GLFWwindow* window) { return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window)); }

void GlfwWindow::listen() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) { of(w).add({WindowEventKind::closed}); });
    glfwSetFramebufferSizeCallback(window_,
                                   [](GLFWwindow* w, int width, int height) { of(w).set_size(width, height); });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int code, int, int action, int mods) {
        const Key key = key_of(code);
        of(w).panel_->key(key, action != GLFW_RELEASE, mods & GLFW_MOD_CONTROL, mods & GLFW_MOD_SHIFT);
        if (action == GLFW_REPEAT || key == Key::unknown) return;
        WindowEvent event{action == GLFW_PRESS ? WindowEventKind::key_down : WindowEventKind::key_up, key};
        event.control = mods & GLFW_MOD_CONTROL;
        event.shift = mods & GLFW_MOD_SHIFT;
        of(w).add(event);
    });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned int letter) { of(w).panel_->letter(letter); });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
        of(w).panel_->button(button, action == GLFW_PRESS);
        WindowEvent event{action == GLFW_PRESS ? WindowEventKind::button_down : WindowEventKind::button_up};
        event.button = static_cast<std::uint32_t>(button);
        event.control = mods & GLFW_MOD_CONTROL;
        event.shift = mods & GLFW_MOD_SHIFT;
        of(w).add(event);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
        GlfwWindow& self = of(w);
        self.x_ = x * self.pixels();
        self.y_ = y * self.pixels();
        self.panel_->pointer(self.x_, self.y_);
        self.add({WindowEventKind::pointer});
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
        of(w).panel_->scroll(x, y);
        WindowEvent event{WindowEventKind::scroll};
        event.x = x, event.y = y;
        of(w).add(event);
    });
}

double GlfwWindow::pixels() const {
    int wide = 0, high = 0;
    glfwGetWindowSize(window_, &wide, &high);
    return wide > 0 ? static_cast<double>(width_) / wide : 1;
}

void GlfwWindow::set_size(int width, int height) {
    if (width < 1 || height < 1) return;  // put away
    width_ = width;
    height_ = height;
    WindowEvent event{WindowEventKind::resized};
    event.x = width, event.y = height;
    events_.push_back(event);
}

// What the panel takes is not reported; a button or key that went down outside it is, until it is up again.
void GlfwWindow::add(WindowEvent event) {
    const std::uint32_t bit = 1u << event.button;
    const auto key = static_cast<std::size_t>(event.key);
    switch (event.kind) {
    case WindowEventKind::key_down:
        if (panel_->takes_keys()) return;
        reported_keys_.set(key);
        break;
    case WindowEventKind::key_up:
        if (!reported_keys_.test(key)) return;
        reported_keys_.reset(key);
        break;
    case WindowEventKind::button_down:
        if (panel_->takes_pointer()) return;
        reported_buttons_ |= bit;
        break;
    case WindowEventKind::button_up:
        if (!(reported_buttons_ & bit)) return;
        reported_buttons_ &= ~bit;
        break;
    case WindowEventKind::pointer:
    case WindowEventKind::scroll:
        if (panel_->takes_pointer() && !reported_buttons_) return;
        break;
    default: break;
    }
    if (event.kind != WindowEventKind::scroll) event.x = x_, event.y = y_;
    events_.push_back(event);
}

void GlfwWindow::poll(std::vector<WindowEvent>& events) {
    glfwPollEvents();
    events.insert(events.end(), events_.begin(), events_.end());
    events_.clear();
}

void GlfwWindow::show(Target& target, Panel* panel) {
    make_current();
    target.copy_to_window(width_, height_);
    panel_->show(panel, width_, height_);
    glfwSwapBuffers(window_);
}

}  // namespace kolize::gl
