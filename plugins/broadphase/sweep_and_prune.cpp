// Broadphase by sweep and prune: only boxes whose extents overlap along an axis can overlap.
//
// `scratch` sorts the boxes by where they begin along one axis, the one along which they are spread the most, and tests
// each against those that begin before it ends, four at a time. Static boxes stand in a list of their own that is kept
// while the generation stays, so that two static boxes never meet in a test.
//
// `incremental` keeps three sorted lists of end points from step to step. Sorting them by insertion costs what has
// changed places: where the begin of a box goes below the end of another, the two have come to overlap along that axis.
// A pair is taken up by the last axis to do so, and dropped when its boxes have parted. If very much has changed
// places, it begins anew from a scratch sweep instead of sorting on.
#include <kolize/plugin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace {

using kolize::Aabb;
using kolize::Pair;
using kolize::Vec3;

// Four at a time whatever the machine has: wider registers halve the instructions, and every answer is a comparison.
constexpr std::size_t lanes = 4;
using Lanes [[gnu::vector_size(lanes * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] = double;
using Mask [[gnu::vector_size(lanes * sizeof(double))]] = std::int64_t;

// The thread sanitizer is not ready yet when the choice between clones is made.
#ifdef __SANITIZE_THREAD__
#define KOLIZE_WIDE
#else
#define KOLIZE_WIDE [[gnu::target_clones("avx2", "default")]]
#endif

// Unsigned numbers in the order of the real ones; both zeros are one.
std::uint64_t sort_key(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x + 0.0);
    return bits >> 63 ? ~bits : bits | std::uint64_t{1} << 63;
}

// Radix sort, stable: linear whatever the numbers are.
class KeySort {
public:
    struct Item {
        std::uint64_t key;
        std::uint32_t id;
    };
    std::vector<Item> items;

    void sort() {
        for (auto& histogram : counts_) histogram.fill(0);
        for (const Item& item : items)
            for (std::size_t pass = 0; pass < passes; ++pass) ++counts_[pass][digit(item, pass)];
        other_.resize(items.size());
        for (std::size_t pass = 0; pass < passes && !items.empty(); ++pass) {
            if (counts_[pass][digit(items[0], pass)] == items.size()) continue;  // one digit for all
            std::uint32_t sum = 0;
            for (std::uint32_t& count : counts_[pass]) sum += std::exchange(count, sum);
            for (const Item& item : items) other_[counts_[pass][digit(item, pass)]++] = item;
            items.swap(other_);
        }
    }

private:
    static constexpr std::size_t bits = 8, passes = 8;
    static std::size_t digit(const Item& item, std::size_t pass) {
        return item.key >> (pass * bits) & ((std::size_t{1} << bits) - 1);
    }
    std::vector<Item> other_;
    std::array<std::array<std::uint32_t, std::size_t{1} << bits>, passes> counts_;
};

// Boxes by ascending low[0]; the axis of the sweep is axis 0 here. Behind the last one stand boxes that begin nowhere.
struct SortedBoxes {
    std::vector<double> low[3], high[3];
    std::vector<std::uint32_t> row;

    void take(const std::vector<KeySort::Item>& order, std::span<const Aabb> bounds, int sweep_axis) {
        row.resize(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) row[i] = order[i].id;
        for (int k = 0; k < 3; ++k) {
            const int axis = (sweep_axis + k) % 3;
            low[k].assign(order.size() + lanes, kolize::infinity);
            high[k].assign(order.size() + lanes, -kolize::infinity);
            for (std::size_t i = 0; i < order.size(); ++i) {
                low[k][i] = bounds[row[i]].min[axis];
                high[k][i] = bounds[row[i]].max[axis];
            }
        }
    }
};

const Lanes& load(const double* four) { return *reinterpret_cast<const Lanes*>(four); }

// Box i of `a` against those of `b` from number `begin` on, as far as they begin before it ends.
[[gnu::always_inline]] inline void scan(const SortedBoxes& a, std::size_t i, const SortedBoxes& b, std::size_t begin,
                                        std::vector<Pair>& pairs) {
    const double end = a.high[0][i];
    const double low1 = a.low[1][i], high1 = a.high[1][i], low2 = a.low[2][i], high2 = a.high[2][i];
    for (std::size_t j = begin; b.low[0][j] <= end; j += lanes) {
        const Mask hit = (load(&b.low[1][j]) <= high1) & (load(&b.high[1][j]) >= low1) & (load(&b.low[2][j]) <= high2) &
                         (load(&b.high[2][j]) >= low2) & (load(&b.low[0][j]) <= end);
        if ((hit[0] | hit[1] | hit[2] | hit[3]) == 0) continue;
        for (std::size_t k = 0; k < lanes; ++k)
            if (hit[k]) pairs.push_back({std::min(a.row[i], b.row[j + k]), std::max(a.row[i], b.row[j + k])});
    }
}

KOLIZE_WIDE void sweep(const SortedBoxes& boxes, std::vector<Pair>& pairs) {
    for (std::size_t i = 0; i < boxes.row.size(); ++i) scan(boxes, i, boxes, i + 1, pairs);
}

// Each box against those of the other list that begin with it or later; if two begin together, `a` goes first.
KOLIZE_WIDE void sweep(const SortedBoxes& a, const SortedBoxes& b, std::vector<Pair>& pairs) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < a.row.size(); ++i) {
        while (b.low[0][begin] < a.low[0][i]) ++begin;
        scan(a, i, b, begin, pairs);
    }
    begin = 0;
    for (std::size_t i = 0; i < b.row.size(); ++i) {
        while (begin < a.row.size() && a.low[0][begin] <= b.low[0][i]) ++begin;
        scan(b, i, a, begin, pairs);
    }
}

