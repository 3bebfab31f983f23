#include "bounding_volumes/slab_reach.h"
#include "primitive_contacts.h"

#include <kolize/bounding_volumes.h>

#include <algorithm>

namespace kolize {

namespace {

bool is_box(const PlacedVolume& v) { return v.kind == VolumeKind::aabb || v.kind == VolumeKind::obb; }

// 0 for what is no k-DOP.
int slabs_of(const PlacedVolume& v) { return v.kind == VolumeKind::kdop18 ? 9 : v.kind == VolumeKind::kdop26 ? 13 : 0; }

// Where a volume lies along an axis, seen from its position.
struct Interval {
    double min = 0, max = 0;
};

// A half-space is asked for along its own normal only.
Interval along(const PlacedVolume& v, const Vec3& axis) {
    if (v.kind == VolumeKind::half_space) return {-infinity, 0};
    if (const int slabs = slabs_of(v)) {
        const SlabSum sum = slab_sum(axis, slabs);
        return {-sum.of_opposite(v.reach), sum.of(v.reach)};
    }
    const double middle = axis.dot(v.center);
    const double half = v.kind == VolumeKind::sphere ? v.radius * axis.norm()
                                                     : (v.axes.transpose() * axis).cwiseAbs().dot(v.half_extents);
    return {middle - half, middle + half};
}

// A pair, seen from the position of A.
struct VolumePair {
    const PlacedVolume &a, &b;
    Vec3 offset;  // of B's position

    VolumePair(const PlacedVolume& first, const PlacedVolume& second)
        : a(first), b(second), offset(second.position - first.position) {}

    // Between the two along the axis and against it; at most one is above 0.
    void gaps(const Vec3& axis, double& forth, double& back) const {
        const Interval of_a = along(a, axis), of_b = along(b, axis);
        const double from_a_to_b = axis.dot(offset);
        forth = from_a_to_b + of_b.min - of_a.max;
        back = of_a.min - of_b.max - from_a_to_b;
    }

