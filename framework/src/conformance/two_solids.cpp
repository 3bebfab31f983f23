#include "conformance/two_solids.h"

#include "mesh_contacts.h"
#include "sweep/convex_gap.h"

#include <algorithm>
#include <cstdio>

namespace kolize {

namespace {

// A prism on an "L": not convex, closed, of about the size of the other solids.
TriangleSoup l_prism() {
    const double outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    TriangleSoup soup;
    for (const double z : {0.0, 0.75})
        for (const auto& [x, y] : outline) soup.vertices.emplace_back(x, y, z);
    for (std::uint32_t i = 1; i < 5; ++i) {
        soup.triangles.push_back({6, i + 6, i + 7});
        soup.triangles.push_back({0, i + 1, i});
    }
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t j = (i + 1) % 6;
        soup.triangles.push_back({i, j, j + 6});
        soup.triangles.push_back({i, j + 6, i + 6});
    }
    return soup;
}

// A crooked pyramid with its top cut off.
std::vector<Vec3> corners_of_hull() {
    return {{-0.8, -0.5, -0.7}, {0.9, -0.5, -0.6}, {0.7, -0.6, 0.8}, {-0.6, -0.4, 0.9},
            {-0.3, 0.6, -0.2},  {0.4, 0.7, -0.1},  {0.1, 0.5, 0.4}};
}

Shape shape_of_kind(ShapeKind kind) {
    switch (kind) {
    case ShapeKind::sphere: return make_sphere("sphere", 0.8);
    case ShapeKind::box: return make_box("box", Vec3(0.9, 0.6, 0.5));
    case ShapeKind::half_space: return make_half_space("half_space", Vec3(0, 1, 0), 0.1);
    case ShapeKind::capsule: return make_capsule("capsule", 0.4, 0.7);
    case ShapeKind::hull: return make_hull("hull", corners_of_hull());
    default: return make_mesh("l_prism", l_prism());
    }
}

std::uint32_t add(World& world, ShapeKind kind, const Vec3& position, const Quat& orientation) {
    BodyDescription body;
    body.shape = static_cast<std::uint32_t>(world.shapes.size());
    world.shapes.push_back(shape_of_kind(kind));
    body.name = world.shapes.back().name;
    body.is_static = kind == ShapeKind::half_space;
    body.mass = 1;
    body.position = position;
    body.orientation = orientation;
    return world.add(body);
}

}  // namespace

Mat3 random_rotation(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const Eigen::Vector4d q(normal(random), normal(random), normal(random), normal(random));
    return Quat(q.normalized()).toRotationMatrix();
}

World random_two_solids(std::mt19937_64& random, std::uint32_t shape_kinds) {
    std::vector<ShapeKind> kinds;
    for (const ShapeKind kind :
         {ShapeKind::sphere, ShapeKind::box, ShapeKind::half_space, ShapeKind::mesh, ShapeKind::capsule})
        if (shape_kinds & bit(kind)) kinds.push_back(kind);
    // Who takes meshes takes a hull for one.
    if (shape_kinds & bit(ShapeKind::hull) && !(shape_kinds & bit(ShapeKind::mesh))) kinds.push_back(ShapeKind::hull);
    const ShapeKind first = kinds[random() % kinds.size()];
    ShapeKind second = kinds[random() % kinds.size()];
    if (first == ShapeKind::half_space && second == first)  // two static ones are no pair
        second =
            *std::find_if(kinds.begin(), kinds.end(), [](ShapeKind kind) { return kind != ShapeKind::half_space; });
    std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
    const auto vector = [&] { return Vec3(coordinate(random), coordinate(random), coordinate(random)); };
    World world;
    world.materials.emplace_back();
    add(world, first, vector(), Quat(random_rotation(random)));
    add(world, second, vector(), Quat(random_rotation(random)));
    return world;
}

