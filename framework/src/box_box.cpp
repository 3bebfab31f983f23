#include "primitive_contacts.h"

namespace kolize {

namespace {

// Both boxes in each other's frames: all that the fifteen axes need are the nine cosines between their edges.
struct BoxPair {
    Vec3 half_a, half_b;
    Mat3 b_in_a;     // column j: axis j of B in the frame of A
    Mat3 cosines;    // its absolute values
    Vec3 a_to_b[2];  // from centre to centre, in the frame of A and in that of B
};

struct Axis {
    double overlap = infinity;  // m, times `length`
    double length = 1;
    int a = -1, b = -1;  // face axis of A or of B, or the two edge directions
};

// False if a face separates. Of equals the face of A, so that rounding does not make boxes that lie on each other
// change roles.
bool least_face_overlap(const BoxPair& pair, Axis& best) {
    const Vec3 along_a = pair.half_a + pair.cosines * pair.half_b - pair.a_to_b[0].cwiseAbs();
    const Vec3 along_b = pair.half_b + pair.cosines.transpose() * pair.half_a - pair.a_to_b[1].cwiseAbs();
    if (!(along_a.minCoeff() > 0 && along_b.minCoeff() > 0)) return false;
    int a = 0, b = 0;
    const double least_a = along_a.minCoeff(&a), least_b = along_b.minCoeff(&b);
    best = least_b < (1 - 1e-12) * least_a ? Axis{least_b, 1, -1, b} : Axis{least_a, 1, a, -1};
    return true;
}

// False if a cross product of edges separates. Edge i of A crossed with edge j of B has no part along i.
bool least_edge_overlap(const BoxPair& pair, Axis& best) {
    const Vec3& t = pair.a_to_b[0];
    double least = infinity, least_length = 1;  // squared
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            const double c1 = pair.b_in_a(i1, j), c2 = pair.b_in_a(i2, j), length = c1 * c1 + c2 * c2;
            // Nearly parallel edges span no plane; the face axes have decided that direction already.
            if (length < 1e-12) continue;
            const double reach_a = pair.half_a[i1] * pair.cosines(i2, j) + pair.half_a[i2] * pair.cosines(i1, j);
            const double reach_b = pair.half_b[j1] * pair.cosines(i, j2) + pair.half_b[j2] * pair.cosines(i, j1);
            const double overlap = reach_a + reach_b - std::abs(t[i2] * c1 - t[i1] * c2);
            if (!(overlap > 0)) return false;
            if (overlap * overlap * least_length >= least * length) continue;
            least = overlap * overlap;
            least_length = length;
            best = {overlap, 1, i, j};
        }
    best.length = std::sqrt(least_length);
    return true;
}

// A corner of the incident face over the plane of the reference face, whose middle is the origin: (u, v, height).
struct Polygon {
    std::array<Vec3, 8> points;  // a rectangle cut four times
    std::size_t count = 0;
    void add(const Vec3& p) {
        if (count < points.size()) points[count++] = p;
    }
};

// Keeps the part with sign * p[axis] <= limit (Sutherland & Hodgman 1974).
void clip(Polygon& polygon, int axis, double sign, double limit) {
    std::array<double, 8> beyond;
    bool any = false;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        beyond[i] = sign * polygon.points[i][axis] - limit;
        any = any || beyond[i] > 0;
    }
    if (!any) return;
    Polygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const std::size_t next = i + 1 == polygon.count ? 0 : i + 1;
        const Vec3 &p = polygon.points[i], &q = polygon.points[next];
        if (beyond[i] <= 0) kept.add(p);
        if ((beyond[i] <= 0) != (beyond[next] <= 0)) kept.add(p + (q - p) * (beyond[i] / (beyond[i] - beyond[next])));
    }
    polygon = kept;
}

// The boxes as a face contact sees them.
struct FaceContact {
    Vec3 reference_half, incident_half;
    Mat3 incident_axes;    // columns: in the frame of the reference box
    Vec3 incident_center;  // likewise
    int axis;              // of the reference face
    double side;           // -1 or 1: which of the two faces, the one towards the incident box

    // The face of the incident box that looks most against the reference face.
    Polygon incident_face() const {
        const Vec3 against = side * incident_axes.row(axis);
        int k = 0;
        against.cwiseAbs().maxCoeff(&k);
        const int u = (k + 1) % 3, v = (k + 2) % 3;
        const Vec3 middle =
            incident_center + (against[k] > 0 ? -incident_half[k] : incident_half[k]) * incident_axes.col(k);
        const Vec3 du = incident_half[u] * incident_axes.col(u), dv = incident_half[v] * incident_axes.col(v);
        Polygon face;
        for (const Vec3& p :
             {Vec3(middle + du + dv), Vec3(middle - du + dv), Vec3(middle - du - dv), Vec3(middle + du - dv)})
            face.add({p[(axis + 1) % 3], p[(axis + 2) % 3], side * p[axis] - reference_half[axis]});
        return face;
    }

