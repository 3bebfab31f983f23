// A context of Dear ImGui with its OpenGL 3 back end. All members are called, and the object is made and destroyed,
// while the OpenGL context that it belongs to is current.
#pragma once

#include <imgui.h>

namespace kolize::gl {

class ImGuiGuard {
public:
    ImGuiGuard();
    ImGuiGuard(const ImGuiGuard&) = delete;
    ImGuiGuard& operator=(const ImGuiGuard&) = delete;
    ~ImGuiGuard();

    // Begins a frame for a picture of this size in pixels; what is drawn until end_frame goes there.
    void begin_frame(int width, int height);
    void end_frame();
    // After fonts were added.
    void upload_fonts();
    // Makes it the one that ImGui's functions are about.
    void use() const { ImGui::SetCurrentContext(context_); }

private:
    ImGuiContext* context_;
};

}  // namespace kolize::gl
