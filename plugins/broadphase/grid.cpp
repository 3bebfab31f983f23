// Broadphase by uniform grids: only boxes of neighbouring cells can overlap.
//
// Source    Ericson, Real-Time Collision Detection (2005), 7.1 uniform grids, 7.2 hierarchical grids.
// Cost      O(N + pairs) for boxes of similar size, times the number of levels when sizes differ; 60 bytes a box and
//           four 4-byte cells a box. Nothing is kept between steps, so fast motion costs no more than slow.
// Accuracy  Exact: a pair is reported if and only if its closed boxes overlap.
// Choose it almost always. Where many boxes are long and thin, so that cells as large as the boxes are long hold many
// of them, `bsp` and `sphere_hierarchy` are better.
//
// Every box is filed in one cell only, that of its min corner. No cell is smaller than the boxes filed in it, so the
// min corners of two overlapping boxes are at most one cell apart in every axis, and looking at one half of the
// neighbours finds each pair once. Boxes of very different size go to different levels, each a grid of its own; a box
// then looks at its surroundings in all the coarser ones. The array of cells is as long as there are boxes to fill it,
// however far apart they are: what lies beyond the end of a row goes on in the next one, and beyond the last row in the
// first. That can only add candidates, and leaves neighbours in x neighbours in memory.
#include <kolize/plugin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <set>
#include <utility>

namespace {

using kolize::Aabb;
using kolize::Pair;
using kolize::Vec3;

using Cell = std::array<std::int64_t, 3>;

struct Item {
    double min[3], max[3];
    std::uint32_t row;
    std::uint32_t slot;  // counted from its level's first one
};

// The cells of a level are numbered x + row y + layer z, modulo their number.
struct Level {
    double cells_per_half_metre = 0;
    Cell size{};  // at least 3 cells in each axis, or a cell would meet a neighbour twice
    std::uint32_t row = 0, layer = 0, slots = 0;
    std::uint32_t first_slot = 0;
    std::uint32_t first_item = 0, items = 0;

    std::uint32_t slot(const Cell& cell) const {
        const std::int64_t rows = slots / row;
        const std::int64_t z = cell[2] < size[2] ? cell[2] : cell[2] % size[2];
        const std::int64_t y = cell[1] < rows ? cell[1] : cell[1] % rows;
        const std::int64_t sum = cell[0] + y * row + z * layer;
        return static_cast<std::uint32_t>(sum < slots ? sum : sum % slots);
    }
};

class Grid final : public kolize::Broadphase {
public:
    static void parameters(kolize::Parameters<Grid>& p) {
        p.add("cell_size", &Grid::cell_size_)
            .unit("m")
            .range(0, 1e9)
            .doc("Side of the finest cells; larger boxes go to coarser levels. 0: as large as the boxes.");
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) override {
        kolize::require_valid_bounds(input.bounds);
        if (input.bounds.size() < 2) return;
        choose_levels(input.bounds);
        sort_into_cells(input.bounds);
        is_static_ = input.is_static;
        for (std::size_t fine = 0; fine < levels_.size(); ++fine) {
            find_within(levels_[fine], pairs);
            for (std::size_t coarse = 0; coarse < fine; ++coarse) find_between(levels_[fine], levels_[coarse], pairs);
        }
    }

    // The cells in which a box is filed; those of the largest boxes are level 0.
    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        kolize::require_valid_bounds(input.bounds);
        choose_levels(input.bounds);
        std::set<std::pair<std::uint32_t, Cell>> cells;
        for (const Aabb& box : input.bounds) {
            const std::uint32_t level = class_of(half_side(box)).level;
            cells.emplace(level, cell_of(levels_[level], box.min));
        }
        for (const auto& [level, cell] : cells) {
            const double side = 2 / levels_[level].cells_per_half_metre;
            const Vec3 corner = corners_.min + side * Vec3(double(cell[0]), double(cell[1]), double(cell[2]));
            outline.boxes.push_back({{corner, corner + Vec3::Constant(side)}, level});
        }
    }

private:
    static constexpr std::size_t max_levels = 16;
    static constexpr double level_ratio = 4;  // sizes that share a level: smaller ones leave room to spare in its cells
    static constexpr std::int64_t cells_per_item = 4;

    // Sizes are counted by the binary exponent of the longest side.
    struct SizeClass {
        double longest = 0;
        std::uint32_t count = 0;
        std::uint32_t level = 0;
    };

