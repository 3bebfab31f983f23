// Draws captions over the picture, by Dear ImGui's own font.
#pragma once

#include "imgui_context.h"

#include <kolize/renderer.h>

#include <map>

namespace kolize::gl {

class Text {
public:
    // On whatever is being drawn on, with sizes in pixels. Colours come out as they are given.
    void draw(std::span<const Caption> captions, int width, int height);

private:
    void make_fonts(std::span<const Caption> captions, int height);
    void add(const Caption& caption, int width, int height);

    ImGuiGuard context_;
    std::map<int, ImFont*> fonts_;  // by height in pixels
};

}  // namespace kolize::gl
