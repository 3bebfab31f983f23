// Broadphase by uniform grids: only boxes of neighbouring cells can overlap.
//
// Every box is filed in one cell only, that of its min corner. Cells are at least twice as large as the boxes filed in
// them, so a box has to look at two cells in each axis, and half of these find each pair once. Boxes of very different
// size go to different levels, each a grid of its own; a box then looks at its surroundings in all the coarser ones.
// Where boxes are few, larger cells and fewer levels do.
//
// How boxes lie in their cells is in grid_cells.h.
//
// The cells and the pairs are kept. While few boxes move, only these are looked for. One that stays in its cell is
// overwritten there; one that leaves goes to a second, small set of cells, which is made anew in every call.
#include "grid_cells.h"

#include <numeric>

namespace {

using kolize::Aabb;
using kolize::Cells;
using kolize::Found;
using kolize::Pair;

class Grid final : public kolize::Broadphase {
public:
    static void parameters(kolize::Parameters<Grid>& p) {
        p.add("cell_size", &Grid::cell_size_)
            .unit("m")
            .range(0, 1e9)
            .doc("Smallest side of cells; larger boxes go to coarser levels. 0: twice as large as the boxes.");
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) override {
        if (input.bounds.size() < 2) {
            kolize::require_valid_bounds(input.bounds);
            seen_.clear();
            return;
        }
        if (is_known(input) && find_moved(input.bounds) && file_moved(input.bounds)) {
            find_pairs_of_moved(input.bounds);
        } else {
            file_all(input);
            find_all_pairs(input);
        }
        if (3 * pairs_.size() > 2 * pairs_.capacity()) pairs_.reserve(2 * pairs_.size());  // a few more need no room
        pairs.insert(pairs.end(), pairs_.begin(), pairs_.end());
    }

    // The cells in which boxes are filed; those of the largest boxes are level 0.
    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        kolize::require_valid_bounds(input.bounds);
        if (input.bounds.empty()) return;
        std::vector<std::uint32_t> rows(input.bounds.size());
        std::iota(rows.begin(), rows.end(), 0u);
        Cells cells;
        cells.build(input.bounds, rows, cell_size_);
        cells.outline(input.bounds, outline);
    }

private:
    static constexpr std::size_t most_moved = 4;     // one row in so many: all are looked for when more have moved
    static constexpr std::size_t most_strayed = 16;  // one row in so many: all are filed anew when more have left

    // Bit for bit.
    static bool is_same(const Aabb& a, const Aabb& b) {
        const auto difference = [](double x, double y) {
            return std::bit_cast<std::uint64_t>(x) ^ std::bit_cast<std::uint64_t>(y);
        };
        std::uint64_t sum = 0;
        for (int axis = 0; axis < 3; ++axis)
            sum |= difference(a.min[axis], b.min[axis]) | difference(a.max[axis], b.max[axis]);
        return sum == 0;
    }

    bool is_known(const kolize::BroadphaseInput& input) const {
        return seen_.size() == input.bounds.size() && generation_ == input.generation;
    }

    // False if there are too many.
    bool find_moved(std::span<const Aabb> bounds) {
        const auto rows = static_cast<std::uint32_t>(bounds.size());
        std::size_t count = 0;
        moved_.resize(rows);
        for (std::uint32_t row = 0; row < rows && count <= rows / most_moved; ++row) {
            moved_[count] = row;
            count += !is_same(bounds[row], seen_[row]);
        }
        moved_.resize(count);
        return count <= rows / most_moved;
    }

    // False if it is cheaper to look for all: large boxes have many small ones inside.
    bool file_moved(std::span<const Aabb> bounds) {
        double cells = 0;
        for (const std::uint32_t row : moved_) {
            if (!kolize::is_valid(bounds[row])) kolize::require_valid_bounds(bounds);
            cells += cells_.cells_inside(bounds[row]);
        }
        if (cells > static_cast<double>(bounds.size())) return false;
        for (const std::uint32_t row : moved_) {
            seen_[row] = bounds[row];
            if (has_strayed_[row] || cells_.move(row, bounds[row])) continue;
            has_strayed_[row] = 1;
            strayed_.push_back(row);
        }
        if (strayed_.size() > bounds.size() / most_strayed) sort_into_cells(bounds);
        if (!strayed_.empty()) cells_of_strayed_.build(bounds, strayed_, cell_size_);
        return true;
    }

