#include "text.h"

#include <algorithm>
#include <cmath>

namespace kolize::gl {
namespace {

int pixels_of(const Caption& caption, int height) {
    return std::clamp(static_cast<int>(std::lround(caption.height * height)), 4, 256);
}

ImU32 colour_of(const Rgba& c, double opacity = 1) {
    return IM_COL32(c[0], c[1], c[2], static_cast<int>(std::lround(c[3] * opacity)));
}

}  // namespace

// The font is drawn for each height anew: scaled letters would be blurred.
void Text::make_fonts(std::span<const Caption> captions, int height) {
    bool any = false;
    for (const Caption& caption : captions) any |= fonts_.try_emplace(pixels_of(caption, height), nullptr).second;
    if (!any) return;
    context_.use();
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    for (auto& [pixels, font] : fonts_) {
        ImFontConfig config;
        config.SizePixels = static_cast<float>(pixels);
        config.OversampleH = config.OversampleV = pixels % 13 ? 3 : 1;  // it is made for 13 pixels
        font = atlas.AddFontDefault(&config);
    }
    atlas.Build();
    context_.upload_fonts();
}

void Text::draw(std::span<const Caption> captions, int width, int height) {
    if (captions.empty()) return;
    make_fonts(captions, height);
    context_.begin_frame(width, height);
    for (const Caption& caption : captions) add(caption, width, height);
    context_.end_frame();
}

// A dark rim makes it legible on everything.
void Text::add(const Caption& caption, int width, int height) {
    const int pixels = pixels_of(caption, height);
    ImFont* const font = fonts_.at(pixels);
    const auto size_of = static_cast<float>(pixels);
    const ImVec2 size = font->CalcTextSizeA(size_of, FLT_MAX, 0, caption.text.c_str());
    const auto place = [](double at, int picture, double anchor, float length) {
        return static_cast<float>(std::floor(at * picture - anchor * static_cast<double>(length)));
    };
    const float x = place(caption.x, width, caption.anchor_x, size.x);
    const float y = place(caption.y, height, caption.anchor_y, size.y);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto write = [&](float dx, float dy, ImU32 colour) {
        list.AddText(font, size_of, {x + dx, y + dy}, colour, caption.text.c_str());
    };
    const float rim = std::max(1.0f, std::round(size_of / 18));
    const ImU32 dark = colour_of({0, 0, 0, caption.colour[3]}, 0.55);
    for (const float dx : {-rim, 0.0f, rim})
        for (const float dy : {-rim, 0.0f, rim})
            if (dx != 0 || dy != 0) write(dx, dy, dark);
    write(0, 0, colour_of(caption.colour));
}

}  // namespace kolize::gl
