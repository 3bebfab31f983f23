#include "contact_model/curve.h"
#include "contact_model/overlap_depth.h"

namespace kolize {

namespace {

constexpr double flat = 1e-12;     // rad: normals that differ by less are those of one plane
constexpr double parallel = 1e-6;  // rad: directions that differ by less have no cross product to rely on
constexpr double pierced = 0.1;    // of the loops' areas; a region whose areas cancel to less is pierced right through

// Of one region. The curve is oriented, so the area of each closed loop of it is a vector.
class Curve {
public:
    Curve(const MeshPair& pair, std::span<const ContourSegment> segments, std::uint32_t region)
        : pair_(pair), segments_(segments), region_(region) {
        Vec3 mean = Vec3::Zero();
        double count = 0;
        for_each([&](const ContourSegment& s) {
            const double length = (s.to.point - s.from.point).norm();
            length_ += length;
            center_ += 0.5 * length * (s.from.point + s.to.point);
            mean += s.from.point;
            ++count;
            across_ += normal_a(s) - normal_b(s);
        });
        center_ = length_ > 0 ? Vec3(center_ / length_) : Vec3(mean / count);
    }

    const Vec3& center() const { return center_; }  // weighted by length

    // From A to B. Small curves give their area to few digits, but the direction is often known better: all of a curve
    // in one plane has that plane's normal, and one around two crossing edges has both edges at right angles.
    Vec3 normal(const Vec3& area) const {
        if (const Vec3 n = common_normal(true) - common_normal(false); n.norm() > parallel)
            return turned_along(area, n.normalized());
        if (const Vec3 n = edges_normal(); !n.isZero()) return turned_along(area, across_.dot(n) < 0 ? Vec3(-n) : n);
        if (is_area(area)) return area.normalized();
        if (across_.norm() > flat) return across_.normalized();
        const Vec3& centers = pair_.b_to_a.translation;
        return centers.norm() > 0 ? Vec3(centers.normalized()) : Vec3::UnitX();
    }

    Vec3 area_vector() const {
        Vec3 sum = Vec3::Zero(), sum_along_centers = Vec3::Zero();
        double sum_of_norms = 0;
        for (std::uint32_t i = 0; i < segments_.size(); ++i) {
            if (segments_[i].region != region_ || segments_[i].loop != i) continue;
            const Vec3 area = area_of_loop(i);
            sum += area;
            sum_along_centers += area.dot(pair_.b_to_a.translation) < 0 ? Vec3(-area) : area;
            sum_of_norms += area.norm();
        }
        return sum.norm() < pierced * sum_of_norms ? sum_along_centers : sum;
    }

private:
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (const ContourSegment& s : segments_)
            if (s.region == region_) visit(s);
    }
    const Vec3& normal_a(const ContourSegment& s) const { return pair_.a.normals[s.triangle_a]; }
    Vec3 normal_b(const ContourSegment& s) const { return pair_.b_to_a.rotation * pair_.b.normals[s.triangle_b]; }

    // Whether it is more than rounding.
    bool is_area(const Vec3& area) const { return area.norm() > 1e-12 * length_ * length_; }

    // The given unit vector or its opposite, whichever agrees with the area; as given, if the area cannot tell.
    Vec3 turned_along(const Vec3& area, const Vec3& n) const { return is_area(area) && area.dot(n) < 0 ? Vec3(-n) : n; }

    Vec3 area_of_loop(std::uint32_t loop) const {
        Vec3 area = Vec3::Zero();
        for_each([&](const ContourSegment& s) {
            if (s.loop == loop) area += 0.5 * (s.from.point - center_).cross(s.to.point - center_);
        });
        return area;
    }

    // Of all triangles of one body along the curve; zero if they have none in common.
    Vec3 common_normal(bool of_a) const {
        Vec3 common = Vec3::Zero();
        bool alike = true;
        for_each([&](const ContourSegment& s) {
            const Vec3 n = of_a ? normal_a(s) : normal_b(s);
            if (common.isZero()) common = n;
            alike = alike && (n - common).norm() < flat;
        });
        return alike ? common : Vec3::Zero();
    }

    // Of one edge of each body, where these two make all four crossings; zero otherwise.
    Vec3 edges_normal() const {
        const Crossing *of_a = nullptr, *of_b = nullptr;
        int count = 0;
        bool two_edges = true;
        for_each([&](const ContourSegment& s) {
            const Crossing*& first = s.from.edge_of_a ? of_a : of_b;
            if (!first) first = &s.from;
            two_edges = two_edges && first->edge == s.from.edge;
            ++count;
        });
        if (!two_edges || count != 4 || !of_a || !of_b) return Vec3::Zero();
        const auto direction = [](const Mesh& mesh, const Crossing* c) -> Vec3 {
            return (mesh.vertices[mesh.edges[c->edge].v1] - mesh.vertices[mesh.edges[c->edge].v0]).normalized();
        };
        const Vec3 normal = direction(pair_.a, of_a).cross(pair_.b_to_a.rotation * direction(pair_.b, of_b));
        return normal.norm() > parallel ? Vec3(normal.normalized()) : Vec3::Zero();
    }

