// Broadphase by sweep and prune: only boxes whose extents overlap along an axis can overlap.
//
// `scratch` sorts the boxes by where they begin along one axis, the one along which they are spread the most, and tests
// each against those that begin before it ends, four at a time. Many boxes are first dealt out to tiles across the two
// other axes, as large as a few boxes; a box goes to all tiles that it reaches into, and a pair is taken where the
// lowest corner of what the two have in common lies. Static boxes stand in a list of their own that is kept while the
// generation stays, so that two static boxes never meet in a test.
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

    void reserve(std::size_t size) {
        items.reserve(size);
        other_.reserve(size);
    }

    void sort_any_order_of_equals() {
        constexpr std::size_t few = 1024;  // radix sort has its price
        if (items.size() > few) return sort();
        std::sort(items.begin(), items.end(),
                  [](const Item& a, const Item& b) { return a.key != b.key ? a.key < b.key : a.id < b.id; });
    }

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
    static constexpr std::size_t bits = 11, passes = 6;
    static std::size_t digit(const Item& item, std::size_t pass) {
        return item.key >> (pass * bits) & ((std::size_t{1} << bits) - 1);
    }
    std::vector<Item> other_;
    std::array<std::array<std::uint32_t, std::size_t{1} << bits>, passes> counts_;
};

// Space across the axis of the sweep, divided along axes 1 and 2 as seen from it. What lies outside belongs to the
// outermost tiles.
struct Tiles {
    struct Axis {
        double origin = 0, per_metre = 0;
        std::uint32_t count = 1;

        std::uint32_t index(double x) const {
            const double i = (x - origin) * per_metre;
            return count == 1 || !(i > 0) ? 0 : i >= count ? count - 1 : static_cast<std::uint32_t>(i);
        }
        // A little more or less wide: it is not worth sorting everything again.
        bool is_like(const Axis& o) const {
            const auto near = [](double x, double y) { return x <= 1.5 * y && y <= 1.5 * x; };
            return count == 1 ? o.count == 1
                              : near(per_metre, o.per_metre) && near(count, o.count) &&
                                    std::abs(origin - o.origin) * per_metre <= 0.25 * count;
        }
    };
    Axis axis[2];

    std::uint32_t count() const { return axis[0].count * axis[1].count; }
    bool are_like(const Tiles& o) const { return axis[0].is_like(o.axis[0]) && axis[1].is_like(o.axis[1]); }
};

// A box as it is filed in a tile; the axis of the sweep is axis 0 here.
struct Entry {
    double low[3], high[3];
    std::uint32_t row;
    std::uint16_t first_tile[2];  // along axes 1 and 2

    Entry() = default;
    Entry(const Aabb& box, std::uint32_t r, int sweep_axis) : row(r) {
        for (int k = 0; k < 3; ++k) {
            low[k] = box.min[(sweep_axis + k) % 3];
            high[k] = box.max[(sweep_axis + k) % 3];
        }
    }
    // Calls visit(number) for all tiles that it reaches into.
    template <class Visit>
    void for_tiles(const Tiles& tiles, Visit&& visit) {
        std::uint32_t last[2];
        for (int k = 0; k < 2; ++k) {
            first_tile[k] = static_cast<std::uint16_t>(tiles.axis[k].index(low[k + 1]));
            last[k] = tiles.axis[k].index(high[k + 1]);
        }
        for (std::uint32_t y = first_tile[0]; y <= last[0]; ++y)
            for (std::uint32_t z = first_tile[1]; z <= last[1]; ++z) visit(y * tiles.axis[1].count + z);
    }
};

// The entries of all tiles, tile by tile.
struct Files {
    std::vector<Entry> entries;
    std::vector<std::uint32_t> begin;  // by tile; one more for the end

    void file(const kolize::BroadphaseInput& input, bool is_static, int sweep_axis, const Tiles& tiles) {
        begin.assign(tiles.count() + 2, 0);
        const auto for_rows = [&](auto&& visit) {
            for (std::uint32_t row = 0; row < input.bounds.size(); ++row)
                if ((input.is_static[row] != 0) == is_static) {
                    Entry entry(input.bounds[row], row, sweep_axis);
                    entry.for_tiles(tiles, [&](std::uint32_t tile) { visit(entry, tile); });
                }
        };
        for_rows([&](const Entry&, std::uint32_t tile) { ++begin[tile + 2]; });
        for (std::size_t t = 2; t < begin.size(); ++t) begin[t] += begin[t - 1];
        entries.resize(begin.back());
        for_rows([&](const Entry& entry, std::uint32_t tile) { entries[begin[tile + 1]++] = entry; });
        begin.pop_back();
    }
    std::span<const Entry> of_tile(std::uint32_t tile) const {
        return std::span(entries).subspan(begin[tile], begin[tile + 1] - begin[tile]);
    }
};