    void file_all(const kolize::BroadphaseInput& input) {
        const bool known = is_known(input);
        seen_.clear();  // nothing is known if this throws
        if (!known) {
            rows_.resize(input.bounds.size());
            std::iota(rows_.begin(), rows_.end(), 0u);
            is_moved_.assign(rows_.size(), 0);
            moved_.reserve(rows_.size());
            strayed_.reserve(rows_.size());
            pairs_.reserve(8 * rows_.size());
            cells_.reserve(rows_.size());
            cells_of_strayed_.reserve(rows_.size() / most_strayed);
            cells_.forget();
        }
        sort_into_cells(input.bounds);
        seen_.assign(input.bounds.begin(), input.bounds.end());
        generation_ = input.generation;
    }

    void sort_into_cells(std::span<const Aabb> bounds) {
        cells_.build(bounds, rows_, cell_size_);
        has_strayed_.assign(bounds.size(), 0);
        strayed_.clear();
    }

    void find_all_pairs(const kolize::BroadphaseInput& input) {
        pairs_.clear();
        cells_.for_all(input.bounds, [&](std::uint32_t a, std::uint32_t b, bool certain) {
            if (input.is_static[a] && input.is_static[b]) return;
            if (certain || input.bounds[a].overlaps(input.bounds[b]))
                pairs_.push_back({std::min(a, b), std::max(a, b)});
        });
    }

    // In the order of the cells, so that one finds in the cache what the one before has looked at.
    void sort_moved() {
        moved_.clear();
        const auto add = [&](std::uint32_t row) {
            if (is_moved_[row]) moved_.push_back(row);
        };
        cells_.for_each(add);
        for (const std::uint32_t row : strayed_) add(row);
    }

    void find_pairs_of_moved(std::span<const Aabb> bounds) {
        for (const std::uint32_t row : moved_) is_moved_[row] = 1;
        std::size_t kept = 0;
        for (const Pair& pair : pairs_) {
            pairs_[kept] = pair;
            kept += !(is_moved_[pair.a] | is_moved_[pair.b]);
        }
        pairs_.resize(kept);
        const auto hit = [&](std::uint32_t a, std::uint32_t b, bool certain) {
            if (b == a || (is_moved_[b] && b < a)) return;
            if (certain || bounds[a].overlaps(bounds[b])) pairs_.push_back({std::min(a, b), std::max(a, b)});
        };
        sort_moved();
        Found found;
        for (std::size_t i = 0; i < moved_.size(); ++i) {
            const std::uint32_t row = moved_[i];
            constexpr std::size_t ahead = 8;
            if (i + ahead < moved_.size()) __builtin_prefetch(&bounds[moved_[i + ahead]]);
            cells_.for_box(row, bounds[row], found, hit);
            if (!strayed_.empty()) cells_of_strayed_.for_box(row, bounds[row], found, hit);
        }
        found.empty_into(hit);
        for (const std::uint32_t row : moved_) is_moved_[row] = 0;
    }

    double cell_size_ = 0;

    std::vector<Aabb> seen_;  // the boxes that are filed
    std::uint64_t generation_ = 0;
    std::vector<Pair> pairs_;  // of the boxes seen
    std::vector<std::uint32_t> rows_;
    Cells cells_;  // of all rows, or of all but the strayed
    Cells cells_of_strayed_;
    std::vector<std::uint32_t> strayed_;
    std::vector<std::uint8_t> has_strayed_;
    std::vector<std::uint32_t> moved_;    // since the call before
    std::vector<std::uint8_t> is_moved_;  // all 0 between calls
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
