// Volumes that enclose a set of points, from the cheapest to the tightest: what a body costs in false alarms when it is
// tested by its bounds. Every one contains all points to within a few ulp of their extent.
#pragma once

#include <kolize/export.h>
#include <kolize/shape.h>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kolize {

struct BoundingSphere {
    Vec3 center = Vec3::Zero();  // in the frame of the points, as everywhere below
    double radius = 0;

    KOLIZE_API double volume() const;
};

struct OrientedBox {
    Vec3 center = Vec3::Zero();
    Mat3 axes = Mat3::Identity();  // columns: unit axes, right-handed
    Vec3 half_extents = Vec3::Zero();

    double volume() const { return 8 * half_extents.prod(); }
};

// The points between pairs of parallel planes: minima[i] <= directions[i] . p <= maxima[i].
struct SlabPolytope {
    std::vector<Vec3> directions;  // x, y, z first; coordinates -1, 0, 1: not unit, but exact for integers
    std::vector<double> minima, maxima;

    KOLIZE_API double volume() const;
};

// Each of the following throws an Error unless there is a point, and all are finite (to 1e100: no volume overflows).
KOLIZE_API Aabb bounding_box(std::span<const Vec3> points);
// The smallest sphere about a given centre.
KOLIZE_API BoundingSphere sphere_about(const Vec3& center, std::span<const Vec3> points);
// The smallest sphere of all.
KOLIZE_API BoundingSphere smallest_enclosing_sphere(std::span<const Vec3> points);
// A box of small volume: never larger than the box along the axes or the box along the principal components.
KOLIZE_API OrientedBox oriented_box(std::span<const Vec3> points);
// planes: 6 (the box along the axes), 18 (and the edge directions) or 26 (and the corner directions).
KOLIZE_API SlabPolytope slab_polytope(std::span<const Vec3> points, int planes);

// ---------------------------------------------------------------------------------------------- of bodies

// aabb and the k-DOPs have the axes of the world, and are fitted anew to the turned shape.
enum class VolumeKind : std::uint32_t { sphere, aabb, obb, kdop18, kdop26, half_space };

// "sphere", "aabb", "obb", "kdop18", "kdop26". Throws std::invalid_argument for any other word.
KOLIZE_API VolumeKind volume_kind(const std::string& word);

// What is known of a shape in its body frame, fitted once. A half-space is its own volume, whatever kind is asked for.
struct ShapeVolume {
    VolumeKind kind = VolumeKind::sphere;
    BoundingSphere sphere;          // kind sphere
    OrientedBox box;                // kind obb
    Vec3 normal = Vec3::UnitY();    // kind half_space: out of the solid, whose plane is through the origin
    std::vector<Vec3> points = {};  // the other kinds: the shape is within `margin` of the convex hull of these
    double margin = 0;              // m
};

KOLIZE_API ShapeVolume fit_volume(const Shape& shape, VolumeKind kind);

// The volume where a body stands: world axes, seen from the body's position, so that it is as exact far from the
// world's origin as near it.
struct PlacedVolume {
    VolumeKind kind = VolumeKind::sphere;
    Vec3 position = Vec3::Zero();      // of the body in the world, m
    Vec3 center = Vec3::Zero();        // from there on, m; of a k-DOP: of the box along the axes around it
    double radius = 0;                 // sphere, m
    Mat3 axes = Mat3::Identity();      // boxes: columns
    Vec3 half_extents = Vec3::Zero();  // boxes; of a k-DOP: of the box along the axes around it
    Vec3 normal = Vec3::UnitY();       // half_space
    // k-DOP: the largest direction . p, and the largest -direction . p, for each direction of slab_polytope in turn.
    std::array<double, 26> reach{};
    double extent = 0;  // m, no point is farther from `position`; 0 for a half_space
};

KOLIZE_API PlacedVolume place_volume(const ShapeVolume& volume, const Vec3& position, const Mat3& rotation);

// Whether the two certainly have no point in common, by more than all rounding. Exact but for that between spheres,
// boxes and half-spaces, and between k-DOPs of the same kind if their directions tell them apart.
KOLIZE_API bool certainly_apart(const PlacedVolume& a, const PlacedVolume& b);

struct VolumeContact {
    Vec3 normal = Vec3::UnitX();  // unit, from A to B
    Vec3 point = Vec3::Zero();    // from A's position, m
    double depth = 0;             // m, > 0: how far B has to move along the normal
};

// Nothing where the two do not overlap. The least overlap along the axes that tell the pair apart; between spheres,
// boxes and half-spaces that is how far B has to move at least.
KOLIZE_API std::optional<VolumeContact> volume_contact(const PlacedVolume& a, const PlacedVolume& b);

}  // namespace kolize