    // Half of it, because the difference of two finite numbers need not be finite.
    double half_side(const Aabb& box) const {
        const Vec3 half = 0.5 * box.max - 0.5 * box.min;
        return std::max({half.x(), half.y(), half.z(), 0.5 * cell_size_});
    }
    static std::size_t class_index(double size) { return std::bit_cast<std::uint64_t>(size) >> 52; }
    SizeClass& class_of(double size) { return classes_[class_index(size)]; }

    void choose_levels(std::span<const Aabb> bounds) {
        std::fill(classes_.begin() + first_class_, classes_.begin() + end_class_, SizeClass{});
        first_class_ = classes_.size();
        end_class_ = 0;
        corners_ = {};
        for (const Aabb& box : bounds) {
            const double size = half_side(box);
            SizeClass& c = class_of(size);
            c.longest = std::max(c.longest, size);
            ++c.count;
            first_class_ = std::min(first_class_, class_index(size));
            end_class_ = std::max(end_class_, class_index(size) + 1);
            corners_.include(box.min);
        }
        if (first_class_ > end_class_) first_class_ = end_class_;  // no box
        levels_.reserve(max_levels);
        levels_.clear();
        double coarsest = 0;
        for (std::size_t i = end_class_; i-- > first_class_;) {
            SizeClass& c = classes_[i];
            if (c.count == 0) continue;
            if (levels_.empty() || (c.longest * level_ratio < coarsest && levels_.size() < max_levels)) {
                coarsest = c.longest;
                levels_.push_back({.cells_per_half_metre = 1 / cell_side(c.longest)});
            }
            c.level = static_cast<std::uint32_t>(levels_.size() - 1);
            levels_.back().items += c.count;
        }
        for (Level& level : levels_) choose_size(level);
    }

    // A little larger than the largest box, and not too small a part of the whole: rounding, which is at most one part
    // in 2^52 of the whole, must not carry a box across two borders.
    double cell_side(double longest) const {
        const double whole = (0.5 * corners_.max - 0.5 * corners_.min).maxCoeff();
        return std::max({longest * (1 + 0x1p-8), whole * 0x1p-42, 1e-300});
    }

    // As many cells as the boxes reach over, but no more than a few for each box: the shortest axis is served first.
    void choose_size(Level& level) const {
        const Cell wanted = cell_of(level, corners_.max);
        std::array<int, 3> axes{0, 1, 2};
        std::sort(axes.begin(), axes.end(), [&](int i, int j) { return wanted[i] < wanted[j]; });
        std::int64_t left = cells_per_item * level.items;
        for (int i = 0; i < 3; ++i) {
            const auto fair = static_cast<std::int64_t>(std::pow(static_cast<double>(left), 1.0 / (3 - i)));
            level.size[axes[i]] = std::max<std::int64_t>(3, std::min(wanted[axes[i]] + 1, fair));
            left /= level.size[axes[i]];
        }
        level.row = static_cast<std::uint32_t>(level.size[0]);
        level.layer = static_cast<std::uint32_t>(level.size[1]) * level.row;
        level.slots = static_cast<std::uint32_t>(level.size[2]) * level.layer;
    }

    // Monotone in every coordinate, which is all that finding every pair rests on.
    template <class Point>
    Cell cell_of(const Level& level, const Point& p) const {
        Cell cell;
        for (int axis = 0; axis < 3; ++axis)
            cell[axis] =
                static_cast<std::int64_t>((0.5 * p[axis] - 0.5 * corners_.min[axis]) * level.cells_per_half_metre);
        return cell;
    }

    // Counting sort: afterwards the items of a slot are those from slots_[slot] up to slots_[slot + 1].
    void sort_into_cells(std::span<const Aabb> bounds) {
        std::uint32_t slots = 0, items = 0;
        for (Level& level : levels_) {
            level.first_slot = std::exchange(slots, slots + level.slots);
            level.first_item = std::exchange(items, items + level.items);
        }
        slots_.reserve(cells_per_item * items + 27 * max_levels + 1);  // never too few, wherever the boxes go
        slots_.assign(slots + 1, 0);
        unsorted_.resize(items);
        for (std::uint32_t row = 0; row < items; ++row) {
            const Level& level = levels_[class_of(half_side(bounds[row])).level];
            const std::uint32_t slot = level.slot(cell_of(level, bounds[row].min));
            unsorted_[row] = {slot, level.first_slot + slot};
            ++slots_[level.first_slot + slot];
        }
        std::uint32_t end = 0;
        for (std::uint32_t& slot : slots_) slot = end += slot;
        items_.resize(items);
        for (std::uint32_t row = items; row-- > 0;) {
            const auto& [min, max] = bounds[row];
            items_[--slots_[unsorted_[row].second]] = {
                {min.x(), min.y(), min.z()}, {max.x(), max.y(), max.z()}, row, unsorted_[row].first};
        }
    }

