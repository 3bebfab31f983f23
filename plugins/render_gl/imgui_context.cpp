#include "imgui_context.h"

#include <epoxy/gl.h>

#include <imgui_impl_opengl3.h>

namespace kolize::gl {

ImGuiGuard::ImGuiGuard() : context_(ImGui::CreateContext()) {
    use();
    ImGui::GetIO().IniFilename = nullptr;  // nothing is remembered in files
    ImGui::GetIO().LogFilename = nullptr;
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

ImGuiGuard::~ImGuiGuard() {
    use();
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext(context_);
}

void ImGuiGuard::begin_frame(int width, int height) {
    use();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
}

// The back end writes colours as they are: OpenGL must not take them for linear ones.
void ImGuiGuard::end_frame() {
    ImGui::Render();
    glDisable(GL_FRAMEBUFFER_SRGB);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glEnable(GL_FRAMEBUFFER_SRGB);
}

void ImGuiGuard::upload_fonts() {
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
}

}  // namespace kolize::gl
