#include "viewer/history.h"

#include "common.h"

namespace kolize::cli {

void History::add(const Simulation& simulation) {
    entries_.push_back({simulation.step_number() - 1, simulation.reading(), simulation.pairs().size(),
                        simulation.contacts().rows.size()});
    if (entries_.size() > length) entries_.pop_front();
    while (!marks_.empty() && marks_.front().step < entries_.front().step) marks_.pop_front();
}

void History::mark(std::uint64_t step, const std::string& label) {
    marks_.push_back({step, label});
    last_mark_ = "step " + std::to_string(step) + ": " + label;
}

template <class Get>
PanelSeries History::series(const std::string& name, const Get& get) const {
    PanelSeries series{name, {}};
    for (const Entry& entry : entries_) series.values.push_back(static_cast<float>(get(entry)));
    return series;
}

PanelItem History::graph(const std::string& id, const std::string& label, std::vector<PanelSeries> series) const {
    PanelItem item{PanelItemKind::graph, id, label};
    item.series = std::move(series);
    for (const Mark& mark : marks_)
        if (!entries_.empty()) item.marks.push_back({mark.step - entries_.front().step, mark.label});
    return item;
}

void History::show(const Simulation& simulation, std::vector<PanelItem>& items) const {
    const auto text = [&](const std::string& id, const std::string& label, const std::string& value) {
        items.push_back({PanelItemKind::text, id, label, "", "", Value(value)});
    };
    const auto head = [&](const std::string& id, const std::string& label) {
        items.push_back({PanelItemKind::heading, id, label});
    };
    const Reading now = simulation.reading();
    head("times", "Time of a step");
    items.push_back(graph("times.graph", "us",
                          {series("integrate", [](const Entry& e) { return e.reading.integrate_us; }),
                           series("broadphase", [](const Entry& e) { return e.reading.broadphase_us; }),
                           series("narrowphase", [](const Entry& e) { return e.reading.narrowphase_us; }),
                           series("response", [](const Entry& e) { return e.reading.response_us; })}));
    if (!last_mark_.empty()) text("times.mark", "last switch", last_mark_);
    head("counts", "Counts");
    items.push_back(graph("counts.graph", "",
                          {series("pairs", [](const Entry& e) { return static_cast<double>(e.pairs); }),
                           series("contacts", [](const Entry& e) { return static_cast<double>(e.contacts); })}));
    head("drift", "Drift since the last switch");
    items.push_back(graph("drift.graph", "",
                          {series("energy", [](const Entry& e) { return e.reading.energy_drift; }),
                           series("momentum", [](const Entry& e) { return e.reading.momentum_drift; })}));
    text("drift.energy_J", "energy, J", number(now.energy_J, 6));
    text("drift.energy", "drift of energy", number(now.energy_drift));
    text("drift.momentum", "drift of momentum", number(now.momentum_drift));
    text("drift.angular", "drift of angular momentum", number(now.angular_momentum_drift));
}

}  // namespace kolize::cli
