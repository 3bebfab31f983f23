#include <kolize/winding_number.h>

#include <numbers>
#include <span>

namespace kolize {

namespace {

// A cluster counts as far from this many times its radius: a little more than the two of Barill et al., to stay within
// the error that the header promises.
constexpr double far = 2.25;

using Corners = std::array<Vec3, 3>;

// Van Oosterom & Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30(2), 1983: half the angle.
double half_solid_angle(const Corners& triangle, const Vec3& point) {
    const Vec3 a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

Vec3 area_vector(const Corners& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]); }

Vec3 centroid(const Corners& t) { return (t[0] + t[1] + t[2]) / 3; }

}  // namespace

// A cluster of triangles as seen from afar: Taylor series of its solid angle about its centroid.
struct WindingNumber::Node {
    Vec3 center = Vec3::Zero();
    double far_squared = 0;      // from this distance on (squared) the series will do
    Vec3 area = Vec3::Zero();    // first order: the sum of the area vectors
    Mat3 second = Mat3::Zero();  // sum of area vector times centroid; from here on all is seen from the center
    std::array<Mat3, 3> third = {Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};  // sum of area vector times second moment
    Vec3 traces = Vec3::Zero();                                              // of the third order, over all three pairs
    std::uint32_t first = 0;                                                 // as in HierarchyNode
    std::uint32_t count = 0;

    void expand(std::span<const Corners> triangles) {
        double total = 0;
        for (const Corners& t : triangles) total += area_vector(t).norm();
        for (const Corners& t : triangles)
            center += (total > 0 ? area_vector(t).norm() / total : 1.0 / double(triangles.size())) * centroid(t);
        for (const Corners& t : triangles) add({t[0] - center, t[1] - center, t[2] - center});
        for (int k = 0; k < 3; ++k) {
            traces[k] += third[k].trace();
            traces += 2 * third[k].row(k);
        }
    }

    // A triangle as seen from the center.
    void add(const Corners& t) {
        const Vec3 n = area_vector(t), c = centroid(t);
        Mat3 square = 9 * c * c.transpose();  // 12 times the mean of p p^T over the triangle
        for (const Vec3& p : t) {
            square += p * p.transpose();
            far_squared = std::max(far_squared, far * far * p.squaredNorm());
        }
        area += n;
        second += n * c.transpose();
        for (int k = 0; k < 3; ++k) third[k] += n[k] / 12 * square;
    }

    // The solid angle of dA at r + d is the flux dA . g(r + d) of g(r) = r / |r|^3; this is its Taylor series in d.
    double solid_angle(const Vec3& r, double squared) const {
        const double cubed = squared * std::sqrt(squared);
        const double first_order = area.dot(r);
        const double second_order = second.trace() - 3 * r.dot(second * r) / squared;
        const Mat3 along = r.x() * third[0] + r.y() * third[1] + r.z() * third[2];
        const double third_order = 1.5 * (5 * r.dot(along * r) / squared - traces.dot(r)) / squared;
        return (first_order + second_order + third_order) / cubed;
    }
};

// Coordinates are those of a cube of unit size about the origin: no product of them overflows or loses its digits.
struct WindingNumber::Tree {
    explicit Tree(const TriangleSoup& surface) {
        Aabb box;
        for (const Triangle& t : surface.triangles)
            for (const std::uint32_t v : t) box.include(surface.vertices[v]);
        if (surface.triangles.empty()) return;
        origin = box.center();
        if (const double size = box.half_extents().maxCoeff(); size > 0) scale = 0.5 / size;
        const Hierarchy hierarchy = build_hierarchy(surface.vertices, surface.triangles);
        for (const std::uint32_t t : hierarchy.order) {
            Corners& corners = triangles.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) corners[k] = scaled(surface.vertices[surface.triangles[t][k]]);
        }
        nodes.resize(hierarchy.nodes.size());
        take_over(hierarchy, 0);
    }

    Vec3 scaled(const Vec3& p) const { return (p - origin) * scale; }

    // Fills a node and those below it; returns its triangles, which stand side by side.
    std::span<const Corners> take_over(const Hierarchy& hierarchy, std::uint32_t index) {
        Node& node = nodes[index];
        node.first = hierarchy.nodes[index].first;
        node.count = hierarchy.nodes[index].count;
        std::span<const Corners> range(triangles.data() + node.first, node.count);
        if (node.count == 0) {
            const auto left = take_over(hierarchy, node.first), right = take_over(hierarchy, node.first + 1);
            range = {left.data(), left.size() + right.size()};
        }
        node.expand(range);
        return range;
    }

    double solid_angle(std::uint32_t index, const Vec3& point) const {
        const Node& node = nodes[index];
        const Vec3 to_center = node.center - point;
        const double squared = to_center.squaredNorm();
        if (squared > node.far_squared) return node.solid_angle(to_center, squared);
        if (node.count == 0) return solid_angle(node.first, point) + solid_angle(node.first + 1, point);
        double sum = 0;
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
            sum += 2 * half_solid_angle(triangles[t], point);
        return sum;
    }

    Vec3 origin = Vec3::Zero();
    double scale = 1;
    std::vector<Corners> triangles;  // in the order of the leaves
    std::vector<Node> nodes;
};

WindingNumber::WindingNumber(const TriangleSoup& surface) : tree_(std::make_unique<Tree>(surface)) {}

WindingNumber::~WindingNumber() = default;

double WindingNumber::at(const Vec3& point) const {
    if (tree_->nodes.empty()) return 0;
    return tree_->solid_angle(0, tree_->scaled(point)) / (4 * std::numbers::pi);
}

}  // namespace kolize
