// Broadphase by regions: space is divided by the boxes of reference bodies, such as the rooms of a building or the
// pieces of a tunnel.
//
// A box is filed in every region that it overlaps, and in the rest if no region holds all of it. Two boxes that overlap
// have a region in common: if one of them lies inside a region, the other one reaches into that region, and otherwise
// both stand in the rest. Pairs are looked for region by region, by a sweep along one axis, and reported in the first
// region that the two have in common. Static boxes stay filed while the generation stays.
#include <kolize/plugin.h>

#include <algorithm>

namespace {

using kolize::Aabb;
using kolize::Pair;
using kolize::Vec3;

struct Region {
    Aabb box;
    double reach;  // the farthest end of this region and those before it
};

struct Entry {
    std::uint32_t region, row;
    double low;  // where the box begins along the axis
};

// The filed boxes of one kind, static or moving.
struct Files {
    std::vector<Entry> entries;          // by region, then by low
    std::vector<std::uint32_t> regions;  // of all rows, one behind the other; ascending for each
};

class Regions final : public kolize::Broadphase {
public:
    void find_pairs(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) override {
        kolize::require_valid_bounds(input.bounds);
        input_ = input;
        pairs_ = &pairs;
        const bool anew = input.generation != generation_ || input.bounds.size() != first_region_.size();
        generation_ = input.generation;
        if (anew) begin_anew();
        if (anew || references_move_) {
            find_regions();
            file(true, static_files_);
        }
        file(false, moving_files_);
        search();
    }

    // The regions, and a box around what is filed in the rest.
    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        std::vector<Pair> ignored;
        find_pairs(input, ignored);
        for (const Region& region : regions_) outline.boxes.push_back({region.box});
        Aabb rest;
        for (const Files* files : {&static_files_, &moving_files_})
            for (const Entry& entry : files->entries)
                if (entry.region == regions_.size()) {
                    rest.include(input.bounds[entry.row].min);
                    rest.include(input.bounds[entry.row].max);
                }
        if (rest.finite()) outline.boxes.push_back({rest, 1});
    }

private:
    void begin_anew() {
        const std::size_t rows = input_.bounds.size();
        first_region_.resize(rows);
        for (Files* files : {&static_files_, &moving_files_}) {
            files->entries.reserve(4 * rows);  // most boxes lie in one region or two
            files->regions.reserve(4 * rows);
        }
        references_move_ = false;
        for (std::size_t row = 0; row < input_.is_reference.size(); ++row)
            references_move_ |= input_.is_reference[row] && !input_.is_static[row];
        Aabb corners;
        for (const Aabb& box : input_.bounds) corners.include(0.5 * box.min);
        axis_ = 0;
        if (rows > 0) (corners.max - corners.min).maxCoeff(&axis_);
    }

    void find_regions() {
        regions_.clear();
        for (std::size_t row = 0; row < input_.is_reference.size(); ++row)
            if (input_.is_reference[row]) regions_.push_back({input_.bounds[row], 0});
        std::sort(regions_.begin(), regions_.end(),
                  [this](const Region& a, const Region& b) { return a.box.min[axis_] < b.box.min[axis_]; });
        double reach = -kolize::infinity;
        for (Region& region : regions_) region.reach = reach = std::max(reach, region.box.max[axis_]);
    }

    void file(bool is_static, Files& files) {
        files.entries.clear();
        files.regions.clear();
        for (std::uint32_t row = 0; row < input_.bounds.size(); ++row)
            if ((input_.is_static[row] != 0) == is_static) file(row, files);
        std::sort(files.entries.begin(), files.entries.end(), [](const Entry& a, const Entry& b) {
            return a.region != b.region ? a.region < b.region : a.low != b.low ? a.low < b.low : a.row < b.row;
        });
    }