World exchanged(const World& world) {
    World other = world;
    const auto exchange = [](auto& column) { std::swap(column[0], column[1]); };
    exchange(other.position);
    exchange(other.orientation);
    exchange(other.shape);
    exchange(other.inverse_mass);
    exchange(other.inverse_inertia);
    exchange(other.is_static);
    exchange(other.name);
    return other;
}

World placed_elsewhere(const World& world, const Mat3& rotation, const Vec3& translation) {
    World other = world;
    for (Vec3& p : other.position) p = rotation * p + translation;
    for (Quat& q : other.orientation) q = Quat(Mat3(rotation * q.toRotationMatrix()));
    return other;
}

std::string to_text(const World& world) {
    std::string text;
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        const Vec3& p = world.position[body];
        const Quat& q = world.orientation[body];
        char line[300];
        std::snprintf(line, sizeof line, "%s at (%a, %a, %a) turned (w %a, %a, %a, %a)", world.name[body].c_str(), p[0],
                      p[1], p[2], q.w(), q.x(), q.y(), q.z());
        text += (body ? "; " : "") + std::string(line);
    }
    return text;
}

// ---------------------------------------------------------------------------------------------- the reference

namespace {

using Real = long double;
using Point = Eigen::Matrix<Real, 3, 1>;

constexpr Real too_small = 1e-9L;  // in a scene of size 1: what no double algorithm is asked to decide

std::vector<Point> world_vertices(const World& world, std::uint32_t body) {
    const Eigen::Matrix<Real, 3, 3> rotation = world.orientation[body].toRotationMatrix().cast<Real>();
    std::vector<Point> points;
    for (const Vec3& v : world.shape_of(body).mesh->vertices)
        points.push_back(rotation * v.cast<Real>() + world.position[body].cast<Real>());
    return points;
}

Real volume(const Point& a, const Point& b, const Point& c, const Point& d) { return (b - a).cross(c - a).dot(d - a); }

Overlap edges_through_triangles(const Mesh& a, const std::vector<Point>& pa, const Mesh& b,
                                const std::vector<Point>& pb) {
    bool close = false;
    for (const Edge& edge : a.edges)
        for (const Triangle& t : b.triangles) {
            const Point &p = pa[edge.v0], &q = pa[edge.v1], &u = pb[t[0]], &v = pb[t[1]], &w = pb[t[2]];
            const Real above = volume(u, v, w, p), below = volume(u, v, w, q);
            const Real s[3] = {volume(p, q, u, v), volume(p, q, v, w), volume(p, q, w, u)};
            const Real least =
                std::min({std::abs(above), std::abs(below), std::abs(s[0]), std::abs(s[1]), std::abs(s[2])});
            const bool through = (above > 0) != (below > 0) && (s[0] > 0) == (s[1] > 0) && (s[1] > 0) == (s[2] > 0);
            if (least < too_small)
                close = true;
            else if (through)
                return Overlap::overlapping;
        }
    return close ? Overlap::too_close_to_tell : Overlap::apart;
}

Overlap meshes_overlap(const World& world) {
    const Mesh &a = *world.shape_of(0).mesh, &b = *world.shape_of(1).mesh;
    const std::vector<Point> pa = world_vertices(world, 0), pb = world_vertices(world, 1);
    const Overlap first = edges_through_triangles(a, pa, b, pb);
    return first == Overlap::apart ? edges_through_triangles(b, pb, a, pa) : first;
}

Overlap by_gap(double gap) {
    return std::abs(gap) < double(too_small) ? Overlap::too_close_to_tell
           : gap < 0                         ? Overlap::overlapping
                                             : Overlap::apart;
}

Overlap sphere_overlaps(const World& world, std::uint32_t sphere, std::uint32_t other) {
    const Shape &ball = world.shape_of(sphere), &shape = world.shape_of(other);
    const Vec3 offset = world.position[sphere] - world.position[other];
    if (shape.kind == ShapeKind::sphere) return by_gap(offset.norm() - ball.radius - shape.radius);
    const Vec3 center = world.orientation[other].conjugate() * offset;
    double nearest = infinity;
    for (std::uint32_t t = 0; t < shape.mesh->triangles.size(); ++t)
        nearest = std::min(nearest, nearest_on_triangle(*shape.mesh, t, center).distance);
    // Farther inside than its radius, the ball meets no surface: solids overlap, surfaces do not.
    const Overlap overlap = by_gap(nearest - ball.radius);
    return overlap == Overlap::apart && nearest < shape.radius ? Overlap::too_close_to_tell : overlap;
}

// Not by the nearest points of capsule_contacts.h, but by those that the sweep takes.
Overlap capsule_overlaps(const World& world, std::uint32_t capsule, std::uint32_t other) {
    const Shape &pill = world.shape_of(capsule), &shape = world.shape_of(other);
    const Quat to_other = world.orientation[other].conjugate();
    const Vec3 center = to_other * (world.position[capsule] - world.position[other]);
    const Vec3 half = to_other * world.orientation[capsule] * Vec3(0, pill.half_height, 0);
    const ConvexFeature core{{center - half, center + half, Vec3::Zero()}, 2};
    const auto gap_to = [&](const ConvexFeature& feature, double radius) {
        return gap_between(core, feature).distance - pill.cap_radius - radius;
    };
    if (shape.kind == ShapeKind::sphere) return by_gap(gap_to({{Vec3::Zero()}, 1}, shape.radius));
    if (shape.kind == ShapeKind::capsule) {
        const Vec3 end(0, shape.half_height, 0);
        return by_gap(gap_to({{-end, end, Vec3::Zero()}, 2}, shape.cap_radius));
    }
    double nearest = infinity;
    for (const Triangle& t : shape.mesh->triangles) {
        const Vec3 &u = shape.mesh->vertices[t[0]], &v = shape.mesh->vertices[t[1]], &w = shape.mesh->vertices[t[2]];
        nearest = std::min(nearest, gap_to({{u, v, w}, 3}, 0));
    }
    // Of a core that goes through triangles or lies inside, the distance says little.
    const Overlap overlap = by_gap(nearest);
    return overlap == Overlap::apart && center.norm() - pill.half_height < shape.radius ? Overlap::too_close_to_tell
                                                                                        : overlap;
}

Overlap half_space_overlaps(const World& world, std::uint32_t half_space, std::uint32_t other) {
    const Vec3 normal = world.orientation[half_space] * world.shape_of(half_space).normal;
    const Shape& shape = world.shape_of(other);
    const Vec3 offset = world.position[other] - world.position[half_space];
    if (shape.kind == ShapeKind::sphere) return by_gap(normal.dot(offset) - shape.radius);
    if (shape.kind == ShapeKind::capsule) {
        const double half = std::abs(normal.dot(world.orientation[other] * Vec3(0, shape.half_height, 0)));
        return by_gap(normal.dot(offset) - half - shape.cap_radius);
    }
    double lowest = infinity;
    for (const Vec3& v : shape.mesh->vertices)
        lowest = std::min(lowest, normal.dot(offset + world.orientation[other] * v));
    return by_gap(lowest);
}

}  // namespace

Overlap reference_overlap(const World& world) {
    const ShapeKind a = world.shape_of(0).kind, b = world.shape_of(1).kind;
    if (a == ShapeKind::half_space) return half_space_overlaps(world, 0, 1);
    if (b == ShapeKind::half_space) return half_space_overlaps(world, 1, 0);
    if (a == ShapeKind::capsule) return capsule_overlaps(world, 0, 1);
    if (b == ShapeKind::capsule) return capsule_overlaps(world, 1, 0);
    if (a == ShapeKind::sphere) return sphere_overlaps(world, 0, 1);
    if (b == ShapeKind::sphere) return sphere_overlaps(world, 1, 0);
    return meshes_overlap(world);
}

}  // namespace kolize