    void find_within(const Level& level, std::vector<Pair>& pairs) const {
        for (std::uint32_t i = level.first_item; i < level.first_item + level.items; ++i) {
            const Item& item = items_[i];
            test(item, i + 1, slots_[level.first_slot + item.slot + 1], pairs);
            test_slots(item, level, item.slot + 1, 1, pairs);
            test_slots(item, level, item.slot + level.row - 1, 3, pairs);
            test_slots(item, level, item.slot + level.layer - level.row - 1, 3, pairs);
            test_slots(item, level, item.slot + level.layer - 1, 3, pairs);
            test_slots(item, level, item.slot + level.layer + level.row - 1, 3, pairs);
        }
    }

    // A box that overlaps has its min corner in a cell of the fine box or one below.
    void find_between(const Level& fine, const Level& coarse, std::vector<Pair>& pairs) const {
        for (std::uint32_t i = fine.first_item; i < fine.first_item + fine.items; ++i) {
            const Item& item = items_[i];
            const Cell low = cell_of(coarse, item.min);
            const Cell high = cell_of(coarse, item.max);
            const auto length = static_cast<std::uint32_t>(high[0] - low[0] + 2);
            const std::uint32_t corner = coarse.slot(low) + 2 * coarse.slots - coarse.layer - coarse.row - 1;
            for (std::uint32_t z = 0; z <= high[2] - low[2] + 1; ++z)
                for (std::uint32_t y = 0; y <= high[1] - low[1] + 1; ++y)
                    test_slots(item, coarse, (corner + z * coarse.layer + y * coarse.row) % coarse.slots, length,
                               pairs);
        }
    }

    // Up to three slots in a row, which may begin or end beyond the last one.
    void test_slots(const Item& item, const Level& level, std::uint32_t first, std::uint32_t count,
                    std::vector<Pair>& pairs) const {
        const std::uint32_t* slots = slots_.data() + level.first_slot;
        if (first + count <= level.slots) return test(item, slots[first], slots[first + count], pairs);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t slot = (first + i) % level.slots;
            test(item, slots[slot], slots[slot + 1], pairs);
        }
    }

    void test(const Item& a, std::uint32_t begin, std::uint32_t end, std::vector<Pair>& pairs) const {
        for (std::uint32_t i = begin; i < end; ++i) {
            const Item& b = items_[i];
            if (overlap(a, b) && !(is_static_[a.row] && is_static_[b.row]))
                pairs.push_back({std::min(a.row, b.row), std::max(a.row, b.row)});
        }
    }

    // Without branches: which of the six comparisons fails first cannot be predicted.
    static bool overlap(const Item& a, const Item& b) {
        bool all = true;
        for (int axis = 0; axis < 3; ++axis) all &= (a.min[axis] <= b.max[axis]) & (b.min[axis] <= a.max[axis]);
        return all;
    }

    double cell_size_ = 0;

    std::array<SizeClass, 2048> classes_;
    std::size_t first_class_ = 0, end_class_ = 0;  // those in use
    Aabb corners_;                                 // of the min corners
    std::vector<Level> levels_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> unsorted_;
    std::vector<std::uint32_t> slots_;
    std::vector<Item> items_;
    std::span<const std::uint8_t> is_static_;
};

}  // namespace

KOLIZE_PLUGIN(
    Grid, .name = "grid", .summary = "uniform grid, one level for each range of sizes",
    .source = "Ericson, Real-Time Collision Detection (2005), 7.1-7.2",
    .cost =
        "O(N + pairs) for boxes of similar size, times the number of levels when sizes differ; about 200 bytes a box. "
        "When less than a quarter of the boxes have moved, only these are filed and looked for anew.",
    .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
    .choose =
        "Almost always. Where many boxes are long and thin, so that cells as large as the boxes are long hold many of "
        "them, bsp and sphere_hierarchy are better.",
    .capabilities = {.exact = true, .outline = "cells"})
