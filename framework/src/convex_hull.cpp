#include <kolize/convex_hull.h>

#include <kolize/predicates.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace kolize {

namespace {

class Hull {
public:
    explicit Hull(std::span<const Vec3> points) : points_(points) {
        begin();
        for (std::uint32_t i = 0; i < points_.size(); ++i) add(i);
    }

    TriangleSoup soup() const {
        std::vector<std::uint32_t> number(points_.size(), unused);
        for (const Triangle& face : faces_)
            for (const std::uint32_t v : face) number[v] = 0;
        TriangleSoup result;
        for (std::size_t i = 0; i < number.size(); ++i) {
            if (number[i] == unused) continue;
            number[i] = static_cast<std::uint32_t>(result.vertices.size());
            result.vertices.push_back(points_[i]);
        }
        for (const Triangle& face : faces_)
            result.triangles.push_back({number[face[0]], number[face[1]], number[face[2]]});
        return result;
    }

private:
    static constexpr std::uint32_t unused = ~0u;

    // +1 if the point lies outside of the face.
    int side(const Triangle& face, std::uint32_t point) const {
        return orient3d(points_[face[0]], points_[face[1]], points_[face[2]], points_[point]);
    }

    template <class Measure>
    std::uint32_t farthest(Measure&& measure) const {
        std::uint32_t best = 0;
        double most = -1;
        for (std::uint32_t i = 0; i < points_.size(); ++i)
            if (const double m = measure(points_[i]); m > most) {
                most = m;
                best = i;
            }
        return best;
    }

    // A tetrahedron of points far from each other.
    void begin() {
        if (points_.empty()) throw std::invalid_argument("a convex hull needs points");
        const Vec3& p = points_[0];
        const std::uint32_t b = farthest([&](const Vec3& x) { return (x - p).norm(); });
        const Vec3 line = points_[b] - p;
        const std::uint32_t c = farthest([&](const Vec3& x) { return line.cross(x - p).norm(); });
        const Vec3 normal = line.cross(points_[c] - p);
        const std::uint32_t d = farthest([&](const Vec3& x) { return std::abs(normal.dot(x - p)); });
        const int up = side({0, b, c}, d);
        if (up == 0) throw std::invalid_argument("the points of a convex hull must not lie in one plane");
        const auto [first, second] = up > 0 ? std::pair{c, b} : std::pair{b, c};
        faces_ = {{0, first, second}, {0, d, first}, {first, d, second}, {second, d, 0}};
    }

    // What the point sees, or lies in the plane of, gives way to a cone from the edge of that to the point. Without the
    // planes a triangle of the cone could have no area.
    void add(std::uint32_t point) {
        bool outside = false;
        visible_.clear();
        for (const Triangle& face : faces_) {
            visible_.push_back(static_cast<std::int8_t>(side(face, point)));
            outside = outside || visible_.back() > 0;
        }
        if (!outside) return;
        edges_.clear();
        kept_.clear();
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            if (visible_[i] < 0) {
                kept_.push_back(faces_[i]);
                continue;
            }
            for (int k = 0; k < 3; ++k) edges_.emplace(faces_[i][k], faces_[i][(k + 1) % 3]);
        }
        for (const auto& [from, to] : edges_)
            if (!edges_.contains({to, from})) kept_.push_back({from, to, point});
        faces_.swap(kept_);
    }

    std::span<const Vec3> points_;
    std::vector<Triangle> faces_, kept_;
    std::vector<std::int8_t> visible_;
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges_;  // of what gives way, as its triangles run
};

}  // namespace

TriangleSoup convex_hull(std::span<const Vec3> points) {
    for (const Vec3& p : points)
        if (!p.allFinite()) throw std::invalid_argument("the points of a convex hull must be finite");
    return Hull(points).soup();
}

}  // namespace kolize
