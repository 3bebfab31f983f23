// Candidate triangles by Embree's trees, the test by exact predicates.
//
// Every mesh is an Embree scene of boxes, built once. The boxes of the mesh with fewer triangles are refitted in the
// frame of the other one for every pair of bodies, and rtcCollide walks the two trees. Boxes are floats, rounded
// outward; whether two triangles meet is decided in double, with the corners as they come.
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin.h>
#include <kolize/predicates.h>

#include <embree3/rtcore.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>

namespace {

using namespace kolize;

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using Scene = std::unique_ptr<RTCSceneTy, Release>;

// Embree drops boxes beyond 1.8e18. Where all coordinates are cut off alike, boxes that meet still do.
float within_range(double x) { return static_cast<float>(std::clamp(x, -1e18, 1e18)); }
float round_down(double x) { return std::nextafter(within_range(x), -1e19f); }
float round_up(double x) { return std::nextafter(within_range(x), 1e19f); }

// A mesh as Embree sees it: the box of each triangle, where the mesh stands now.
class BoxScene {
public:
    BoxScene(RTCDevice device, const Mesh& mesh) : mesh_(mesh), scene_(rtcNewScene(device)) {
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh.triangles.size()));
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryBoundsFunction(geometry, &bounds, nullptr);
        // Only with all three of these is a tree refitted and not built anew, which takes ten times as long.
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_LOW);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
        rtcCommitGeometry(geometry);
        geometry_id_ = rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_.get());
        if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
            throw std::runtime_error("Embree cannot take a mesh (error " + std::to_string(error) + ")");
    }

    // slack: m, more than the rounding of a place.
    void refit(const Transform& place, double slack) {
        place_ = place;
        slack_ = slack;
        rtcCommitGeometry(rtcGetGeometry(scene_.get(), geometry_id_));
        rtcCommitScene(scene_.get());
    }

    RTCScene scene() const { return scene_.get(); }

private:
    static void bounds(const RTCBoundsFunctionArguments* call) {
        const auto& self = *static_cast<const BoxScene*>(call->geometryUserPtr);
        Aabb box;
        for (const std::uint32_t v : self.mesh_.triangles[call->primID])
            box.include(self.place_ * self.mesh_.vertices[v]);
        RTCBounds& out = *call->bounds_o;
        out.lower_x = round_down(box.min.x() - self.slack_);
        out.lower_y = round_down(box.min.y() - self.slack_);
        out.lower_z = round_down(box.min.z() - self.slack_);
        out.upper_x = round_up(box.max.x() + self.slack_);
        out.upper_y = round_up(box.max.y() + self.slack_);
        out.upper_z = round_up(box.max.z() + self.slack_);
    }

    const Mesh& mesh_;
    Transform place_;
    double slack_ = 0;
    Scene scene_;
    unsigned geometry_id_ = 0;
};

using IdPairs = std::vector<std::pair<unsigned, unsigned>>;

struct Candidates {
    std::mutex mutex;  // Embree may call back from several threads
    IdPairs ids;       // of the two scenes of rtcCollide, in their order
};

void collect(void* user, RTCCollision* collisions, unsigned count) {
    auto& candidates = *static_cast<Candidates*>(user);
    const std::lock_guard lock(candidates.mutex);
    for (unsigned i = 0; i < count; ++i) candidates.ids.emplace_back(collisions[i].primID0, collisions[i].primID1);
}

// Where the edges of one triangle cross the plane of the other, or touch it: what both triangles have of the line in
// which the planes meet is between the second and the third of four such points.
void add_cuts(const Vec3 (&edges)[3], const Vec3 (&face)[3], std::vector<Vec3>& cuts) {
    const Vec3 normal = (face[1] - face[0]).cross(face[2] - face[0]);
    for (int k = 0; k < 3; ++k) {
        const Vec3 &p = edges[k], &q = edges[(k + 1) % 3];
        const double hp = normal.dot(p - face[0]), hq = normal.dot(q - face[0]);
        if ((hp <= 0) != (hq <= 0)) cuts.push_back(p + (q - p) * (hp / (hp - hq)));
    }
}

TriangleSegment common_segment(const TrianglePair& pair) {
    std::vector<Vec3> cuts;
    add_cuts(pair.a, pair.b, cuts);
    add_cuts(pair.b, pair.a, cuts);
    if (cuts.size() < 4)
        return cuts.empty() ? TriangleSegment{pair.a[0], pair.a[0]} : TriangleSegment{cuts[0], cuts[0]};
    const Vec3 line = (pair.a[1] - pair.a[0])
                          .cross(pair.a[2] - pair.a[0])
                          .cross((pair.b[1] - pair.b[0]).cross(pair.b[2] - pair.b[0]));
    std::sort(cuts.begin(), cuts.end(), [&](const Vec3& p, const Vec3& q) { return line.dot(p) < line.dot(q); });
    return {cuts[1], cuts[2]};
}

