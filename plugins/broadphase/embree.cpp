// Broadphase by Embree: the boxes are user geometry, and rtcCollide walks its trees.
//
// The moving boxes are one Embree scene, refitted in every call and built anew with the generation; the static ones are
// another one. Embree's boxes are floats, rounded outward; whether two boxes overlap is decided by the true ones.
#include <kolize/plugin.h>

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

namespace {

using kolize::Aabb;
using kolize::Pair;

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using Scene = std::unique_ptr<RTCSceneTy, Release>;

// Embree drops boxes beyond 1.8e18. Where all coordinates are cut off alike, boxes that overlap still do.
float within_range(double x) { return static_cast<float>(std::clamp(x, -1e18, 1e18)); }
// It computes without the smallest floats, and boxes must not be flat for it.
constexpr float least = 1e-30f;
float round_down(double x) { return std::nextafter(within_range(x) - least, -1e19f); }
float round_up(double x) { return std::nextafter(within_range(x) + least, 1e19f); }

// Some rows of the input as Embree sees them.
class BoxScene {
public:
    bool empty() const { return rows.empty(); }

    void build(RTCDevice device, std::span<const Aabb> bounds) {
        bounds_ = bounds;
        scene_.reset(rows.empty() ? nullptr : rtcNewScene(device));
        if (rows.empty()) return;
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(rows.size()));
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryBoundsFunction(geometry, &set_bounds, nullptr);
        // Only with all three of these is a tree refitted and not built anew.
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_LOW);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
        rtcCommitGeometry(geometry);
        geometry_id_ = rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_.get());
        if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
            throw std::runtime_error("Embree cannot take the boxes (error " + std::to_string(error) + ")");
    }

    void refit(std::span<const Aabb> bounds) {
        bounds_ = bounds;
        rtcCommitGeometry(rtcGetGeometry(scene_.get(), geometry_id_));
        rtcCommitScene(scene_.get());
    }

    RTCScene scene() const { return scene_.get(); }

    std::vector<std::uint32_t> rows;

private:
    static void set_bounds(const RTCBoundsFunctionArguments* call) {
        const auto& self = *static_cast<const BoxScene*>(call->geometryUserPtr);
        const Aabb& box = self.bounds_[self.rows[call->primID]];
        *call->bounds_o = {round_down(box.min.x()), round_down(box.min.y()), round_down(box.min.z()), 0,
                           round_up(box.max.x()),   round_up(box.max.y()),   round_up(box.max.z()),   0};
    }

    std::span<const Aabb> bounds_;
    Scene scene_;
    unsigned geometry_id_ = 0;
};

class Embree final : public kolize::Broadphase {
public:
    void find_pairs(const kolize::BroadphaseInput& input, std::vector<Pair>& pairs) override {
        kolize::require_valid_bounds(input.bounds);
        if (!device_) device_.reset(rtcNewDevice("threads=1"));
        if (!device_) throw std::runtime_error("Embree does not start");
        if (input.generation != generation_ || input.bounds.size() != moving_.rows.size() + static_.rows.size()) {
            moving_.rows.clear();
            static_.rows.clear();
            for (std::uint32_t row = 0; row < input.bounds.size(); ++row)
                (input.is_static[row] ? static_ : moving_).rows.push_back(row);
            moving_.build(device_.get(), input.bounds);
            static_.build(device_.get(), input.bounds);
            generation_ = input.generation;
        } else if (!moving_.empty()) {
            moving_.refit(input.bounds);
        }
        candidates_.clear();
        if (!moving_.empty()) find_between(moving_);
        if (!moving_.empty() && !static_.empty()) find_between(static_);
        // Not in Embree's call: there the processor takes the smallest numbers for 0.
        for (const Pair& pair : candidates_)
            if (input.bounds[pair.a].overlaps(input.bounds[pair.b])) pairs.push_back(pair);
    }

private:
    void find_between(const BoxScene& other) {
        other_ = &other;
        rtcCollide(moving_.scene(), other.scene(), &collect, this);
    }

    // Of a scene with itself Embree tells every pair in both orders, and every box with itself.
    static void collect(void* user, RTCCollision* collisions, unsigned count) {
        auto& self = *static_cast<Embree*>(user);
        const std::lock_guard lock(self.mutex_);  // Embree may call back from several threads
        for (unsigned i = 0; i < count; ++i) {
            const std::uint32_t a = self.moving_.rows[collisions[i].primID0];
            const std::uint32_t b = self.other_->rows[collisions[i].primID1];
            if (self.other_ == &self.static_ || a < b) self.candidates_.push_back({std::min(a, b), std::max(a, b)});
        }
    }

    Device device_;
    BoxScene moving_, static_;
    std::uint64_t generation_ = 0;
    const BoxScene* other_ = nullptr;
    std::vector<Pair> candidates_;
    std::mutex mutex_;
};

}  // namespace

KOLIZE_PLUGIN(
    Embree, .name = "embree", .summary = "Intel Embree's trees of the boxes, walked by rtcCollide",
    .source = "Wald et al., Embree: a kernel framework for efficient CPU ray tracing, SIGGRAPH 2014; rtcCollide",
    .cost =
        "O(N) to refit and O(N + pairs) to search, whether boxes move or not; static ones cost nothing but the "
        "search.",
    .accuracy =
        "Exact: a pair is reported if and only if its closed boxes overlap. Beyond 1e18 m Embree does not tell "
        "places apart, and every pair there is tested.",
    .choose = "To compare with: a widely used tree of others. grid and sweep_and_prune are several times faster.",
    .capabilities = {.allocates = true, .exact = true})
