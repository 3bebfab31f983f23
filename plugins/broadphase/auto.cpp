// Broadphase that measures the others on the boxes at hand and takes the fastest one.
//
// The race has two parts. First all are tried on a few of the boxes, then on four times as many, and so on; whoever is
// several times slower than the best one drops out, so that none that is quadratic ever sees all boxes. Then those left
// take turns in the calls to come, each for a few of them: the first one is for building what is kept from call to
// call, the others are timed, and a turn ends early for whoever is clearly behind. Which one it is never shows in the
// results: every broadphase reports every pair of overlapping boxes.
//
// It looks again when there are twice or half as many boxes, or when calls have long taken twice the time they took, as
// long as races take a small part of all time.
#include <kolize/plugin.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace {

using kolize::Broadphase;
using kolize::Pair;

class Auto final : public Broadphase {
public:
    static void parameters(kolize::Parameters<Auto>& p) {
        p.add("timed_calls", &Auto::timed_calls_).range(1, 1000).doc("Calls by which each candidate is judged.");
    }

    void choose_from(std::shared_ptr<const kolize::BroadphaseChoice> others) override {
        if (others->size() == 0) throw std::invalid_argument("there is no other broadphase to choose from");
        others_ = std::move(others);
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) override {
        kolize::require_valid_bounds(input.bounds);
        if (input.bounds.size() < 2) return;
        if (must_look_again(input.bounds.size())) begin_race(input);
        const double took = time_of(*present().stage, input, pairs);
        total_ += took;
        if (turn_ < candidates_.size())
            go_on_with_race(took);
        else
            slow_calls_ = took > much_worse * present().best ? slow_calls_ + 1 : 0;
    }

    std::string report() const override {
        if (candidates_.empty()) return {};
        if (turn_ < candidates_.size()) return "still measuring: " + list(0);
        return "chose " + candidates_[chosen_].name + " for " + std::to_string(rows_) + " boxes: " + list(0) + dropped_;
    }

private:
    struct Candidate {
        std::string name;
        std::shared_ptr<Broadphase> stage;
        double best = kolize::infinity;  // s a call
    };

    static constexpr double hopeless = 20;     // times the best one's time on a sample
    static constexpr double behind = 1.5;      // likewise in the race
    static constexpr double much_worse = 2;    // times the time of the race
    static constexpr int patience = 64;        // calls
    static constexpr double most_races = 0.1;  // of all time

    Candidate& present() { return candidates_[turn_ < candidates_.size() ? turn_ : chosen_]; }

    bool must_look_again(std::size_t rows) const {
        if (candidates_.empty()) return true;
        if (rows >= 2 * rows_ || 2 * rows <= rows_) return true;
        return slow_calls_ >= patience && racing_ < most_races * total_;
    }

    double time_of(Broadphase& stage, const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) const {
        const double begin = host().now();
        stage.find_pairs(input, pairs);
        return host().now() - begin;
    }

    void begin_race(const kolize::BroadphaseInput& input) {
        rows_ = input.bounds.size();
        candidates_.clear();
        for (std::size_t i = 0; i < others_->size(); ++i)
            candidates_.push_back({others_->name(i), others_->make(i), kolize::infinity});
        dropped_.clear();
        for (std::size_t size = first_sample; size < rows_; size *= 4) try_on_sample(input, size);
        for (Candidate& candidate : candidates_) candidate.best = kolize::infinity;
        turn_ = 0;
        calls_ = 0;
        slow_calls_ = 0;
    }

    void try_on_sample(const kolize::BroadphaseInput& input, std::size_t size) {
        sample_.clear();
        sample_is_static_.clear();
        sample_is_reference_.clear();
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t row = i * rows_ / size;
            sample_.push_back(input.bounds[row]);
            sample_is_static_.push_back(input.is_static[row]);
            if (!input.is_reference.empty()) sample_is_reference_.push_back(input.is_reference[row]);
        }
        const kolize::BroadphaseInput sample{sample_, sample_is_static_, size, sample_is_reference_};
        double best = kolize::infinity;
        for (Candidate& candidate : candidates_) {
            sample_pairs_.clear();
            candidate.best = time_of(*candidate.stage, sample, sample_pairs_);
            best = std::min(best, candidate.best);
            total_ += candidate.best;
            racing_ += candidate.best;
        }
        std::erase_if(candidates_, [&](const Candidate& candidate) {
            if (candidate.best <= hopeless * best) return false;
            dropped_ += (dropped_.empty() ? "; too slow on samples: " : ", ") + candidate.name;
            return true;
        });
        std::stable_sort(candidates_.begin(), candidates_.end(),
                         [](const Candidate& a, const Candidate& b) { return a.best < b.best; });
    }

    // The first call of a turn builds what is kept, and is not counted.
    void go_on_with_race(double took) {
        racing_ += took;
        Candidate& candidate = candidates_[turn_];
        if (calls_++ > 0) candidate.best = std::min(candidate.best, took);
        double best = kolize::infinity;
        for (std::size_t i = 0; i < turn_; ++i) best = std::min(best, candidates_[i].best);
        if (calls_ <= timed_calls_ && candidate.best <= behind * best) return;
        if (calls_ == 1) return;
        calls_ = 0;
        if (++turn_ < candidates_.size()) return;
        chosen_ = static_cast<std::size_t>(
            std::min_element(candidates_.begin(), candidates_.end(),
                             [](const Candidate& a, const Candidate& b) { return a.best < b.best; }) -
            candidates_.begin());
        for (std::size_t i = 0; i < candidates_.size(); ++i)
            if (i != chosen_) candidates_[i].stage.reset();  // and what it keeps
    }

    std::string list(std::size_t from) const {
        std::string text;
        for (std::size_t i = from; i < candidates_.size(); ++i) {
            if (!(candidates_[i].best < kolize::infinity)) continue;
            char number[32];
            std::snprintf(number, sizeof number, " %.3g ms", 1e3 * candidates_[i].best);
            text += (text.empty() ? "" : ", ") + candidates_[i].name + number;
        }
        return text;
    }

    static constexpr std::size_t first_sample = 256;

    int timed_calls_ = 3;

    std::shared_ptr<const kolize::BroadphaseChoice> others_;
    std::vector<Candidate> candidates_;
    std::string dropped_;
    std::size_t rows_ = 0;           // when the race began
    std::size_t turn_ = 0;           // whose it is; behind the last one when the race is over
    int calls_ = 0;                  // of this turn
    std::size_t chosen_ = 0;         // when the race is over
    int slow_calls_ = 0;             // in a row
    double total_ = 0, racing_ = 0;  // s
    std::vector<kolize::Aabb> sample_;
    std::vector<std::uint8_t> sample_is_static_, sample_is_reference_;
    std::vector<Pair> sample_pairs_;
};

}  // namespace

KOLIZE_PLUGIN(
    Auto, .name = "auto", .summary = "measures the other broadphases on the boxes at hand and takes the fastest",
    .source = "successive halving: Karnin, Koren and Somekh, Almost optimal exploration in multi-armed bandits (2013)",
    .cost =
        "That of the fastest one, and a race of a few calls at the begin and whenever the number of boxes has "
        "doubled or halved.",
    .accuracy =
        "That of the one chosen; every broadphase reports every pair of overlapping boxes, so the results of a "
        "run do not depend on the choice.",
    .choose =
        "Where you do not know, or where a scene changes so much that no choice is right for all of it. To "
        "compare strategies name them.",
    .capabilities = {.allocates = true, .chooses = true})
