#include "stability/search.h"

#include <algorithm>

namespace kolize::cli::stability {
namespace {

constexpr int most_intervals = 12;
constexpr int looks_below = 6;  // intervals below the first failure that are looked into again

class Search {
public:
    Search(const Axis& axis, const std::function<Outcome(double)>& probe) : axis_(axis), probe_(probe) {}

    Envelope run() {
        sample_whole_axis();
        auto failure = first_failure();
        if (failure != samples_.end()) halve(failure);
        look_again_below();
        return envelope();
    }

private:
    using Samples = std::vector<Sample>;

    Sample sample(double decades) {
        ++probes_;
        return {decades, probe_(decades)};
    }
    // How hard a magnitude is, whichever way the axis runs.
    double hardness(const Sample& s) const { return std::abs(s.decades - axis_.from); }

    void sample_whole_axis() {
        const int count = std::clamp(static_cast<int>(std::ceil(std::abs(axis_.to - axis_.from))), 4, most_intervals);
        for (int i = 0; i <= count; ++i) samples_.push_back(sample(axis_.from + (axis_.to - axis_.from) * i / count));
    }

    Samples::iterator first_failure() {
        return std::find_if(samples_.begin(), samples_.end(), [](const Sample& s) { return !s.outcome.holds(); });
    }

    void insert(const Sample& s) {
        const auto harder = [&](const Sample& other) { return hardness(other) > hardness(s); };
        samples_.insert(std::find_if(samples_.begin(), samples_.end(), harder), s);
    }

    // Between a failure and the sample below it, which holds.
    void halve(Samples::iterator failure) {
        if (failure == samples_.begin()) return;
        double good = std::prev(failure)->decades, bad = failure->decades;
        while (std::abs(bad - good) > resolution) {
            const Sample middle = sample((good + bad) / 2);
            (middle.outcome.holds() ? good : bad) = middle.decades;
            insert(middle);
        }
    }

    // Each time something fails below, that is where the envelope ends, and what is below it is looked at.
    void look_again_below() {
        for (int look = 0; look < looks_below; ++look) {
            const auto gap = widest_gap_below(first_failure());
            if (gap == samples_.end()) return;
            insert(sample((gap->decades + std::next(gap)->decades) / 2));
            const auto failure = first_failure();
            if (failure != samples_.end()) halve(failure);
        }
    }
    // Its lower end; of gaps as wide as each other the last. The end if none is wider than the resolution.
    Samples::iterator widest_gap_below(Samples::iterator failure) {
        auto widest = samples_.end();
        double width = resolution;
        for (auto at = samples_.begin(); at != failure && std::next(at) != failure; ++at)
            if (const double next = std::abs(std::next(at)->decades - at->decades); next > 0.999 * width) {
                widest = at;
                width = next;
            }
        return widest;
    }

    Envelope envelope() {
        Envelope result;
        result.probes = probes_;
        const auto failure = first_failure();
        if (failure != samples_.begin()) result.holds_to = std::prev(failure)->decades;
        if (failure == samples_.end()) return result;
        result.beyond = *failure;
        for (auto at = failure; at != samples_.end(); ++at) {
            if (at->outcome.holds()) result.again = at->decades;
            if (at->outcome.silent() && !result.silent) result.silent = *at;
        }
        return result;
    }

    const Axis& axis_;
    const std::function<Outcome(double)>& probe_;
    Samples samples_;  // from easy to hard
    int probes_ = 0;
};

}  // namespace

Envelope find_envelope(const Axis& axis, const std::function<Outcome(double)>& probe) {
    return Search(axis, probe).run();
}

Envelope find_envelope(const Study& study, const Subject& subject, std::size_t axis) {
    Point point = study.usual();
    return find_envelope(study.axes[axis], [&](double decades) {
        point[axis] = decades;
        return ask(study, subject, point);
    });
}

}  // namespace kolize::cli::stability
