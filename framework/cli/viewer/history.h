// The last steps of a run as graphs: what they cost, how much there was, how well it went.
#pragma once

#include <kolize/panel.h>
#include <kolize/simulation.h>

#include <deque>

namespace kolize::cli {

class History {
public:
    static constexpr std::size_t length = 480;  // steps

    void add(const Simulation& simulation);
    // The pipeline was changed before this step; it stays marked as long as the graphs reach so far back.
    void mark(std::uint64_t step, const std::string& label);
    const std::string& last_mark() const { return last_mark_; }  // with its step; "" if there was none

    // Appends the graphs and the numbers of the last step.
    void show(const Simulation& simulation, std::vector<PanelItem>& items) const;

private:
    struct Entry {
        std::uint64_t step;
        Reading reading;
        std::size_t pairs, contacts;
    };
    struct Mark {
        std::uint64_t step;
        std::string label;
    };
    template <class Get>
    PanelSeries series(const std::string& name, const Get& get) const;
    PanelItem graph(const std::string& id, const std::string& label, std::vector<PanelSeries> series) const;

    std::deque<Entry> entries_;
    std::deque<Mark> marks_;
    std::string last_mark_;
};

}  // namespace kolize::cli