// The boxes of one tile after the other, in each by ascending low[0]. Behind the last one of a tile stand boxes that
// begin nowhere.
struct SortedBoxes {
    std::vector<double> low[3], high[3];
    std::vector<std::uint32_t> row;
    std::vector<std::array<std::uint16_t, 2>> first_tile;

    std::size_t size() const { return row.size(); }
    void reserve(std::size_t size) {
        for (int k = 0; k < 3; ++k) low[k].reserve(size), high[k].reserve(size);
        row.reserve(size);
        first_tile.reserve(size);
    }
    void clear() { resize(0); }

    void add(std::span<const Entry> entries, KeySort& sort) {
        sort.items.clear();
        for (std::uint32_t i = 0; i < entries.size(); ++i) sort.items.push_back({sort_key(entries[i].low[0]), i});
        sort.sort_any_order_of_equals();
        std::size_t i = size();
        resize(i + entries.size() + lanes);
        for (const KeySort::Item& item : sort.items) set(i++, entries[item.id]);
        for (; i < size(); ++i) set(i, nowhere());
    }

private:
    static Entry nowhere() {
        Entry entry;
        for (int k = 0; k < 3; ++k) entry.low[k] = kolize::infinity, entry.high[k] = -kolize::infinity;
        entry.row = 0;
        entry.first_tile[0] = entry.first_tile[1] = 0;
        return entry;
    }
    void resize(std::size_t size) {
        for (int k = 0; k < 3; ++k) low[k].resize(size), high[k].resize(size);
        row.resize(size);
        first_tile.resize(size);
    }
    void set(std::size_t i, const Entry& entry) {
        for (int k = 0; k < 3; ++k) low[k][i] = entry.low[k], high[k][i] = entry.high[k];
        row[i] = entry.row;
        first_tile[i] = {entry.first_tile[0], entry.first_tile[1]};
    }
};

const Lanes& load(const double* four) { return *reinterpret_cast<const Lanes*>(four); }

struct Tile {
    std::uint32_t y, z;
    bool owns(const std::array<std::uint16_t, 2>& a, const std::array<std::uint16_t, 2>& b) const {
        return std::max(a[0], b[0]) == y && std::max(a[1], b[1]) == z;
    }
};

// Box i of `a` against those of `b` from number `begin` on, as far as they begin before it ends.
[[gnu::always_inline]] inline void scan(const Tile& tile, const SortedBoxes& a, std::size_t i, const SortedBoxes& b,
                                        std::size_t begin, std::vector<Pair>& pairs) {
    const double end = a.high[0][i];
    const double low1 = a.low[1][i], high1 = a.high[1][i], low2 = a.low[2][i], high2 = a.high[2][i];
    for (std::size_t j = begin; b.low[0][j] <= end; j += lanes) {
        const Mask hit = (load(&b.low[1][j]) <= high1) & (load(&b.high[1][j]) >= low1) & (load(&b.low[2][j]) <= high2) &
                         (load(&b.high[2][j]) >= low2) & (load(&b.low[0][j]) <= end);
        if ((hit[0] | hit[1] | hit[2] | hit[3]) == 0) continue;
        for (std::size_t k = 0; k < lanes; ++k)
            if (hit[k] && tile.owns(a.first_tile[i], b.first_tile[j + k]))
                pairs.push_back({std::min(a.row[i], b.row[j + k]), std::max(a.row[i], b.row[j + k])});
    }
}

KOLIZE_WIDE void sweep(const Tile& tile, const SortedBoxes& boxes, std::size_t begin, std::size_t end,
                       std::vector<Pair>& pairs) {
    for (std::size_t i = begin; i < end; ++i) scan(tile, boxes, i, boxes, i + 1, pairs);
}

// Each box against those of the other list that begin with it or later; if two begin together, `a` goes first.
KOLIZE_WIDE void sweep(const Tile& tile, const SortedBoxes& a, std::size_t begin_a, std::size_t end_a,
                       const SortedBoxes& b, std::size_t begin_b, std::size_t end_b, std::vector<Pair>& pairs) {
    std::size_t begin = begin_b;
    for (std::size_t i = begin_a; i < end_a; ++i) {
        while (b.low[0][begin] < a.low[0][i]) ++begin;
        scan(tile, a, i, b, begin, pairs);
    }
    begin = begin_a;
    for (std::size_t i = begin_b; i < end_b; ++i) {
        while (begin < end_a && a.low[0][begin] <= b.low[0][i]) ++begin;
        scan(tile, b, i, a, begin, pairs);
    }
}