    const MeshPair& pair_;
    std::span<const ContourSegment> segments_;
    std::uint32_t region_;
    double length_ = 0;
    Vec3 center_ = Vec3::Zero();
    Vec3 across_ = Vec3::Zero();  // sum of the surfaces' normals along the curve, B's turned round
};

constexpr double least_depth = std::numeric_limits<double>::min();  // m: a touch is a contact, and has a depth

// Up to four points of the curve, each with its own depth. The deepest place of all is always among the points: if none
// is as deep, the one nearest to it gives way.
void add_points(const OverlapDepth& depth, const OverlapDepth::Chord& longest, ContourScratch& scratch,
                std::uint32_t id, ContactRegion& region) {
    scratch.points.clear();
    scratch.curve.clear();
    for (std::uint32_t i = 0; i < scratch.segments.size(); ++i)
        if (scratch.segments[i].region == id) {
            scratch.points.push_back(scratch.segments[i].from.point);
            scratch.curve.push_back(i);
        }
    std::array<std::uint32_t, 4> chosen;
    for (const std::uint32_t i : spread_points(scratch.points, chosen)) {
        const Crossing& crossing = scratch.segments[scratch.curve[i]].from;
        region.depths[region.count] = std::max(depth.at(crossing), least_depth);
        region.points[region.count++] = crossing.point;
    }
    const auto depths = std::span(region.depths).first(static_cast<std::size_t>(region.count));
    if (*std::max_element(depths.begin(), depths.end()) >= (1 - 1e-9) * longest.length) return;
    const auto points = std::span(region.points).first(depths.size());
    const auto nearest = std::min_element(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
        return (p - longest.middle).squaredNorm() < (q - longest.middle).squaredNorm();
    });
    const auto place = region.count < 4 ? region.count++ : nearest - points.begin();
    region.points[place] = longest.middle;
    region.depths[place] = longest.length;
}

// Of the region that lies nearest.
Vec3 area_on_other_side(const Vec3& center, const ContourScratch& scratch) {
    const auto nearest = std::min_element(
        scratch.other_side.begin(), scratch.other_side.end(), [&](const RegionArea& x, const RegionArea& y) {
            return (x.center - center).squaredNorm() < (y.center - center).squaredNorm();
        });
    return nearest == scratch.other_side.end() ? Vec3(Vec3::Zero()) : nearest->area;
}

ContactRegion make_region(const MeshPair& pair, std::uint32_t id, ContourScratch& scratch) {
    const Curve curve(pair, scratch.segments, id);
    ContactRegion region;
    region.normal = curve.normal(curve.area_vector() + area_on_other_side(curve.center(), scratch));
    region.center = curve.center();
    OverlapDepth depth(pair, id, region.normal, scratch);
    const OverlapDepth::Chord longest = depth.longest();
    region.depth = std::max(longest.length, least_depth);
    add_points(depth, longest, scratch, id, region);
    return region;
}

void find_curve(const MeshPair& pair, std::span<const TriangleHit> hits, Nudge& nudge, ContourScratch& scratch) {
    find_segments(pair, hits, nudge, scratch);
    join_segments(pair, scratch);
}

template <class Visit>
void for_each_region(const ContourScratch& scratch, const Visit& visit) {
    for (std::uint32_t i = 0; i < scratch.segments.size(); ++i)
        if (scratch.segments[i].region == i) visit(i);
}

}  // namespace

void ContourScratch::reserve(std::size_t most_vertices, std::size_t most_edges, std::size_t most_triangles) {
    constexpr std::size_t usual =
        512;  // triangle pairs of one mesh pair; more is possible, it only costs an allocation
    segments.reserve(usual);
    ends.reserve(2 * usual);
    along_edge.reserve(usual);
    points.reserve(2 * usual);
    curve.reserve(usual);
    other_side.reserve(usual);
    inside_of.reserve(most_vertices);
    view.reserve(2 * most_triangles);
    vertices.reserve(most_vertices);
    triangles.reserve(most_triangles);
    for (Marks* marks : {&edges, &pierced_a, &pierced_b, &repeated_a, &repeated_b}) marks->reserve(most_edges);
    for (InnerPatch* patch : {&patch_a, &patch_b}) {
        patch->triangles.reserve(most_triangles);
        patch->vertices.reserve(most_vertices);
        patch->edges.reserve(most_edges);
    }
}

void contour_regions(const MeshPair& pair, std::span<const TriangleHit> hits, ContourScratch& scratch,
                     std::vector<ContactRegion>& regions) {
    Nudge nudge(pair.b_to_a.translation);
    find_curve(pair, hits, nudge, scratch);
    scratch.other_side.clear();
    if (nudge.went_sideways()) {
        Nudge other = nudge.to_other_side();
        find_curve(pair, hits, other, scratch);
        for_each_region(scratch, [&](std::uint32_t id) {
            const Curve curve(pair, scratch.segments, id);
            scratch.other_side.push_back({curve.center(), curve.area_vector()});
        });
        find_curve(pair, hits, nudge, scratch);
    }
    for_each_region(scratch, [&](std::uint32_t id) { regions.push_back(make_region(pair, id, scratch)); });
}

}  // namespace kolize
