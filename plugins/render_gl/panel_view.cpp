#include "panel_view.h"

#include <epoxy/gl.h>

#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdio>

namespace kolize::gl {
namespace {

constexpr float panel_width = 340;  // pixels

void set_keys(ImGuiIO& io) {
    const std::pair<ImGuiKey, Key> keys[] = {
        {ImGuiKey_Tab, Key::tab},       {ImGuiKey_LeftArrow, Key::left},      {ImGuiKey_RightArrow, Key::right},
        {ImGuiKey_UpArrow, Key::up},    {ImGuiKey_DownArrow, Key::down},      {ImGuiKey_Home, Key::home},
        {ImGuiKey_End, Key::end},       {ImGuiKey_Backspace, Key::backspace}, {ImGuiKey_Enter, Key::enter},
        {ImGuiKey_Escape, Key::escape}, {ImGuiKey_Space, Key::space},         {ImGuiKey_A, Key::a}};
    for (const auto& [theirs, ours] : keys) io.KeyMap[theirs] = static_cast<int>(ours);
}

std::string with_unit(const PanelItem& item) { return item.unit.empty() ? item.label : item.label + ", " + item.unit; }

// "from 1 to 64", with what of it is bounded; "" for what is no number.
std::string range_of(const PanelItem& item) {
    if (item.kind != PanelItemKind::integer && item.kind != PanelItemKind::number) return "";
    constexpr double unbounded = 1e300;
    char text[96] = "";
    if (item.min > -unbounded && item.max < unbounded)
        std::snprintf(text, sizeof text, "from %g to %g %s", item.min, item.max, item.unit.c_str());
    else if (item.min > -unbounded)
        std::snprintf(text, sizeof text, "from %g %s", item.min, item.unit.c_str());
    return text;
}

void explain(const PanelItem& item) {
    const std::string range = range_of(item);
    if ((item.help.empty() && range.empty()) || !ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(400);
    ImGui::TextUnformatted(item.help.c_str());
    if (!range.empty()) ImGui::TextUnformatted(range.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void choose(PanelItem& item) {
    auto& value = std::get<std::string>(item.value);
    if (!ImGui::BeginCombo(item.label.c_str(), value.c_str())) return;
    for (const std::string& option : item.options)
        if (ImGui::Selectable(option.c_str(), option == value) && option != value) {
            value = option;
            item.edited = true;
        }
    ImGui::EndCombo();
}

}  // namespace

PanelView::PanelView() {
    set_keys(ImGui::GetIO());
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.Colors[ImGuiCol_WindowBg].w = 0.82f;
    style.WindowRounding = 0;
    style.FrameRounding = 2;
}

void PanelView::key(Key key, bool down, bool control, bool shift) {
    held_keys_.set(static_cast<std::size_t>(key), down);
    control_ = control;
    shift_ = shift;
    if (!down) return;
    pressed_keys_.set(static_cast<std::size_t>(key));
    pressed_control_ |= control;
    pressed_shift_ |= shift;
}

void PanelView::letter(unsigned int code) {
    context_.use();
    ImGui::GetIO().AddInputCharacter(code);
}

void PanelView::pointer(double x, double y) {
    context_.use();
    ImGui::GetIO().MousePos = {static_cast<float>(x), static_cast<float>(y)};
}

void PanelView::button(int number, bool down) {
    if (number < 0 || number >= static_cast<int>(held_.size())) return;
    held_[number] = down;
    pressed_[number] |= down;
}

void PanelView::scroll(double x, double y) {
    context_.use();
    ImGui::GetIO().MouseWheelH += static_cast<float>(x);
    ImGui::GetIO().MouseWheel += static_cast<float>(y);
}

bool PanelView::takes_keys() const {
    context_.use();
    return ImGui::GetIO().WantTextInput;
}

bool PanelView::takes_pointer() const {
    context_.use();
    return ImGui::GetIO().WantCaptureMouse;
}

// A click, or the stroke of a key, may begin and end between two pictures: ImGui has to see it all the same.
void PanelView::hand_over_input() {
    context_.use();
    ImGuiIO& io = ImGui::GetIO();
    for (std::size_t i = 0; i < held_.size(); ++i) io.MouseDown[i] = held_[i] || pressed_[i];
    for (std::size_t i = 0; i < held_keys_.size(); ++i) io.KeysDown[i] = held_keys_[i] || pressed_keys_[i];
    io.KeyCtrl = control_ || pressed_control_;
    io.KeyShift = shift_ || pressed_shift_;
    pressed_ = {};
    pressed_keys_.reset();
    pressed_control_ = pressed_shift_ = false;
}

void PanelView::show(Panel* panel, int width, int height) {
    hand_over_input();
    context_.begin_frame(width, height);
    if (panel) {
        ImGui::SetNextWindowPos({0, 0}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSize({panel_width, static_cast<float>(height)}, ImGuiCond_FirstUseEver);
        ImGui::Begin(panel->title.c_str());
        ImGui::PushItemWidth(0.55f * panel_width);
        bool is_open = true;
        for (PanelItem& item : panel->items) {
            item.edited = false;
            if (item.kind == PanelItemKind::heading)
                is_open =
                    ImGui::CollapsingHeader((item.label + "##" + item.id).c_str(), ImGuiTreeNodeFlags_DefaultOpen);
            else if (is_open)
                show_item(item);
        }
        ImGui::PopItemWidth();
        ImGui::End();
    }
    context_.end_frame();
}

void PanelView::show_item(PanelItem& item) {
    ImGui::PushID(item.id.c_str());
    show_value(item);
    explain(item);
    ImGui::PopID();
}

void PanelView::show_value(PanelItem& item) {
    switch (item.kind) {
    case PanelItemKind::choice: return choose(item);
    case PanelItemKind::toggle: {
        bool value = std::get<bool>(item.value);
        item.edited = ImGui::Checkbox(item.label.c_str(), &value);
        item.value = value;
        return;
    }
    case PanelItemKind::integer:
    case PanelItemKind::number: return edit_number(item);
    case PanelItemKind::word: return edit_word(item);
    case PanelItemKind::button:
        item.edited = ImGui::Button(item.label.c_str());
        item.value = item.edited;
        return;
    case PanelItemKind::graph: return draw_graph(item);
    default: break;
    }
    const auto* text = std::get_if<std::string>(&item.value);
    const std::string value = text ? *text : to_string(item.value);
    ImGui::TextWrapped("%s%s%s", item.label.c_str(), value.empty() ? "" : ": ", value.c_str());
}

// What is being typed is kept until it is complete: the value in the panel is what is in force.
void PanelView::edit_number(PanelItem& item) {
    const auto* integer = std::get_if<std::int64_t>(&item.value);
    const double in_force = integer ? static_cast<double>(*integer) : std::get<double>(item.value);
    const auto kept = numbers_.find(item.id);
    double value = kept == numbers_.end() ? in_force : kept->second;
    ImGui::InputDouble(with_unit(item).c_str(), &value, 0, 0, integer ? "%.0f" : "%.6g");
    if (ImGui::IsItemActive()) {
        numbers_[item.id] = value;
    } else if (kept != numbers_.end()) {
        value = std::clamp(kept->second, item.min, item.max);
        numbers_.erase(kept);
        item.edited = value != in_force;
        if (integer)
            item.value = static_cast<std::int64_t>(value);
        else
            item.value = value;
    }
}

void PanelView::edit_word(PanelItem& item) {
    const auto& in_force = std::get<std::string>(item.value);
    std::string& value = words_.try_emplace(item.id, in_force).first->second;
    ImGui::InputText(with_unit(item).c_str(), &value);
    if (ImGui::IsItemActive()) return;
    const std::string typed = value;
    words_.erase(item.id);
    item.edited = typed != in_force;
    item.value = typed;
}

}  // namespace kolize::gl
