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
        if (is_known(input) && file_moved(input.bounds)) {
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
    static constexpr std::size_t most_strayed = 32;  // one row in so many: all are filed anew when more have left

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

    // Files what has moved, a few rows behind the search for it, so that memory has time to bring what that needs.
    // False if looking for all is cheaper: too many have moved, or large boxes that have many small ones inside.
    bool file_moved(std::span<const Aabb> bounds) {
        constexpr std::size_t behind = 8;
        const auto rows = static_cast<std::uint32_t>(bounds.size());
        std::size_t filed = 0;
        double cells = 0;
        moved_.clear();
        if (most_of_some_moved(bounds)) return false;
        for (std::uint32_t row = 0; row < rows; ++row) {
            if (is_same(bounds[row], seen_[row])) continue;
            if (!kolize::is_valid(bounds[row])) refuse(bounds);
            seen_[row] = bounds[row];
            moved_.push_back(row);
            cells_.prefetch(row);
            cells += cells_.cells_inside(bounds[row]);
            if (moved_.size() > rows / most_moved || cells > rows) return false;
            if (moved_.size() > behind) file(moved_[filed++], bounds);
        }
        while (filed < moved_.size()) file(moved_[filed++], bounds);
        if (strayed_.size() > rows / most_strayed) sort_into_cells(bounds);
        if (!strayed_.empty()) cells_of_strayed_.build(bounds, strayed_, cell_size_);
        return true;
    }

    // Spares filing a quarter of all rows for nothing.
    bool most_of_some_moved(std::span<const Aabb> bounds) const {
        constexpr std::size_t some = 64;
        std::size_t moved = 0;
        for (std::size_t i = 0; i < some; ++i) {
            const std::size_t row = i * bounds.size() / some;
            moved += !is_same(bounds[row], seen_[row]);
        }
        return moved > some / 2;
    }

    void file(std::uint32_t row, std::span<const Aabb> bounds) {
        if (has_strayed_[row] || cells_.move(row, bounds[row])) return;
        has_strayed_[row] = 1;
        strayed_.push_back(row);
    }

    // Nothing is known afterwards.
    void refuse(std::span<const Aabb> bounds) {
        seen_.clear();
        kolize::require_valid_bounds(bounds);
    }

    void file_all(const kolize::BroadphaseInput& input) {
        const bool known = is_known(input);
        seen_.clear();  // nothing is known if this throws
        if (!known) {
            rows_.resize(input.bounds.size());
            std::iota(rows_.begin(), rows_.end(), 0u);
            is_moved_.resize_empty(rows_.size());
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

    // What has strayed looks at the cells, those in the cells do not look at it: it is fewer.
    void find_pairs_of_moved(std::span<const Aabb> bounds) {
        for (const std::uint32_t row : moved_) is_moved_.add(row);
        std::size_t kept = 0;
        for (const Pair pair : pairs_) {  // by value: what is kept may be written over it
            pairs_[kept] = pair;
            kept += !(is_moved_.has(pair.a) | is_moved_.has(pair.b));
        }
        pairs_.resize(kept);
        const auto report = [&](std::uint32_t a, std::uint32_t b, bool certain) {
            if (certain || bounds[a].overlaps(bounds[b])) pairs_.push_back({std::min(a, b), std::max(a, b)});
        };
        const auto hit = [&](std::uint32_t a, std::uint32_t b, bool certain) {
            if (b != a && !(is_moved_.has(b) && b < a)) report(a, b, certain);
        };
        const auto hit_in_cells = [&](std::uint32_t strayed, std::uint32_t b, bool certain) {
            if (is_moved_.has(strayed) || is_moved_.has(b)) report(strayed, b, certain);
        };
        Found found;
        cells_.for_rows(is_moved_, bounds, found, hit);
        for (const std::uint32_t row : strayed_)
            if (is_moved_.has(row)) cells_of_strayed_.for_box(row, bounds[row], found, hit);
        found.empty_into(hit);
        if (!strayed_.empty())
            cells_of_strayed_.for_each(
                [&](std::uint32_t row) { cells_.for_box(row, bounds[row], found, hit_in_cells); });
        found.empty_into(hit_in_cells);
        for (const std::uint32_t row : moved_) is_moved_.remove(row);
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
    std::vector<std::uint32_t> moved_;  // since the call before
    kolize::RowSet is_moved_;           // empty between calls
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
