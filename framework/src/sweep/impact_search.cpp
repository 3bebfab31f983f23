#include "sweep/impact_search.h"

#include <algorithm>
#include <tuple>

namespace kolize {

namespace {

using Candidate = ImpactScratch::Candidate;

constexpr std::size_t many_candidates = 64;  // more are taken only where a shorter span does not help
constexpr double widest_turn = 0.5;          // rad; a bound of second order says nothing beyond that
constexpr double hairline = 1000;            // touch distances; bodies at rest may sink so far by rounding
constexpr int most_steps = 5000;             // of one pair in one span; then the time reached is reported as an impact

bool later(const Candidate& x, const Candidate& y) { return std::tie(x.time, x.a, x.b) > std::tie(y.time, y.a, y.b); }

class ImpactSearch {
public:
    ImpactSearch(const MovingPair& pair, double until, ImpactScratch& scratch)
        : pair_(pair), until_(until), scratch_(scratch) {}

    double run(double from) {
        const MovingPair::Span near = pair_.near_span(pair_.at(from), until_ - from);
        if (near.begin > near.end) return infinity;
        until_ = std::min(until_, from + near.end);
        for (double time = from + near.begin; time < until_;) {
            const PairMoment moment = pair_.at(time);
            double span = first_span(until_ - time);
            const double shortest = std::max(1e-6 * span, 1e-15 * until_);  // as times are kept
            while (!collect(moment, span, span > shortest)) span *= 0.25;
            if (const double found = advance(time + span); found < infinity) return found;
            if (!(time + span > time)) return time;
            time += span;
        }
        return infinity;
    }

private:
    double first_span(double left) const {
        const double turn = pair_.bound.angular_speed * left;
        return turn > widest_turn ? left / std::ceil(turn / widest_turn) : left;
    }

    // Feature pairs that may come to touch within the span. False if there are too many to go through for so long.
    bool collect(const PairMoment& moment, double span, bool may_give_up) {
        auto& candidates = scratch_.candidates;
        candidates.clear();
        visit_near(pair_, moment, pair_.touch, span, scratch_, [&](std::uint32_t a, std::uint32_t b) {
            const auto [fa, fb] = features(moment, a, b);
            if (pair_.clearly_apart(moment, fa, fb, span)) return true;
            const FeatureGap gap = pair_.gap(moment, fa, fb);
            const double safe = pair_.safe_time(moment, fa, fb, gap, pair_.touch, span);
            if (safe < span) candidates.push_back({moment.time + safe, a, b});
            return !may_give_up || candidates.size() <= many_candidates;
        });
        if (may_give_up && candidates.size() > many_candidates) return false;
        std::make_heap(candidates.begin(), candidates.end(), later);
        return true;
    }

    std::pair<ConvexFeature, ConvexFeature> features(const PairMoment& moment, std::uint32_t a, std::uint32_t b) const {
        std::pair<ConvexFeature, ConvexFeature> both;
        both.first = pair_.a.feature(a);
        if (pair_.b.is_plane()) return both;
        both.second = pair_.b.feature(b);
        for (Vec3& corner : both.second.corners) corner = moment.b_to_a * corner;
        return both;
    }

    // The first touch before `end`, or infinity.
    double advance(double end) {
        auto& candidates = scratch_.candidates;
        for (int step = 0; !candidates.empty(); ++step) {
            std::pop_heap(candidates.begin(), candidates.end(), later);
            Candidate& next = candidates.back();
            const PairMoment moment = pair_.at(next.time);
            if (step >= most_steps || touches(moment, next, end)) return moment.time;
            if (next.time < end)
                std::push_heap(candidates.begin(), candidates.end(), later);
            else
                candidates.pop_back();
        }
        return infinity;
    }

    // Whether the features touch and approach; otherwise moves candidate.time on to where they are known to be apart.
    bool touches(const PairMoment& moment, Candidate& candidate, double end) const {
        const auto [fa, fb] = features(moment, candidate.a, candidate.b);
        const FeatureGap gap = pair_.gap(moment, fa, fb);
        const double width = gap.projected - pair_.radii;
        if (!(width > -hairline * pair_.touch)) return true;  // they overlap, from the start
        const bool close = width <= 2 * pair_.touch;
        if (close && pair_.approach(moment, gap) > pair_.approach_noise(moment)) return true;
        const double target = !close ? pair_.touch : width > 0 ? 0.5 * width : width - 0.125 * pair_.touch;
        const double left = end - moment.time;
        double safe = pair_.safe_time(moment, fa, fb, gap, target, left);
        // Half as far, not to where surfaces that part come as close again: they shall meet at the touch distance next.
        if (close && safe < left) safe *= 0.5;
        if (!(moment.time + safe > moment.time)) return true;
        candidate.time = moment.time + safe;
        return false;
    }

    const MovingPair& pair_;
    double until_;
    ImpactScratch& scratch_;
};

}  // namespace

void ImpactScratch::reserve() {
    candidates.reserve(4 * many_candidates);
    stack.reserve(256);
}

double find_impact(const MovingPair& pair, double from, double until, ImpactScratch& scratch) {
    return ImpactSearch(pair, until, scratch).run(from);
}

}  // namespace kolize
