// A panel of settings and graphs as data: whoever opens the window decides how it looks, whoever fills it what it does.
#pragma once

#include <kolize/parameters.h>

#include <string>
#include <vector>

namespace kolize {

enum class PanelItemKind : std::uint32_t {
    heading,  // opens a section, which the user may fold up
    text,     // `label`, and `value` beside it if it is no empty text
    choice,   // `value` is one of `options`
    toggle,   // boolean
    integer,
    number,
    word,    // text to be edited
    button,  // `value` becomes true when pressed
    graph
};

struct PanelSeries {
    std::string name;
    std::vector<float> values;  // oldest first
};

// A line across the graphs, between two values.
struct PanelMark {
    std::size_t before = 0;  // the value that comes after it
    std::string label;
};

struct PanelItem {
    PanelItemKind kind = PanelItemKind::text;
    std::string id;  // unique in the panel
    std::string label;
    std::string unit = {};
    std::string help = {};  // shown when the pointer rests on it
    Value value = std::string();
    std::vector<std::string> options = {};
    double min = -1.7976931348623157e308, max = 1.7976931348623157e308;
    std::vector<PanelSeries> series = {};  // graph: all on one scale from 0
    std::vector<PanelMark> marks = {};
    // Set by the window when the user has changed the value (a number: when the edit is complete).
    bool edited = false;
};

struct Panel {
    std::string title;
    std::vector<PanelItem> items;
};

}  // namespace kolize
