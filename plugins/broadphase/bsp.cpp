// Broadphase by binary space partition: space is halved by planes until few boxes are left in each part.
//
// Planes stand across the axes only, as in Bentley's k-d tree. The tree is walked as it is made and never stored.
#include <kolize/plugin.h>

#include <algorithm>

namespace {

using kolize::Aabb;
using kolize::Pair;
using kolize::Vec3;

struct Plane {
    int axis = 0;
    double at = 0;

    // A box that straddles the plane lies on both sides.
    bool has_below(const Aabb& box) const { return box.min[axis] < at; }
    bool has_above(const Aabb& box) const { return box.max[axis] >= at; }
};

class Bsp final : public kolize::Broadphase {
public:
    static void parameters(kolize::Parameters<Bsp>& p) {
        p.add("leaf_size", &Bsp::leaf_size_).range(1, 1e6).doc("A part with no more boxes than this is not halved.");
        p.add("max_depth", &Bsp::max_depth_).range(0, 64).doc("Planes between the whole and its smallest part.");
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) override {
        kolize::require_valid_bounds(input.bounds);
        pairs_ = &pairs;
        outline_ = nullptr;
        const Vec3 all = Vec3::Constant(kolize::infinity);
        divide_all(input, {-all, all});
    }

    // The planes, each as far as the part that it halves; the level is the number of planes above it.
    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        kolize::require_valid_bounds(input.bounds);
        outline_ = &outline;
        Aabb whole;
        for (const Aabb& box : input.bounds) {
            whole.include(box.min);
            whole.include(box.max);
        }
        divide_all(input, whole);
    }

private:
    static constexpr std::size_t sample_size = 63;
    // Halving is worth its cost if it leaves at most this part of the box tests.
    static constexpr double worthwhile = 0.9;

    void divide_all(const kolize::BroadphaseInput& input, const Aabb& whole) {
        input_ = input;
        rows_.reserve(4 * input.bounds.size());  // halves add up to twice the whole, and some boxes lie in both
        rows_.resize(input.bounds.size());
        for (std::uint32_t row = 0; row < rows_.size(); ++row) rows_[row] = row;
        divide(0, whole, 0);
    }

    // The part's boxes are the rows from `begin` to the end of rows_; they are the same again on return.
    void divide(std::size_t begin, const Aabb& part, int depth) {
        const std::size_t end = rows_.size();
        Plane plane;
        if (end - begin <= static_cast<std::size_t>(leaf_size_) || depth >= max_depth_ || !choose_plane(begin, plane))
            return outline_ ? void() : test_leaf(begin, part);

        Aabb half = part;
        half.max[plane.axis] = plane.at;
        if (outline_) {
            Aabb piece = half;
            piece.min[plane.axis] = plane.at;
            outline_->boxes.push_back({piece, static_cast<std::uint32_t>(depth)});
        }
        push_rows(begin, end, [&](const Aabb& box) { return plane.has_below(box); });
        divide(end, half, depth + 1);
        rows_.resize(end);

        half = part;
        half.min[plane.axis] = plane.at;
        push_rows(begin, end, [&](const Aabb& box) { return plane.has_above(box); });
        divide(end, half, depth + 1);
        rows_.resize(end);
    }

    template <class Predicate>
    void push_rows(std::size_t begin, std::size_t end, Predicate&& belongs) {
        for (std::size_t i = begin; i < end; ++i)
            if (const std::uint32_t row = rows_[i]; belongs(input_.bounds[row])) rows_.push_back(row);
    }

    // Of the three planes through the middle of the boxes, the one that leaves the fewest pairs to test; false if none
    // leaves noticeably fewer.
    bool choose_plane(std::size_t begin, Plane& best) {
        const double count = static_cast<double>(rows_.size() - begin);
        double least = worthwhile * count * count;
        bool found = false;
        for (int axis = 0; axis < 3; ++axis) {
            const Plane plane{axis, median(begin, axis)};
            double below = 0, above = 0;
            for (std::size_t i = begin; i < rows_.size(); ++i) {
                below += plane.has_below(input_.bounds[rows_[i]]);
                above += plane.has_above(input_.bounds[rows_[i]]);
            }
            if (const double tests = below * below + above * above; tests < least) {
                least = tests;
                best = plane;
                found = true;
            }
        }
        return found;
    }

    // Of the centres of a few boxes, evenly taken.
    double median(std::size_t begin, int axis) {
        const std::size_t count = rows_.size() - begin;
        const std::size_t samples = std::min(count, sample_size);
        for (std::size_t i = 0; i < samples; ++i) {
            const Aabb& box = input_.bounds[rows_[begin + i * count / samples]];
            sample_[i] = 0.5 * box.min[axis] + 0.5 * box.max[axis];
        }
        double* const middle = sample_ + samples / 2;
        std::nth_element(sample_, middle, sample_ + samples);
        return *middle;
    }

    // Two boxes may meet in several leaves. They are reported in the one that holds the lowest corner of what they have
    // in common: both boxes contain that point, so both were sent to the side it is on, all the way down.
    void test_leaf(std::size_t begin, const Aabb& part) {
        for (std::size_t i = begin; i < rows_.size(); ++i)
            for (std::size_t j = i + 1; j < rows_.size(); ++j) {
                const std::uint32_t a = rows_[i], b = rows_[j];  // a < b: rows are only ever filtered, in order
                const Aabb& box_a = input_.bounds[a];
                const Aabb& box_b = input_.bounds[b];
                if (!box_a.overlaps(box_b) || (input_.is_static[a] && input_.is_static[b])) continue;
                const Vec3 corner = box_a.min.cwiseMax(box_b.min);
                if ((part.min.array() <= corner.array()).all() && (corner.array() < part.max.array()).all())
                    pairs_->push_back({a, b});
            }
    }

    int leaf_size_ = 16;
    int max_depth_ = 32;

    kolize::BroadphaseInput input_;
    std::vector<Pair>* pairs_ = nullptr;
    kolize::Outline* outline_ = nullptr;  // where the planes go, if it is they that are wanted
    std::vector<std::uint32_t> rows_;     // a stack of parts, the present one on top
    double sample_[sample_size];
};

}  // namespace

KOLIZE_PLUGIN(Bsp, .name = "bsp", .summary = "space halved by planes across the axes until few boxes are left",
              .source =
                  "Fuchs, Kedem, Naylor, On visible surface generation by a priori tree structures, SIGGRAPH 1980; "
                  "Bentley 1975; Ericson, Real-Time Collision Detection (2005), 7.3-8.3",
              .cost =
                  "O(N log N + pairs) while most planes cut few boxes. Memory is 4 bytes for each box in the parts "
                  "between the root and the present one.",
              .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
              .choose =
                  "Boxes that are long, thin or of very different sizes and lie unevenly: it has no cell size to get "
                  "wrong. Take grid for boxes of similar size.",
              .capabilities = {.exact = true, .outline = "planes"})
