#include "mesh_io/polygon.h"

#include <algorithm>
#include <queue>

namespace kolize::mesh_io {

namespace {

using Vec2 = Eigen::Vector2d;

// Twice the area of a triangle, positive if it runs counter-clockwise.
double area(const Vec2& a, const Vec2& b, const Vec2& c) {
    const Vec2 ab = b - a, ac = c - a;
    return ab.x() * ac.y() - ab.y() * ac.x();
}

// Newell's method: any polygon, of any length (Tampieri, "Newell's method for computing the plane equation of a
// polygon", Graphics Gems III, 1992).
Vec3 newell_normal(std::span<const Vec3> points, std::span<const std::uint32_t> corners) {
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 2; k < corners.size(); ++k)
        normal += (points[corners[k - 1]] - points[corners[0]]).cross(points[corners[k]] - points[corners[0]]);
    return normal;
}

// Whether no triangle of the fan is turned against the polygon.
bool is_fan(std::span<const Vec3> points, std::span<const std::uint32_t> corners) {
    const Vec3 normal = newell_normal(points, corners);
    const Vec3& first = points[corners[0]];
    for (std::size_t k = 2; k < corners.size(); ++k)
        if ((points[corners[k - 1]] - first).cross(points[corners[k]] - first).dot(normal) < 0) return false;
    return true;
}

// Ear clipping (Meisters, "Polygons have ears", American Mathematical Monthly 82, 1975; O'Rourke, Computational
// Geometry in C, 1.6): a corner is an ear if no other one lies in its triangle. Cutting one off changes only whether
// its two neighbours are ears, so each corner is looked at three times on average.
class EarClipper {
public:
    EarClipper(std::vector<Triangle>& triangles, std::span<const std::uint32_t> corners,
               const std::vector<Vec2>& places)
        : triangles_(triangles), remaining_(corners.size()) {
        const auto n = static_cast<std::uint32_t>(corners.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            ring_.push_back({places[i], corners[i], (i + n - 1) % n, (i + 1) % n});
            candidates_.push(i);
        }
        for (std::uint32_t i = 0; i < n; ++i) note_blocker(i);
    }

    void run() {
        for (; remaining_ > 3; --remaining_) cut_off(next_ear());
        cut_off(any_corner());
    }

private:
    struct Corner {
        Vec2 place;
        std::uint32_t vertex;
        std::uint32_t previous, next;
        bool cut = false;
        bool blocks = false;  // is among the blockers
    };

    double area_at(std::uint32_t i) const {
        const Corner& corner = ring_[i];
        return area(ring_[corner.previous].place, corner.place, ring_[corner.next].place);
    }

    std::uint32_t next_ear() {
        while (!candidates_.empty()) {
            const std::uint32_t i = candidates_.front();
            candidates_.pop();
            if (!ring_[i].cut && is_ear(i)) return i;
        }
        return least_harm();
    }

    // Only corners that are not convex can be the first to reach into the triangle of another.
    void note_blocker(std::uint32_t i) {
        if (ring_[i].blocks || area_at(i) > 0) return;
        ring_[i].blocks = true;
        blockers_.push_back(i);
    }

    void drop_idle_blockers() {
        std::erase_if(blockers_, [this](std::uint32_t b) {
            ring_[b].blocks = !ring_[b].cut && area_at(b) <= 0;
            return !ring_[b].blocks;
        });
    }

    bool is_ear(std::uint32_t i) {
        if (area_at(i) <= 0) return false;
        drop_idle_blockers();
        const std::uint32_t p = ring_[i].previous, n = ring_[i].next;
        for (const std::uint32_t b : blockers_)
            if (b != p && b != n && reaches_into(ring_[b], ring_[p].place, ring_[i].place, ring_[n].place))
                return false;
        return true;
    }

    bool reaches_into(const Corner& corner, const Vec2& a, const Vec2& b, const Vec2& c) const {
        const Vec2& q = corner.place;
        if (q == a) return leads_between(corner, b, c);
        if (q == b) return leads_between(corner, c, a);
        if (q == c) return leads_between(corner, a, b);
        return area(a, b, q) >= 0 && area(b, c, q) >= 0 && area(c, a, q) >= 0;
    }

    // Where the polygon touches itself: whether a side at this corner leads into the angle that two directions span.
    bool leads_between(const Corner& corner, const Vec2& right, const Vec2& left) const {
        const auto between = [&](std::uint32_t end) {
            return area(corner.place, right, ring_[end].place) > 0 && area(corner.place, ring_[end].place, left) > 0;
        };
        return between(corner.previous) || between(corner.next);
    }

    std::uint32_t any_corner() const {
        std::uint32_t i = 0;
        while (ring_[i].cut) ++i;
        return i;
    }

    // No ear is left: the polygon crosses itself, or rounding makes it so. A corner without area does no harm, a convex
    // one less than others.
    std::uint32_t least_harm() const {
        const std::uint32_t first = any_corner();
        std::uint32_t best = first;
        for (std::uint32_t i = ring_[first].next; i != first; i = ring_[i].next) {
            if (area_at(i) == 0) return i;
            if (area_at(best) < 0 && area_at(i) > 0) best = i;
        }
        return best;
    }

    void cut_off(std::uint32_t i) {
        Corner& corner = ring_[i];
        Corner &previous = ring_[corner.previous], &next = ring_[corner.next];
        triangles_.push_back({previous.vertex, corner.vertex, next.vertex});
        corner.cut = true;
        previous.next = corner.next;
        next.previous = corner.previous;
        for (const std::uint32_t neighbour : {corner.previous, corner.next}) {
            candidates_.push(neighbour);
            note_blocker(neighbour);
        }
    }

    std::vector<Triangle>& triangles_;
    std::size_t remaining_;
    std::vector<Corner> ring_;
    std::queue<std::uint32_t> candidates_;
    std::vector<std::uint32_t> blockers_;
};

}  // namespace

void add_fan(std::vector<Triangle>& triangles, std::span<const std::uint32_t> corners) {
    for (std::size_t k = 2; k < corners.size(); ++k) triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

void add_ears(std::vector<Triangle>& triangles, std::span<const Vec3> points, std::span<const std::uint32_t> corners) {
    const Vec3 normal = newell_normal(points, corners);
    if (corners.size() == 3 || !normal.allFinite() || normal.isZero(0)) return add_fan(triangles, corners);
    // Seen along the axis nearest to the normal, from the side where it runs counter-clockwise.
    Eigen::Index dropped;
    normal.cwiseAbs().maxCoeff(&dropped);
    Eigen::Index u = (dropped + 1) % 3, v = (dropped + 2) % 3;
    if (normal[dropped] < 0) std::swap(u, v);
    std::vector<Vec2> places;
    for (const std::uint32_t corner : corners) places.emplace_back(points[corner][u], points[corner][v]);
    EarClipper(triangles, corners, places).run();
}

void add_polygon(std::vector<Triangle>& triangles, std::span<const Vec3> points,
                 std::span<const std::uint32_t> corners) {
    const bool known = *std::max_element(corners.begin(), corners.end()) < points.size();
    if (corners.size() > 3 && corners.size() <= max_ear_corners && known && !is_fan(points, corners))
        add_ears(triangles, points, corners);
    else
        add_fan(triangles, corners);
}

}  // namespace kolize::mesh_io