class SweepAndPrune final : public kolize::Broadphase {
public:
    static void parameters(kolize::Parameters<SweepAndPrune>& p) {
        p.add("method", &SweepAndPrune::method_)
            .choices({"scratch", "incremental"})
            .doc(
                "scratch: sorts and sweeps along one axis in every step. incremental: keeps sorted end points and "
                "pairs.");
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) override {
        kolize::require_valid_bounds(input.bounds);
        const bool anew = input.generation != generation_ || input.bounds.size() != rows_;
        generation_ = input.generation;
        rows_ = input.bounds.size();
        if (anew) {
            axis_ = -1;
            sort_.reserve(rows_);
            files_.entries.reserve(2 * rows_);
            files_.begin.reserve(rows_ + 2);
            moving_boxes_.reserve(rows_ + lanes);
            static_boxes_.reserve(2 * rows_ + lanes);
            static_begin_.reserve(rows_ + 2);
        }
        if (method_ == "scratch") return sweep_all(input, pairs);
        if (anew || !keep_up(input)) begin_anew(input);
        previous_.assign(input.bounds.begin(), input.bounds.end());
        pairs.insert(pairs.end(), overlapping_.begin(), overlapping_.end());
    }

private:
    // ------------------------------------------------------------------------------------------ scratch

    void sweep_all(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) {
        const int axis = choose_axis(input.bounds);
        const Tiles tiles = choose_tiles(input.bounds, axis);
        if (axis != axis_ || !tiles.are_like(tiles_)) {
            axis_ = axis;
            tiles_ = tiles;
            sort_static_boxes(input);
        }
        files_.file(input, false, axis_, tiles_);
        for (std::uint32_t t = 0; t < tiles_.count(); ++t) {
            const std::span<const Entry> entries = files_.of_tile(t);
            if (entries.empty()) continue;
            const Tile tile{t / tiles_.axis[1].count, t % tiles_.axis[1].count};
            moving_boxes_.clear();
            moving_boxes_.add(entries, sort_);
            sweep(tile, moving_boxes_, 0, entries.size(), pairs);
            const std::size_t begin = static_begin_[t], end = static_begin_[t + 1] - lanes;
            if (begin < end) sweep(tile, moving_boxes_, 0, entries.size(), static_boxes_, begin, end, pairs);
        }
    }

    void sort_static_boxes(const kolize::BroadphaseInput& input) {
        files_.file(input, true, axis_, tiles_);
        static_boxes_.clear();
        static_begin_.assign(1, 0);
        for (std::uint32_t t = 0; t < tiles_.count(); ++t) {
            static_boxes_.add(files_.of_tile(t), sort_);
            static_begin_.push_back(static_boxes_.size());
        }
    }

    // Three times as wide as a box in the root mean square, so that even a few huge ones do not stand in many tiles;
    // and not more of them than there are boxes to fill them.
    Tiles choose_tiles(std::span<const Aabb> bounds, int sweep_axis) const {
        constexpr double widths = 3, boxes_in_a_tile = 16;
        constexpr std::size_t samples = 64;
        Tiles tiles;
        const auto rows = static_cast<double>(bounds.size());
        const double most = std::floor(std::sqrt(rows / boxes_in_a_tile));
        for (int k = 0; k < 2 && most >= 2; ++k) {
            const int axis = (sweep_axis + k + 1) % 3;
            double squares = 0, sample[samples];
            for (const Aabb& box : bounds) squares += (box.max[axis] - box.min[axis]) * (box.max[axis] - box.min[axis]);
            for (std::size_t i = 0; i < samples; ++i) sample[i] = bounds[i * bounds.size() / samples].min[axis];
            std::sort(sample, sample + samples);
            const double origin = sample[1], range = sample[samples - 2] - origin;
            const double width = std::max(widths * std::sqrt(squares / rows), range / most);
            if (!(width > 0 && range < kolize::infinity && range >= 2 * width)) continue;
            tiles.axis[k] = {origin, 1 / width, static_cast<std::uint32_t>(std::min(range / width, most))};
        }
        return tiles;
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
    Tiles tiles_;
    KeySort sort_;
    Files files_;
    SortedBoxes moving_boxes_;  // of one tile
    SortedBoxes static_boxes_;  // of all tiles
    std::vector<std::size_t> static_begin_;
    std::vector<EndPoint> ends_[3];
    std::vector<Aabb> previous_;     // the boxes of the last step
    std::vector<Pair> overlapping_;  // and its pairs
};

}  // namespace

KOLIZE_PLUGIN(
    SweepAndPrune, .name = "sweep_and_prune",
    .summary = "boxes sorted along an axis; only those whose extents overlap are tested",
    .source =
        "Baraff, Dynamic Simulation of Non-penetrating Rigid Bodies (1992), 3.1; Cohen et al., I-COLLIDE, "
        "I3D 1995",
    .cost =
        "scratch: O(N log N) to sort, and a quarter of a comparison for each two boxes of a tile whose extents "
        "overlap along the axis: about as many as there are pairs where boxes fill space, O(N^2) where all lie "
        "in a row of their own width. incremental: O(N + pairs) and the number of end points that change "
        "places; longer than scratch where everything moves. About 150 bytes a box, incremental 300 and 8 a "
        "pair.",
    .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
    .choose =
        "Boxes of very different sizes, at any number, and all of them moving; some thousand boxes of any "
        "kind. incremental pays if hardly anything moves from step to step. For many boxes of similar size "
        "take grid.",
    .capabilities = {.exact = true})