class Embree final : public MeshNarrowphase {
public:
    static void parameters(Parameters<Embree>& p) { mesh_parameters<Embree>(p); }

    void prepare(const World& world) override {
        MeshNarrowphase::prepare(world);
        moving_.clear();
        still_.clear();
        if (!device_) device_.reset(rtcNewDevice(nullptr));
        if (!device_) throw std::runtime_error("Embree does not start");
        for (const Shape& shape : world.shapes)
            still_.push_back(shape.mesh ? std::make_unique<BoxScene>(device_.get(), *shape.mesh) : nullptr);
        moving_.resize(world.shapes.size());
    }

private:
    void intersect_meshes(const MeshPair& pair, TriangleHits& hits) const override {
        for (const auto& [a, b] : candidates(pair)) {
            TrianglePair triangles;
            for (int k = 0; k < 3; ++k) {
                triangles.a[k] = pair.a.vertices[pair.a.triangles[a][k]];
                triangles.b[k] = pair.b_to_a * pair.b.vertices[pair.b.triangles[b][k]];
            }
            ++hits.tests;
            if (!triangles_intersect(triangles.a, triangles.b)) continue;
            hits.hits.push_back({a, b, pair.want_segments ? common_segment(triangles) : TriangleSegment{}});
            if (pair.first_only) return;
        }
    }

    // Triangles of A and B whose boxes meet, in order.
    IdPairs candidates(const MeshPair& pair) const {
        const bool b_moves = pair.b.triangles.size() <= pair.a.triangles.size();
        const Mesh& mesh = b_moves ? pair.b : pair.a;
        const std::uint32_t moves = b_moves ? pair.shape_b : pair.shape_a,
                            stays = b_moves ? pair.shape_a : pair.shape_b;
        std::unique_ptr<BoxScene> scene = borrow(moves, mesh);
        const double size = pair.a.radius + pair.b.radius + pair.b_to_a.translation.norm();
        scene->refit(b_moves ? pair.b_to_a : pair.b_to_a.inverse(), 64 * std::numeric_limits<double>::epsilon() * size);
        Candidates found;
        rtcCollide(still_[stays]->scene(), scene->scene(), &collect, &found);
        give_back(moves, std::move(scene));
        if (!b_moves)
            for (auto& [a, b] : found.ids) std::swap(a, b);
        std::sort(found.ids.begin(), found.ids.end());
        return std::move(found.ids);
    }

    // A scene is refitted by one pair at a time. No lock is held while Embree works: it waits for tasks, and the thread
    // may take up another pair meanwhile.
    std::unique_ptr<BoxScene> borrow(std::uint32_t shape, const Mesh& mesh) const {
        {
            const std::lock_guard lock(mutex_);
            auto& unused = moving_[shape];
            if (!unused.empty()) {
                auto scene = std::move(unused.back());
                unused.pop_back();
                return scene;
            }
        }
        return std::make_unique<BoxScene>(device_.get(), mesh);
    }
    void give_back(std::uint32_t shape, std::unique_ptr<BoxScene> scene) const {
        const std::lock_guard lock(mutex_);
        moving_[shape].push_back(std::move(scene));
    }

    Device device_;
    std::vector<std::unique_ptr<BoxScene>> still_;  // by shape, in the body frame; null where the shape has no mesh
    mutable std::mutex mutex_;
    mutable std::vector<std::vector<std::unique_ptr<BoxScene>>> moving_;  // by shape: those that no pair uses
};

}  // namespace

KOLIZE_PLUGIN(Embree, .name = "embree", .summary = "candidate triangles by Embree's rtcCollide, exact triangle test",
              .source = "Wald et al., Embree: a kernel framework for efficient CPU ray tracing, SIGGRAPH 2014",
              .cost =
                  "A refit of the smaller mesh for every pair of bodies, whatever the two have in common: time "
                  "grows with its triangles. Memory for a second tree of each mesh. Debian builds Embree with "
                  "assertions on.",
              .accuracy =
                  "Exact for the corners as they come, as moller: boxes are rounded outward and only choose "
                  "which triangles are tested.",
              .choose = "Choose it to compare with, or to check another narrowphase against; moller does not refit.",
              .capabilities = {.shape_kinds = all_shape_kinds | bit(ShapeKind::capsule),
                               .time_of_impact = true,
                               .allocates = true,
                               .exact = true,
                               .crossings = true})
