#include "panel_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace kolize::gl {
namespace {

// Okabe and Ito, Color Universal Design (2008).
constexpr ImU32 colours[] = {IM_COL32(86, 180, 233, 255), IM_COL32(230, 159, 0, 255), IM_COL32(0, 158, 115, 255),
                             IM_COL32(204, 121, 167, 255), IM_COL32(240, 228, 66, 255)};
constexpr ImU32 mark_colour = IM_COL32(255, 255, 255, 130);

// 1, 2 or 5 times a power of ten, so that the scale does not tremble.
double round_up(double value) {
    if (!(value > 0)) return 1;
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0})
        if (value <= step * power) return step * power;
    return 10 * power;
}

struct Frame {
    ImVec2 corner, size;
    std::size_t count;  // values across
    double top;         // value at the upper border

    float x(double place) const {
        return corner.x + size.x * static_cast<float>(place / static_cast<double>(std::max<std::size_t>(count, 2) - 1));
    }
    float y(double value) const {
        return corner.y + size.y * (1 - static_cast<float>(std::clamp(value / top, 0.0, 1.0)));
    }
};

// The scale leaves out the highest spikes: one slow step would flatten all the others.
double usual_top(const PanelItem& item) {
    std::vector<float> all;
    for (const PanelSeries& series : item.series)
        for (const float value : series.values)
            if (std::isfinite(value)) all.push_back(value);
    if (all.empty()) return 0;
    const auto place = all.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), place, all.end());
    return 1.2 * static_cast<double>(*place);
}

Frame frame_of(const PanelItem& item) {
    std::size_t count = 0;
    for (const PanelSeries& series : item.series) count = std::max(count, series.values.size());
    return {ImGui::GetCursorScreenPos(), {ImGui::GetContentRegionAvail().x, 90}, count, round_up(usual_top(item))};
}

void draw_series(const PanelSeries& series, const Frame& frame, ImU32 colour) {
    std::vector<ImVec2> points;
    for (std::size_t i = 0; i < series.values.size(); ++i)
        if (std::isfinite(series.values[i]))
            points.push_back({frame.x(static_cast<double>(i)), frame.y(series.values[i])});
    ImGui::GetWindowDrawList()->AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, 1.2f);
}

}  // namespace

void draw_graph(const PanelItem& item) {
    const Frame frame = frame_of(item);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end{frame.corner.x + frame.size.x, frame.corner.y + frame.size.y};
    list.AddRectFilled(frame.corner, end, IM_COL32(20, 24, 30, 255));
    for (const PanelMark& mark : item.marks) {
        const float x = frame.x(static_cast<double>(mark.before));
        list.AddLine({x, frame.corner.y}, {x, end.y}, mark_colour);
        list.AddText({x + 3, end.y - 16}, mark_colour, mark.label.c_str());
    }
    for (std::size_t i = 0; i < item.series.size(); ++i)
        draw_series(item.series[i], frame, colours[i % std::size(colours)]);
    char top[64];
    std::snprintf(top, sizeof top, "%g %s", frame.top, item.label.c_str());
    list.AddText({frame.corner.x + 3, frame.corner.y + 1}, IM_COL32(255, 255, 255, 170), top);
    ImGui::Dummy(frame.size);
    for (std::size_t i = 0; i < item.series.size(); ++i) {
        if (i % 4) ImGui::SameLine();
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(colours[i % std::size(colours)]), "%s",
                           item.series[i].name.c_str());
    }
}

}  // namespace kolize::gl
