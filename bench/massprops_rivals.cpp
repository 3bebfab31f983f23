#include "massprops_rivals.h"

#include <kolize/error.h>

#include <embree3/rtcore.h>

namespace bench {

using kolize::GridLines;
using kolize::MassProperties;
using kolize::Mat3;
using kolize::Triangle;
using kolize::TriangleSoup;
using kolize::Vec3;

namespace {

// From plain sums over a solid: volume, integrals of x, y, z and of xx, yy, zz, yz, zx, xy.
MassProperties properties_of(double volume, const Vec3& first, const Vec3& squares, const Vec3& products,
                             const Vec3& reference) {
    MassProperties mass;
    mass.volume = volume;
    const Vec3 center = first / volume;
    Mat3 second = (squares / volume).asDiagonal();
    second(1, 2) = second(2, 1) = products[0] / volume;
    second(2, 0) = second(0, 2) = products[1] / volume;
    second(0, 1) = second(1, 0) = products[2] / volume;
    second -= center * center.transpose();
    mass.center_of_mass = reference + center;
    mass.inertia_over_mass = second.trace() * Mat3::Identity() - second;
    return mass;
}

}  // namespace

MassProperties scalar_mass_properties(const TriangleSoup& closed_surface) {
    const Vec3 reference = closed_surface.vertices[closed_surface.triangles.front()[0]];
    double volume = 0, x = 0, y = 0, z = 0, xx = 0, yy = 0, zz = 0, yz = 0, zx = 0, xy = 0;
    for (const Triangle& t : closed_surface.triangles) {
        const Vec3 a = closed_surface.vertices[t[0]] - reference;
        const Vec3 b = closed_surface.vertices[t[1]] - reference;
        const Vec3 c = closed_surface.vertices[t[2]] - reference;
        const double d = a.dot(b.cross(c));
        const Vec3 s = a + b + c;
        const auto second = [&](int i, int j) { return d * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]); };
        volume += d;
        x += d * s[0];
        y += d * s[1];
        z += d * s[2];
        xx += second(0, 0);
        yy += second(1, 1);
        zz += second(2, 2);
        yz += second(1, 2);
        zx += second(2, 0);
        xy += second(0, 1);
    }
    return properties_of(volume / 6, Vec3(x, y, z) / 24, Vec3(xx, yy, zz) / 120, Vec3(yz, zx, xy) / 120, reference);
}

class SingleRays::Scene {
public:
    explicit Scene(const TriangleSoup& surface) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        for (const Vec3& p : surface.vertices) bounds_.include(p);
        const Vec3 center = bounds_.center();
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), surface.vertices.size()));
        auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), surface.triangles.size()));
        if (!vertex || !index) throw kolize::Error("Embree has no memory for this surface");
        for (const Vec3& p : surface.vertices)
            for (const double x : Vec3(p - center)) *vertex++ = static_cast<float>(x);
        for (const Triangle& triangle : surface.triangles)
            for (const std::uint32_t v : triangle) *index++ = v;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~Scene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    const kolize::Aabb& bounds() const { return bounds_; }

    // visit(distance in m, component of the triangle's normal along the axis) for every hit, by distance.
    template <class Visit>
    void for_each_hit(const Vec3& from, int axis, const Visit& visit) const {
        const Vec3 origin = from - bounds_.center();
        const double length = 2 * (bounds_.max - bounds_.min)[axis];
        const float behind = static_cast<float>(1e-6 * length);
        RTCRayHit ray{};
        ray.ray.org_x = static_cast<float>(origin[0]);
        ray.ray.org_y = static_cast<float>(origin[1]);
        ray.ray.org_z = static_cast<float>(origin[2]);
        (axis == 0 ? ray.ray.dir_x : axis == 1 ? ray.ray.dir_y : ray.ray.dir_z) = 1;
        ray.ray.mask = ~0u;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        while (true) {
            ray.ray.tfar = static_cast<float>(length);
            ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene_, &context, &ray);
            if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
            visit(ray.ray.tfar, axis == 0 ? ray.hit.Ng_x : axis == 1 ? ray.hit.Ng_y : ray.hit.Ng_z);
            ray.ray.tnear = ray.ray.tfar + behind;
        }
    }

    class Lines;
    class Scan;

private:
    RTCDevice device_;
    RTCScene scene_;
    kolize::Aabb bounds_;
};

class SingleRays::Scene::Scan : public kolize::LineScan {
public:
    Scan(const Scene& scene, const GridLines& lines) : scene_(scene), lines_(lines) {}

    const kolize::LineCrossings& cast(std::size_t band) override {
        hits_.clear();
        std::uint32_t line = 0;
        for (std::size_t row = lines_.first_row(band); row < lines_.last_row(band); ++row)
            for (const double column : lines_.columns) cast_line(column, lines_.rows[row], line++);
        kolize::sort_hits(hits_, line, out_);
        return out_;
    }

private:
    void cast_line(double column, double row, std::uint32_t line) {
        const int axis = lines_.axis;
        Vec3 from;
        from[axis] = scene_.bounds().min[axis] - 0.01 * (scene_.bounds().max - scene_.bounds().min)[axis];
        from[lines_.column_axis] = column;
        from[lines_.row_axis] = row;
        scene_.for_each_hit(from, axis, [&](double distance, float normal) {
            hits_.push_back({from[axis] + distance, line, normal > 0 ? -1 : 1});
        });
    }

    const Scene& scene_;
    const GridLines& lines_;
    std::vector<kolize::LineHit> hits_;
    kolize::LineCrossings out_;
};

class SingleRays::Scene::Lines : public kolize::LineCaster {
public:
    Lines(std::shared_ptr<const Scene> scene, const GridLines& lines) : scene_(std::move(scene)), lines_(lines) {}
    std::unique_ptr<kolize::LineScan> start() const override { return std::make_unique<Scan>(*scene_, lines_); }

private:
    std::shared_ptr<const Scene> scene_;
    const GridLines& lines_;
};

SingleRays::SingleRays(const TriangleSoup& surface) : scene_(std::make_shared<const Scene>(surface)) {}

SingleRays::~SingleRays() = default;

kolize::MakeLineCaster SingleRays::line_caster() const {
    return [scene = scene_](const TriangleSoup&, const GridLines& lines) {
        return std::make_unique<Scene::Lines>(scene, lines);
    };
}

MassProperties SingleRays::by_points(const kolize::VoxelGrid& grid) const {
    const Vec3 reference = scene_->bounds().center();
    double inside = 0;
    Vec3 first = Vec3::Zero(), squares = Vec3::Zero(), products = Vec3::Zero();
    for (int k = 0; k < grid.cells[2]; ++k)
        for (int j = 0; j < grid.cells[1]; ++j)
            for (int i = 0; i < grid.cells[0]; ++i) {
                const Vec3 at = grid.origin + (Vec3(i, j, k).array() + 0.5).matrix().cwiseProduct(grid.spacing);
                bool odd = false;
                scene_->for_each_hit(at, 0, [&](float, float) { odd = !odd; });
                if (!odd) continue;
                const Vec3 p = at - reference;
                inside += 1;
                first += p;
                squares += p.cwiseProduct(p);
                products += Vec3(p[1] * p[2], p[2] * p[0], p[0] * p[1]);
            }
    MassProperties mass = properties_of(inside, first, squares, products, reference);
    mass.volume *= grid.spacing.prod();
    return mass;
}

}  // namespace bench
