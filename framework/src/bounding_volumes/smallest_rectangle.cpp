#include "bounding_volumes/smallest_rectangle.h"

#include <algorithm>

namespace kolize {

namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Makes the points their convex hull, counter-clockwise, by the monotone chain of Andrew (1979).
void keep_hull(std::vector<Vec2>& points) {
    std::sort(points.begin(), points.end(),
              [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return;
    std::vector<Vec2> hull;
    const auto add_chain = [&](auto begin, auto end) {
        const std::size_t start = hull.size();
        for (auto p = begin; p != end; ++p) {
            while (hull.size() >= start + 2 && cross(hull.back() - hull.end()[-2], *p - hull.back()) <= 0)
                hull.pop_back();
            hull.push_back(*p);
        }
        hull.pop_back();  // the next chain starts with it
    };
    add_chain(points.begin(), points.end());
    add_chain(points.rbegin(), points.rend());
    points = std::move(hull);
}

// The point of the hull that is farthest in a direction, followed while the direction turns counter-clockwise. Rounding
// may stop it a little early, but never sends it round twice.
class Caliper {
public:
    Caliper(const std::vector<Vec2>& hull, const Vec2& direction) : hull_(hull), steps_left_(2 * hull.size()) {
        const auto nearer = [&](const Vec2& a, const Vec2& b) { return direction.dot(a) < direction.dot(b); };
        at_ = static_cast<std::size_t>(std::max_element(hull.begin(), hull.end(), nearer) - hull.begin());
    }

    double reach(const Vec2& direction) {
        for (; steps_left_ > 0; --steps_left_) {
            const std::size_t next = at_ + 1 == hull_.size() ? 0 : at_ + 1;
            if (direction.dot(hull_[next]) < direction.dot(hull_[at_])) break;
            at_ = next;
        }
        return direction.dot(hull_[at_]);
    }

private:
    const std::vector<Vec2>& hull_;
    std::size_t at_ = 0;
    std::size_t steps_left_;
};

}  // namespace

Vec2 smallest_rectangle_side(std::vector<Vec2>& points) {
    keep_hull(points);
    const std::vector<Vec2>& hull = points;
    Vec2 best = Vec2::UnitX();
    if (hull.size() < 2) return best;
    const Vec2 first = hull[1] - hull[0];
    Caliper ahead(hull, first), across(hull, Vec2(-first.y(), first.x())), back(hull, -first);
    double least_area = infinity;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Vec2 edge = hull[(i + 1) % hull.size()] - hull[i];
        const double length = edge.norm();
        if (length < least_extent) continue;  // too short to have a direction
        const Vec2 side = edge / length, inward(-side.y(), side.x());
        const double width = ahead.reach(side) + back.reach(-side), height = across.reach(inward) - inward.dot(hull[i]);
        const double area = std::max(width, least_extent) * std::max(height, least_extent);
        if (area < least_area) {
            least_area = area;
            best = side;
        }
    }
    return best;
}

}  // namespace kolize
