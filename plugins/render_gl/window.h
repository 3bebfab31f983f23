// A window by GLFW, and the panel in it by Dear ImGui.
#pragma once

#include "context.h"
#include "panel_view.h"
#include "target.h"

#include <kolize/window.h>

#include <bitset>
#include <string>

struct GLFWwindow;

namespace kolize::gl {

// The window's own OpenGL context; it lives as long as the window.
class GlfwWindow final : public Context {
public:
    // Throws std::runtime_error with one sentence where there is no display. Current when it is made.
    GlfwWindow(const std::string& title, int width, int height);
    GlfwWindow(const GlfwWindow&) = delete;
    GlfwWindow& operator=(const GlfwWindow&) = delete;
    ~GlfwWindow() override;

    int width() const { return width_; }
    int height() const { return height_; }
    void poll(std::vector<WindowEvent>& events);
    void show(Target& target, Panel* panel);

private:
    void acquire() override;
    void release() override;
    static GlfwWindow& of(GLFWwindow* window);
    void listen();
    void add(WindowEvent event);
    void set_size(int width, int height);
    double pixels() const;  // of a screen coordinate

    GLFWwindow* window_;
    int width_ = 0, height_ = 0;
    double x_ = 0, y_ = 0;                // of the pointer
    std::uint32_t reported_buttons_ = 0;  // bits of those that went down outside the panel
    std::bitset<512> reported_keys_;      // likewise
    std::vector<WindowEvent> events_;
    std::unique_ptr<PanelView> panel_;
};

}  // namespace kolize::gl