class SweepAndPrune final : public kolize::Broadphase {
public:
    static void parameters(kolize::Parameters<SweepAndPrune>& p) {
        p.add("method", &SweepAndPrune::method_)
            .choices({"scratch", "incremental"})
            .doc(
                "scratch: sorts and sweeps along one axis in every step. incremental: keeps sorted end points and "
                "pairs, "
                "for scenes in which little moves from step to step.");
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) override {
        kolize::require_valid_bounds(input.bounds);
        const bool anew = input.generation != generation_ || input.bounds.size() != rows_;
        generation_ = input.generation;
        rows_ = input.bounds.size();
        if (anew) axis_ = -1;
        if (method_ == "scratch") return sweep_all(input, pairs);
        if (anew || !keep_up(input)) begin_anew(input);
        previous_.assign(input.bounds.begin(), input.bounds.end());
        pairs.insert(pairs.end(), overlapping_.begin(), overlapping_.end());
    }

private:
    // ------------------------------------------------------------------------------------------ scratch

    void sweep_all(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) {
        const int axis = choose_axis(input.bounds);
        if (axis != axis_) sort_boxes(input, axis, true, static_boxes_);
        axis_ = axis;
        sort_boxes(input, axis, false, moving_boxes_);
        sweep(moving_boxes_, pairs);
        sweep(moving_boxes_, static_boxes_, pairs);
    }

    // The axis along which the centres vary most, judged by some of them. One that was chosen before is kept until
    // another is twice as good: the static boxes are sorted along it.
    int choose_axis(std::span<const Aabb> bounds) const {
        constexpr std::size_t samples = 1024;
        const std::size_t stride = bounds.size() / samples + 1;
        const auto quarter = [](const Aabb& box) -> Vec3 { return 0.25 * box.min + 0.25 * box.max; };
        double largest = 1;
        for (std::size_t i = 0; i < bounds.size(); i += stride)
            largest = std::max(largest, quarter(bounds[i]).cwiseAbs().maxCoeff());
        const Vec3 first = bounds.empty() ? Vec3::Zero() : Vec3(quarter(bounds[0]) / largest);
        Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
        double count = 0;
        for (std::size_t i = 0; i < bounds.size(); i += stride, ++count) {
            const Vec3 offset = quarter(bounds[i]) / largest - first;
            sum += offset;
            squares += offset.cwiseProduct(offset);
        }
        const Vec3 variance = count * squares - sum.cwiseProduct(sum);
        int best = 0;
        variance.maxCoeff(&best);
        return axis_ >= 0 && 2 * variance[axis_] >= variance[best] ? axis_ : best;
    }

    void sort_boxes(const kolize::BroadphaseInput& input, int axis, bool is_static, SortedBoxes& boxes) {
        sort_.items.clear();
        for (std::uint32_t row = 0; row < input.bounds.size(); ++row)
            if ((input.is_static[row] != 0) == is_static)
                sort_.items.push_back({sort_key(input.bounds[row].min[axis]), row});
        sort_.sort();
        boxes.take(sort_.items, input.bounds, axis);
    }

    // -------------------------------------------------------------------------------------- incremental

    struct EndPoint {
        double at;
        std::uint32_t row_and_end;  // 2 row, + 1 for the upper end

