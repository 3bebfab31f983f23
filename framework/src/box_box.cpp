#include "primitive_contacts.h"

namespace kolize {

namespace {

struct OrientedBox {
    Vec3 half;
    Mat3 axes;  // columns: unit axes, world
    Vec3 center;

    double reach(const Vec3& direction) const { return (axes.transpose() * direction).cwiseAbs().dot(half); }
};

struct Axis {
    double depth = infinity;
    Vec3 normal = Vec3::Zero();  // unit, from A to B
    int a = -1, b = -1;          // face axis of A or of B, or the two edge directions
};

// Overlap of the two boxes along a unit direction, turned to point from A to B. <= 0: separated.
double overlap_along(const OrientedBox& a, const OrientedBox& b, Vec3& direction) {
    const double distance = direction.dot(b.center - a.center);
    if (distance < 0) direction = -direction;
    return a.reach(direction) + b.reach(direction) - std::abs(distance);
}

// False if a separating axis was found.
bool least_overlap(const OrientedBox& a, const OrientedBox& b, Axis& face, Axis& edge) {
    const auto consider = [&](Vec3 direction, int i, int j, Axis& best) {
        const double depth = overlap_along(a, b, direction);
        if (depth < best.depth) best = {depth, direction, i, j};
        return depth > 0;
    };
    for (int i = 0; i < 3; ++i)
        if (!consider(a.axes.col(i), i, -1, face) || !consider(b.axes.col(i), -1, i, face)) return false;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const Vec3 cross = a.axes.col(i).cross(b.axes.col(j));
            const double length = cross.norm();
            // Nearly parallel edges span no plane; the face axes have decided that direction already.
            if (length > 1e-6 && !consider(cross / length, i, j, edge)) return false;
        }
    return true;
}

struct Polygon {
    std::array<Vec3, 16> points;
    std::size_t count = 0;
    void add(const Vec3& p) {
        if (count < points.size()) points[count++] = p;
    }
};

// Keeps the part with normal . p <= offset (Sutherland & Hodgman 1974).
Polygon clip(const Polygon& polygon, const Vec3& normal, double offset) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Vec3& p = polygon.points[i];
        const Vec3& q = polygon.points[(i + 1) % polygon.count];
        const double dp = normal.dot(p) - offset, dq = normal.dot(q) - offset;
        if (dp <= 0) kept.add(p);
        if ((dp <= 0) != (dq <= 0)) kept.add(p + (q - p) * (dp / (dp - dq)));
    }
    return kept;
}

// The face of the box that looks most against `normal`.
Polygon incident_face(const OrientedBox& box, const Vec3& normal) {
    const Vec3 local = box.axes.transpose() * normal;
    int axis = 0;
    local.cwiseAbs().maxCoeff(&axis);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double side = local[axis] > 0 ? -1 : 1;
    const Vec3 middle = box.center + side * box.half[axis] * box.axes.col(axis);
    const Vec3 du = box.half[u] * box.axes.col(u), dv = box.half[v] * box.axes.col(v);
    Polygon face;
    for (const Vec3& p :
         {Vec3(middle + du + dv), Vec3(middle - du + dv), Vec3(middle - du - dv), Vec3(middle + du - dv)})
        face.add(p);
    return face;
}

// Manifold of a face contact. `normal`: outward from the reference box, whose face axis is `axis`.
ContactRegion face_contact(const OrientedBox& reference, int axis, const OrientedBox& incident, const Vec3& normal) {
    Polygon polygon = incident_face(incident, normal);
    for (int side = 1; side <= 2; ++side) {
        const int k = (axis + side) % 3;
        const Vec3 direction = reference.axes.col(k);
        const double middle = direction.dot(reference.center);
        polygon = clip(polygon, direction, middle + reference.half[k]);
        polygon = clip(polygon, -direction, reference.half[k] - middle);
    }
    const double plane = normal.dot(reference.center) + reference.half[axis];
    Polygon below;
    for (std::size_t i = 0; i < polygon.count; ++i)
        if (normal.dot(polygon.points[i]) < plane) below.add(polygon.points[i]);
    ContactRegion region;
    std::array<std::uint32_t, 4> chosen;
    for (const std::uint32_t i : spread_points({below.points.data(), below.count}, chosen)) {
        region.points[region.count] = below.points[i];
        region.depths[region.count++] = plane - normal.dot(below.points[i]);
    }
    for (std::size_t i = 0; i < below.count; ++i) region.center += below.points[i] / static_cast<double>(below.count);
    return region;
}

// Middle of the shortest link between the two supporting edges.
Vec3 edge_contact(const OrientedBox& a, const OrientedBox& b, const Axis& axis) {
    const auto supporting = [&](const OrientedBox& box, int along, const Vec3& direction) {
        Vec3 p = box.center;
        for (int k = 0; k < 3; ++k)
            if (k != along) p += (box.axes.col(k).dot(direction) > 0 ? 1 : -1) * box.half[k] * box.axes.col(k);
        return p;
    };
    const Vec3 p = supporting(a, axis.a, axis.normal), q = supporting(b, axis.b, -axis.normal);
    const Vec3 u = a.axes.col(axis.a), v = b.axes.col(axis.b), w = q - p;
    const double c = u.dot(v), determinant = 1 - c * c;
    const double s = (u.dot(w) - c * v.dot(w)) / determinant, t = (c * u.dot(w) - v.dot(w)) / determinant;
    return 0.5 * ((p + s * u) + (q + t * v));
}

}  // namespace

void box_box(const Vec3& half_a, const Mat3& rotation_a, const Vec3& half_b, const Mat3& rotation_b, const Vec3& b,
             Regions& regions) {
    const OrientedBox first{half_a, rotation_a, Vec3::Zero()}, second{half_b, rotation_b, b};
    Axis face, edge;
    if (!least_overlap(first, second, face, edge)) return;
    // An edge axis must beat the faces by 1 %: a face contact has more points and describes the same overlap.
    if (edge.depth < 0.99 * face.depth) {
        regions.push_back(ContactRegion::single(edge.normal, edge_contact(first, second, edge), edge.depth));
        return;
    }
    const bool on_a = face.a >= 0;
    ContactRegion region =
        on_a ? face_contact(first, face.a, second, face.normal) : face_contact(second, face.b, first, -face.normal);
    if (region.count == 0) {  // rounding left nothing below the face: the boxes touch in a point at most
        regions.push_back(ContactRegion::single(face.normal, 0.5 * b, face.depth));
        return;
    }
    region.normal = face.normal;
    region.depth = face.depth;
    regions.push_back(region);
}

}  // namespace kolize