    // What of it lies over the reference face and below its plane.
    Polygon overlap() const {
        Polygon polygon = incident_face();
        for (int k = 0; k < 2; ++k)
            for (const double sign : {1.0, -1.0}) clip(polygon, k, sign, reference_half[(axis + 1 + k) % 3]);
        Polygon below;
        for (std::size_t i = 0; i < polygon.count; ++i)
            if (polygon.points[i].z() < 0) below.add(polygon.points[i]);
        return below;
    }

    // Back into the frame of the reference box.
    Vec3 placed(const Vec3& p) const {
        Vec3 result;
        result[axis] = side * (p.z() + reference_half[axis]);
        result[(axis + 1) % 3] = p.x();
        result[(axis + 2) % 3] = p.y();
        return result;
    }
};

// Middle of the shortest link between the two supporting edges; `normal` and the result: world axes about A's centre.
Vec3 edge_contact(const BoxPair& pair, const Axis& axis, const Mat3& axes_a, const Mat3& axes_b, const Vec3& b,
                  const Vec3& normal) {
    const auto supporting = [](const Vec3& half, const Mat3& axes, int along, const Vec3& direction) {
        Vec3 p = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (k != along) p += (axes.col(k).dot(direction) > 0 ? half[k] : -half[k]) * axes.col(k);
        return p;
    };
    const Vec3 p = supporting(pair.half_a, axes_a, axis.a, normal);
    const Vec3 q = b + supporting(pair.half_b, axes_b, axis.b, -normal);
    const Vec3 u = axes_a.col(axis.a), v = axes_b.col(axis.b), w = q - p;
    const double c = u.dot(v), determinant = 1 - c * c;
    const double s = (u.dot(w) - c * v.dot(w)) / determinant, t = (c * u.dot(w) - v.dot(w)) / determinant;
    return 0.5 * ((p + s * u) + (q + t * v));
}

}  // namespace

void box_box(const Vec3& half_a, const Mat3& rotation_a, const Vec3& half_b, const Mat3& rotation_b, const Vec3& b,
             Regions& regions) {
    BoxPair pair{half_a, half_b, {}, {}, {rotation_a.transpose() * b, rotation_b.transpose() * b}};
    pair.b_in_a.noalias() = rotation_a.transpose() * rotation_b;
    pair.cosines = pair.b_in_a.cwiseAbs();
    Axis face, edge;
    if (!least_face_overlap(pair, face) || !least_edge_overlap(pair, edge)) return;
    // An edge axis must beat the faces by 1 %: a face contact has more points and describes the same overlap.
    if (edge.overlap < 0.99 * face.overlap * edge.length) {
        Vec3 normal = Vec3(rotation_a.col(edge.a)).cross(Vec3(rotation_b.col(edge.b))) / edge.length;
        if (normal.dot(b) < 0) normal = -normal;
        const Vec3 point = edge_contact(pair, edge, rotation_a, rotation_b, b, normal);
        regions.push_back(ContactRegion::single(normal, point, edge.overlap / edge.length));
        return;
    }
    const bool on_a = face.a >= 0;
    const int axis = on_a ? face.a : face.b;
    const double side = pair.a_to_b[on_a ? 0 : 1][axis] < 0 ? -1 : 1;  // of the face of A, or against that of B
    const FaceContact contact =
        on_a ? FaceContact{half_a, half_b, pair.b_in_a, pair.a_to_b[0], axis, side}
             : FaceContact{half_b, half_a, pair.b_in_a.transpose(), -pair.a_to_b[1], axis, -side};
    const Mat3& rotation = on_a ? rotation_a : rotation_b;
    const Vec3 center = on_a ? Vec3::Zero() : b;
    const Vec3 normal = side * rotation.col(axis);
    const Polygon below = contact.overlap();
    if (below.count == 0) {  // rounding left nothing below the face: the boxes touch in a point at most
        regions.push_back(ContactRegion::single(normal, 0.5 * b, face.overlap));
        return;
    }
    ContactRegion& region = regions.emplace_back();
    region.normal = normal;
    region.depth = face.overlap;
    std::array<std::uint32_t, 4> chosen;
    for (const std::uint32_t i : spread_points({below.points.data(), below.count}, chosen)) {
        region.points[region.count] = center + rotation * contact.placed(below.points[i]);
        region.depths[region.count++] = -below.points[i].z();
    }
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < below.count; ++i) mean += below.points[i];
    region.center = center + rotation * contact.placed(mean / static_cast<double>(below.count));
}

}  // namespace kolize