        std::uint32_t row() const { return row_and_end >> 1; }
        bool is_upper() const { return row_and_end & 1; }
        // Closed boxes: of a lower and an upper end at the same place, the lower one goes first.
        bool before(const EndPoint& o) const { return at < o.at || (at == o.at && !is_upper() && o.is_upper()); }
    };

    static constexpr std::size_t most_swaps_per_row = 64;  // about as long as beginning anew takes

    void begin_anew(const kolize::BroadphaseInput& input) {
        overlapping_.reserve(16 * input.bounds.size());
        overlapping_.clear();
        sweep_all(input, overlapping_);
        for (int axis = 0; axis < 3; ++axis) {
            sort_.items.clear();
            for (std::uint32_t upper = 0; upper < 2; ++upper)  // the sort is stable: lower ends go first
                for (std::uint32_t row = 0; row < input.bounds.size(); ++row)
                    sort_.items.push_back({sort_key(end_of(input, axis, 2 * row + upper)), 2 * row + upper});
            sort_.sort();
            ends_[axis].resize(sort_.items.size());
            for (std::size_t i = 0; i < sort_.items.size(); ++i)
                ends_[axis][i] = {end_of(input, axis, sort_.items[i].id), sort_.items[i].id};
        }
    }

    static double end_of(const kolize::BroadphaseInput& input, int axis, std::uint32_t row_and_end) {
        const Aabb& box = input.bounds[row_and_end >> 1];
        return row_and_end & 1 ? box.max[axis] : box.min[axis];
    }

    // False if too much has changed places; the lists are of no use then.
    bool keep_up(const kolize::BroadphaseInput& input) {
        std::erase_if(overlapping_,
                      [&](const Pair& pair) { return !input.bounds[pair.a].overlaps(input.bounds[pair.b]); });
        std::size_t swaps_left = most_swaps_per_row * input.bounds.size();
        for (int axis = 0; axis < 3; ++axis)
            if (!sort_ends(input, axis, swaps_left)) return false;
        return true;
    }

    bool sort_ends(const kolize::BroadphaseInput& input, int axis, std::size_t& swaps_left) {
        std::vector<EndPoint>& ends = ends_[axis];
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const EndPoint moved{end_of(input, axis, ends[i].row_and_end), ends[i].row_and_end};
            std::size_t place = i;
            for (; place > 0 && moved.before(ends[place - 1]); --place) {
                ends[place] = ends[place - 1];
                if (!moved.is_upper() && ends[place].is_upper()) meet(input, axis, moved.row(), ends[place].row());
            }
            ends[place] = moved;
            if (i - place > swaps_left) return false;
            swaps_left -= i - place;
        }
        return true;
    }

    // The two boxes overlap along this axis and did not before. If that is so for later axes too, it is left to them.
    void meet(const kolize::BroadphaseInput& input, int axis, std::uint32_t a, std::uint32_t b) {
        if (!input.bounds[a].overlaps(input.bounds[b])) return;
        for (int later = axis + 1; later < 3; ++later)
            if (previous_[a].max[later] < previous_[b].min[later] || previous_[b].max[later] < previous_[a].min[later])
                return;
        overlapping_.push_back({std::min(a, b), std::max(a, b)});
    }

    std::string method_ = "scratch";

    std::uint64_t generation_ = 0;
    std::size_t rows_ = 0;
    int axis_ = -1;  // of the sweep; -1: the static boxes are not sorted yet
    KeySort sort_;
    SortedBoxes moving_boxes_, static_boxes_;
    std::vector<EndPoint> ends_[3];
    std::vector<Aabb> previous_;     // the boxes of the last step
    std::vector<Pair> overlapping_;  // and its pairs
};

}  // namespace

KOLIZE_PLUGIN(SweepAndPrune, .name = "sweep_and_prune",
              .summary = "boxes sorted along an axis; only those whose extents overlap are tested",
              .source =
                  "Baraff, Dynamic Simulation of Non-penetrating Rigid Bodies (1992), 3.1; Cohen et al., I-COLLIDE, "
                  "I3D 1995",
              .cost =
                  "scratch: O(N) to sort, then a quarter of a comparison for each two moving boxes whose extents "
                  "overlap along one axis: O(N^(5/3)) in an evenly filled cube. incremental: O(N + pairs) and the "
                  "number of end points that change places; two to six times as long as scratch where everything "
                  "moves. About 90 bytes a box, incremental 240 and 8 a pair.",
              .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
              .choose =
                  "Up to some thousand boxes, or boxes strung out along one axis. incremental pays if hardly "
                  "anything moves from step to step; for many boxes that fill space evenly take grid.",
              .capabilities = {.exact = true})
