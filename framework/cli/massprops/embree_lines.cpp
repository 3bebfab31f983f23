#include "massprops/embree_lines.h"

#include <kolize/error.h>

#include <embree3/rtcore.h>

#include <mutex>

namespace kolize {

namespace {

constexpr std::size_t packet_size = 16;

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using Scene = std::unique_ptr<RTCSceneTy, ReleaseScene>;

void require(bool fine, RTCDevice device) {
    if (!fine) throw Error("Embree cannot take this surface (error " + std::to_string(rtcGetDeviceError(device)) + ")");
}

// Embree calls the filter at every hit, and goes on along the ray as the filter refuses them all.
struct Collector {
    RTCIntersectContext context;  // first: Embree hands a pointer to it back
    std::vector<LineHit>* hits;
    int axis;
    double from;  // depth of the rays' origin
};

void collect(const RTCFilterFunctionNArguments* call) {
    const Collector& collector = *reinterpret_cast<const Collector*>(call->context);
    for (unsigned i = 0; i < call->N; ++i) {
        if (call->valid[i] == 0) continue;
        const float normal[3] = {RTCHitN_Ng_x(call->hit, call->N, i), RTCHitN_Ng_y(call->hit, call->N, i),
                                 RTCHitN_Ng_z(call->hit, call->N, i)};
        const double depth = collector.from + static_cast<double>(RTCRayN_tfar(call->ray, call->N, i));
        collector.hits->push_back({depth, RTCRayN_id(call->ray, call->N, i), normal[collector.axis] > 0 ? -1 : 1});
        call->valid[i] = 0;
    }
}

class EmbreeSurface {
public:
    explicit EmbreeSurface(const TriangleSoup& surface) : device_(rtcNewDevice(nullptr)) {
        require(device_ != nullptr, nullptr);
        scene_.reset(rtcNewScene(device_.get()));
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        for (const Triangle& triangle : surface.triangles)
            for (const std::uint32_t v : triangle) bounds_.include(surface.vertices[v]);
        center_ = bounds_.center();
        attach(surface);
        rtcCommitScene(scene_.get());
        require(rtcGetDeviceError(device_.get()) == RTC_ERROR_NONE, device_.get());
    }

    RTCScene scene() const { return scene_.get(); }
    const Aabb& bounds() const { return bounds_; }
    const Vec3& center() const { return center_; }

private:
    void attach(const TriangleSoup& surface) {
        const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), surface.vertices.size()));
        auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), surface.triangles.size()));
        require(vertex && index, device_.get());
        for (const Vec3& p : surface.vertices)
            for (const double x : Vec3(p - center_)) *vertex++ = static_cast<float>(x);
        for (const Triangle& triangle : surface.triangles)
            for (const std::uint32_t v : triangle) *index++ = v;
        rtcSetGeometryIntersectFilterFunction(geometry, collect);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
    }

    Device device_;
    Scene scene_;
    Aabb bounds_;
    Vec3 center_;
};

class EmbreeScan : public LineScan {
public:
    EmbreeScan(const EmbreeSurface& surface, const GridLines& lines, double begin, double length)
        : surface_(surface), lines_(lines), begin_(begin), length_(length) {}

    const LineCrossings& cast(std::size_t band) override {
        hits_.clear();
        std::uint32_t line = 0;
        for (std::size_t row = lines_.first_row(band); row < lines_.last_row(band); ++row)
            for (std::size_t column = 0; column < lines_.columns.size(); column += packet_size) {
                const std::size_t rays = std::min(packet_size, lines_.columns.size() - column);
                cast_packet(row, column, rays, line);
                line += static_cast<std::uint32_t>(rays);
            }
        sort_hits(hits_, line, out_);
        return out_;
    }

private:
    void cast_packet(std::size_t row, std::size_t column, std::size_t rays, std::uint32_t line) {
        RTCRayHit16 packet;
        alignas(64) int valid[packet_size];
        float* const origin[3] = {packet.ray.org_x, packet.ray.org_y, packet.ray.org_z};
        float* const direction[3] = {packet.ray.dir_x, packet.ray.dir_y, packet.ray.dir_z};
        const Vec3& center = surface_.center();
        for (std::size_t i = 0; i < packet_size; ++i) {
            valid[i] = i < rays ? -1 : 0;
            const double at = lines_.columns[std::min(column + i, lines_.columns.size() - 1)];
            origin[lines_.axis][i] = static_cast<float>(begin_ - center[lines_.axis]);
            origin[lines_.column_axis][i] = static_cast<float>(at - center[lines_.column_axis]);
            origin[lines_.row_axis][i] = static_cast<float>(lines_.rows[row] - center[lines_.row_axis]);
            for (int k = 0; k < 3; ++k) direction[k][i] = k == lines_.axis ? 1 : 0;
            packet.ray.tnear[i] = 0;
            packet.ray.tfar[i] = i < rays ? static_cast<float>(length_) : -1;
            packet.ray.time[i] = 0;
            packet.ray.mask[i] = ~0u;
            packet.ray.id[i] = line + static_cast<unsigned>(i);
            packet.ray.flags[i] = 0;
            packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        Collector collector{{}, &hits_, lines_.axis, begin_};
        rtcInitIntersectContext(&collector.context);
        collector.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcIntersect16(valid, surface_.scene(), &collector.context, &packet);
    }

    const EmbreeSurface& surface_;
    const GridLines& lines_;
    double begin_, length_;  // of the rays
    std::vector<LineHit> hits_;
    LineCrossings out_;
};

class EmbreeCaster : public LineCaster {
public:
    EmbreeCaster(std::shared_ptr<const EmbreeSurface> embree, const GridLines& lines)
        : embree_(std::move(embree)), lines_(lines) {
        const Aabb& bounds = embree_->bounds();
        const double length = bounds.max[lines.axis] - bounds.min[lines.axis];
        begin_ = bounds.min[lines.axis] - 0.01 * length;
        length_ = 1.02 * length;
    }
    std::unique_ptr<LineScan> start() const override {
        return std::make_unique<EmbreeScan>(*embree_, lines_, begin_, length_);
    }

private:
    std::shared_ptr<const EmbreeSurface> embree_;
    const GridLines& lines_;
    double begin_, length_;
};

// Casters of the axes share the surface's tree, whichever is made first.
class SharedSurface {
public:
    std::shared_ptr<const EmbreeSurface> of(const TriangleSoup& surface) {
        const std::lock_guard lock(mutex_);
        if (!embree_ || made_for_ != &surface) embree_ = std::make_shared<const EmbreeSurface>(surface);
        made_for_ = &surface;
        return embree_;
    }

private:
    std::mutex mutex_;
    const TriangleSoup* made_for_ = nullptr;
    std::shared_ptr<const EmbreeSurface> embree_;
};

}  // namespace

MakeLineCaster embree_line_caster() {
    return [shared = std::make_shared<SharedSurface>()](const TriangleSoup& surface, const GridLines& lines) {
        return std::make_unique<EmbreeCaster>(shared->of(surface), lines);
    };
}

}  // namespace kolize