    // Every coordinate above comes from a few dozen roundings of something that is at most so large.
    double rounding() const {
        return 256 * std::numeric_limits<double>::epsilon() * (a.extent + b.extent + offset.norm());
    }
};

// Below, visit(axis) returns false where no further axis is wanted, and so do the functions themselves.

template <class Visit>
bool own_axes(const PlacedVolume& v, Visit&& visit) {
    if (v.kind == VolumeKind::half_space) return visit(v.normal);
    if (is_box(v)) return visit(v.axes.col(0)) && visit(v.axes.col(1)) && visit(v.axes.col(2));
    for (int i = 0; i < slabs_of(v); ++i)
        if (!visit(slab_direction(i).normalized())) return false;
    return true;
}

template <class Visit>
bool along_vector(const Vec3& v, Visit&& visit) {
    const double length = v.norm();
    return !(length > 0) || visit(Vec3(v / length));
}

// From the centre of a sphere to the nearest point of the other volume, or of the box around it.
template <class Visit>
bool sphere_axis(const PlacedVolume& sphere, const PlacedVolume& other, const Vec3& offset, Visit&& visit) {
    const Vec3 from_other = sphere.center - offset - other.center;
    if (other.kind == VolumeKind::sphere) return along_vector(from_other, visit);
    const Vec3 local = other.axes.transpose() * from_other;
    const Vec3 outside = local - local.cwiseMin(other.half_extents).cwiseMax(-other.half_extents);
    return along_vector(other.axes * outside, visit);
}

// Of nearly parallel edges there is none: the faces tell what they could.
template <class Visit>
bool edge_axes(const PlacedVolume& a, const PlacedVolume& b, Visit&& visit) {
    constexpr double parallel = 1e-8;
    if (a.kind == VolumeKind::aabb && b.kind == VolumeKind::aabb) return true;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const Vec3 axis = a.axes.col(i).cross(b.axes.col(j));
            const double length = axis.norm();
            if (length > parallel && !visit(Vec3(axis / length))) return false;
        }
    return true;
}

template <class Visit>
bool visit_axes(const VolumePair& pair, Visit&& visit) {
    const PlacedVolume &a = pair.a, &b = pair.b;
    if (a.kind == VolumeKind::half_space || b.kind == VolumeKind::half_space)
        return own_axes(a.kind == VolumeKind::half_space ? a : b, visit);
    if (a.kind == VolumeKind::sphere && !sphere_axis(a, b, pair.offset, visit)) return false;
    if (b.kind == VolumeKind::sphere && a.kind != VolumeKind::sphere && !sphere_axis(b, a, -pair.offset, visit))
        return false;
    return own_axes(a, visit) && own_axes(b, visit) && (!is_box(a) || !is_box(b) || edge_axes(a, b, visit));
}

// Two of a kind, along the directions that both have, without turning anything.
bool slabs_apart(const VolumePair& pair, double rounding) {
    for (int i = 0; i < slabs_of(pair.a); ++i) {
        const double between = slab_direction(i).dot(pair.offset);
        if (between - pair.b.reach[2 * i + 1] - pair.a.reach[2 * i] > rounding ||
            -between - pair.a.reach[2 * i + 1] - pair.b.reach[2 * i] > rounding)
            return true;
    }
    return false;
}

// ---------------------------------------------------------------------------------------------- contacts

// Sphere before box before half-space: what primitive_contacts.h has closed forms for.
void primitive_regions(const PlacedVolume& a, const PlacedVolume& b, const Vec3& offset, Regions& regions) {
    if (b.kind == VolumeKind::half_space) {
        if (a.kind == VolumeKind::sphere) return sphere_half_space(a.radius, b.normal, offset, regions);
        return box_half_space(a.half_extents, a.axes, b.normal, offset, regions);
    }
    if (b.kind == VolumeKind::sphere) return sphere_sphere(a.radius, b.radius, offset, regions);
    if (a.kind == VolumeKind::sphere) return sphere_box(a.radius, b.half_extents, b.axes, offset, regions);
    box_box(a.half_extents, a.axes, b.half_extents, b.axes, offset, regions);
}

int rank(const PlacedVolume& v) { return v.kind == VolumeKind::half_space ? 2 : is_box(v) ? 1 : 0; }

// A's centre is where regions begin; the contact begins at its position.
std::optional<VolumeContact> primitive_contact(const VolumePair& pair) {
    thread_local Regions regions;  // kept, so that warm calls allocate nothing
    regions.clear();
    const PlacedVolume &a = pair.a, &b = pair.b;
    const Vec3 offset = pair.offset + b.center - a.center;
    if (rank(a) <= rank(b))
        primitive_regions(a, b, offset, regions);
    else
        primitive_regions(b, a, -offset, regions);
    if (regions.empty()) return std::nullopt;
    const ContactRegion region = rank(a) <= rank(b) ? regions.front() : swapped(regions.front(), -offset);
    return VolumeContact{region.normal, a.center + region.center, region.depth};
}

// A point in the middle of the overlap along the normal; across it, in the middle of what the boxes share.
Vec3 middle_point(const VolumePair& pair, const VolumeContact& contact) {
    const PlacedVolume &a = pair.a, &b = pair.b;
    Vec3 low = Vec3::Constant(-infinity), high = Vec3::Constant(infinity);
    const auto share = [&](const PlacedVolume& v, const Vec3& position) {
        if (v.kind == VolumeKind::half_space) return;
        const Vec3 half =
            v.kind == VolumeKind::sphere ? Vec3(Vec3::Constant(v.radius)) : Vec3(v.axes.cwiseAbs() * v.half_extents);
        low = low.cwiseMax(position + v.center - half);
        high = high.cwiseMin(position + v.center + half);
    };
    share(a, Vec3::Zero());
    share(b, pair.offset);
    const Vec3 middle = 0.5 * (low + high);
    const double end_of_a = a.kind == VolumeKind::half_space
                                ? contact.normal.dot(pair.offset) + along(b, contact.normal).min + contact.depth
                                : along(a, contact.normal).max;
    return middle + (end_of_a - 0.5 * contact.depth - contact.normal.dot(middle)) * contact.normal;
}

}  // namespace

bool certainly_apart(const PlacedVolume& a, const PlacedVolume& b) {
    const VolumePair pair(a, b);
    const double rounding = pair.rounding();
    if (slabs_of(a) && a.kind == b.kind) return slabs_apart(pair, 2 * rounding);  // directions are not unit
    return !visit_axes(pair, [&](const Vec3& axis) {
        double forth, back;
        pair.gaps(axis, forth, back);
        return !(forth > rounding || back > rounding);
    });
}

std::optional<VolumeContact> volume_contact(const PlacedVolume& a, const PlacedVolume& b) {
    const VolumePair pair(a, b);
    if (a.kind == VolumeKind::half_space && b.kind == VolumeKind::half_space) return std::nullopt;
    const bool aligned = a.kind == VolumeKind::aabb && b.kind == VolumeKind::aabb;
    if (!slabs_of(a) && !slabs_of(b) && !aligned) return primitive_contact(pair);
    VolumeContact least;
    least.depth = infinity;
    const bool overlap = visit_axes(pair, [&](const Vec3& axis) {
        double forth, back;
        pair.gaps(axis, forth, back);
        if (-forth < least.depth) least = {axis, Vec3::Zero(), -forth};
        if (-back < least.depth) least = {-axis, Vec3::Zero(), -back};
        return least.depth > 0;
    });
    if (!overlap) return std::nullopt;
    least.point = middle_point(pair, least);
    return least;
}

}  // namespace kolize