    void file(std::uint32_t row, Files& files) {
        const Aabb& box = input_.bounds[row];
        const auto add = [&](std::size_t region) {
            files.entries.push_back({static_cast<std::uint32_t>(region), row, box.min[axis_]});
            files.regions.push_back(static_cast<std::uint32_t>(region));
        };
        const auto first = std::partition_point(regions_.begin(), regions_.end(),
                                                [&](const Region& r) { return r.reach < box.min[axis_]; });
        bool inside = false;
        first_region_[row] = static_cast<std::uint32_t>(files.regions.size());
        for (auto region = first; region != regions_.end() && region->box.min[axis_] <= box.max[axis_]; ++region) {
            if (!region->box.overlaps(box)) continue;
            add(static_cast<std::size_t>(region - regions_.begin()));
            inside |= (region->box.min.array() <= box.min.array()).all() &&
                      (box.max.array() <= region->box.max.array()).all();
        }
        if (!inside) add(regions_.size());
    }

    void search() {
        const std::vector<Entry>&moving = moving_files_.entries, &standing = static_files_.entries;
        std::size_t m = 0, s = 0;
        while (m < moving.size()) {
            const std::uint32_t region = moving[m].region;
            const std::size_t first_m = m;
            while (m < moving.size() && moving[m].region == region) ++m;
            while (s < standing.size() && standing[s].region < region) ++s;
            const std::size_t first_s = s;
            while (s < standing.size() && standing[s].region == region) ++s;
            const std::span<const Entry> a(&moving[first_m], m - first_m);
            sweep(a);
            if (s > first_s) sweep(a, {&standing[first_s], s - first_s});
        }
    }

    void sweep(std::span<const Entry> a) {
        for (std::size_t i = 0; i < a.size(); ++i) scan(a[i], a.subspan(i + 1));
    }

    // Each box against those of the other list that begin with it or later; if two begin together, `a` goes first.
    void sweep(std::span<const Entry> a, std::span<const Entry> b) {
        std::size_t i = 0, j = 0;
        while (i < a.size() && j < b.size())
            if (a[i].low <= b[j].low)
                scan(a[i++], b.subspan(j));
            else
                scan(b[j++], a.subspan(i));
    }

    void scan(const Entry& a, std::span<const Entry> others) {
        const Aabb& box = input_.bounds[a.row];
        for (const Entry& b : others) {
            if (b.low > box.max[axis_]) return;
            if (box.overlaps(input_.bounds[b.row]) && first_in_common(a.row, b.row) == a.region)
                pairs_->push_back({std::min(a.row, b.row), std::max(a.row, b.row)});
        }
    }

    std::uint32_t first_in_common(std::uint32_t row_a, std::uint32_t row_b) const {
        const auto regions_of = [this](std::uint32_t row) {
            const Files& files = input_.is_static[row] ? static_files_ : moving_files_;
            return files.regions.data() + first_region_[row];
        };
        const std::uint32_t *a = regions_of(row_a), *b = regions_of(row_b);
        while (*a != *b) *a < *b ? ++a : ++b;  // they have one: the boxes were found in it
        return *a;
    }

    kolize::BroadphaseInput input_;
    std::vector<Pair>* pairs_ = nullptr;
    std::uint64_t generation_ = 0;
    int axis_ = 0;
    bool references_move_ = false;
    std::vector<Region> regions_;  // by where they begin along the axis; the rest has the number behind the last one
    std::vector<std::uint32_t> first_region_;  // by row: where its regions stand in its files
    Files static_files_, moving_files_;
};

}  // namespace

KOLIZE_PLUGIN(Regions, .name = "regions", .summary = "space divided by the boxes of reference bodies",
              .source =
                  "a hierarchy of one level whose subspaces are given by bodies of the scene; within each, sweep and "
                  "prune along one axis: Ericson, Real-Time Collision Detection (2005), 7.5",
              .cost =
                  "O(N log N) to file and sort, and a comparison for each two boxes of a region whose extents overlap "
                  "along one axis. Without references one region holds everything. About 100 bytes a box.",
              .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
              .choose =
                  "Scenes that bodies with reference = true divide by nature: the rooms of a building, the pieces of "
                  "a tunnel. Without such bodies take grid.",
              .capabilities = {.exact = true, .outline = "cells"})
