#include "contact_model/contact_model.h"

#include <algorithm>
#include <tuple>

namespace kolize {

namespace {

bool before(const Vec3& p, const Vec3& q) { return std::tie(p[0], p[1], p[2]) < std::tie(q[0], q[1], q[2]); }

// A crossing of an edge with a face is found once from each of the two triangles along the edge; the thesis keeps what
// was found twice, comparing bits.
Vec3 mean_point(std::span<const TriangleHit> hits, std::vector<Vec3>& points) {
    points.clear();
    for (const TriangleHit& hit : hits) {
        points.push_back(hit.segment.p);
        points.push_back(hit.segment.q);
    }
    std::sort(points.begin(), points.end(), before);
    Vec3 all = Vec3::Zero(), twice = Vec3::Zero();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        all += points[i];
        const bool first_of_equals = i == 0 || points[i] != points[i - 1];
        if (first_of_equals && i + 1 < points.size() && points[i] == points[i + 1]) {
            twice += points[i];
            ++kept;
        }
    }
    return kept ? Vec3(twice / static_cast<double>(kept)) : Vec3(all / static_cast<double>(points.size()));
}

struct Side {
    Vec3 normal_sum = Vec3::Zero();  // frame of A
    std::size_t triangles = 0;
};

Side touched(const MeshPair& pair, bool of_a, std::span<const TriangleHit> hits, Marks& seen) {
    const Mesh& mesh = of_a ? pair.a : pair.b;
    seen.reset(mesh.triangles.size());
    Side side;
    for (const TriangleHit& hit : hits) {
        const std::uint32_t t = of_a ? hit.a : hit.b;
        if (seen.test(t)) continue;
        seen.set(t);
        side.normal_sum += of_a ? mesh.normals[t] : Vec3(pair.b_to_a.rotation * mesh.normals[t]);
        ++side.triangles;
    }
    return side;
}

// How far the touched triangles of the other body reach behind the contact plane.
double depth_behind(const MeshPair& pair, bool of_a, std::span<const TriangleHit> hits, const Vec3& outward,
                    const Vec3& point) {
    double depth = 0;
    for (const TriangleHit& hit : hits)
        for (int k = 0; k < 3; ++k) {
            const Vec3 v = of_a ? pair.a.vertices[pair.a.triangles[hit.a][k]]
                                : Vec3(pair.b_to_a * pair.b.vertices[pair.b.triangles[hit.b][k]]);
            depth = std::max(depth, outward.dot(point - v));
        }
    return depth;
}

}  // namespace

void averaged_region(const MeshPair& pair, std::span<const TriangleHit> hits, bool a_is_static, bool b_is_static,
                     ContourScratch& scratch, std::vector<ContactRegion>& regions) {
    if (hits.empty()) return;
    const Side a = touched(pair, true, hits, scratch.triangles), b = touched(pair, false, hits, scratch.triangles);
    const bool take_a = a_is_static || (!b_is_static && a.triangles <= b.triangles);
    const Vec3 sum = take_a ? a.normal_sum : Vec3(-b.normal_sum);
    const double norm = sum.norm();
    const Vec3 centers = pair.b_to_a.translation;
    const Vec3 normal = norm > 1e-9                 ? Vec3(sum / norm)
                        : centers.squaredNorm() > 0 ? Vec3(centers.normalized())
                                                    : Vec3::UnitX();
    const Vec3 point = mean_point(hits, scratch.points);
    const double depth = depth_behind(pair, !take_a, hits, take_a ? normal : Vec3(-normal), point);
    regions.push_back(ContactRegion::single(normal, point, std::max(depth, std::numeric_limits<double>::min())));
}

}  // namespace kolize
