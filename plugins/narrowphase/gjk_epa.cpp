// Convex bodies by libccd: GJK finds whether they overlap, EPA or MPR how deep.
//
// A body is what its support function says: the farthest point in a direction. libccd compares with fixed numbers, so
// the pair is brought to size 1, with one body at the origin; and it does not treat its two bodies alike, so which one
// goes first is decided by where they stand and not by their numbers. Depth is what the support functions say along the
// normal that libccd found. Half-spaces need no search: the deepest point is the support against their normal.
#include <kolize/bounding_volumes.h>
#include <kolize/narrowphase.h>
#include <kolize/plugin.h>

#include <ccd/ccd.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace {

using namespace kolize;

constexpr std::size_t max_chunks = 32;

// A shape where its body stands, seen from the first body and in units of the pair's size.
struct Solid {
    const Shape* shape;
    Mat3 rotation;
    Vec3 position;  // units
    double scale;   // units a metre

    Vec3 support(const Vec3& direction) const {
        const Vec3 local = rotation.transpose() * direction;
        return position + rotation * (scale * farthest(local));
    }

private:
    // In the body frame, m.
    Vec3 farthest(const Vec3& d) const {
        const auto around = [&](double radius) -> Vec3 {
            const double length = d.norm();
            return length > 0 ? Vec3(radius / length * d) : Vec3(0, radius, 0);
        };
        switch (shape->kind) {
        case ShapeKind::sphere: return around(shape->radius);
        case ShapeKind::capsule:
            return around(shape->cap_radius) + Vec3(0, std::copysign(shape->half_height, d.y()), 0);
        case ShapeKind::box:
            return {std::copysign(shape->half_extents.x(), d.x()), std::copysign(shape->half_extents.y(), d.y()),
                    std::copysign(shape->half_extents.z(), d.z())};
        default: break;
        }
        const std::vector<Vec3>& points = shape->mesh->vertices;
        return *std::max_element(points.begin(), points.end(),
                                 [&](const Vec3& p, const Vec3& q) { return d.dot(p) < d.dot(q); });
    }
};

Vec3 to_vec(const ccd_vec3_t& v) { return {ccdVec3X(&v), ccdVec3Y(&v), ccdVec3Z(&v)}; }

void support_of(const void* solid, const ccd_vec3_t* direction, ccd_vec3_t* point) {
    const Vec3 p = static_cast<const Solid*>(solid)->support(to_vec(*direction));
    ccdVec3Set(point, p.x(), p.y(), p.z());
}

void center_of(const void* solid, ccd_vec3_t* center) {
    const Vec3& p = static_cast<const Solid*>(solid)->position;
    ccdVec3Set(center, p.x(), p.y(), p.z());
}

// In the units of the solids, seen from the first one.
struct Touch {
    Vec3 normal;  // unit, from the first to the second
    Vec3 point;
    double depth;
};

enum class Outcome { apart, overlap, failure };

struct Chunk {
    std::vector<Contact> rows;
    std::uint64_t failures = 0;
};

class GjkEpa final : public Narrowphase {
public:
    static void parameters(Parameters<GjkEpa>& p) {
        p.add("method", &GjkEpa::method_)
            .choices({"epa", "mpr"})
            .doc("How the depth is found: by growing a polytope, or by a portal that moves to the surface.");
        p.add("tolerance", &GjkEpa::tolerance_)
            .range(1e-12, 0.1)
            .doc("Of the depth, as a share of the pair's size; round bodies cost about its square root.");
        p.add("max_iterations", &GjkEpa::max_iterations_)
            .range(1, 1e6)
            .doc("Steps of the search for an overlap; a pair that needs more counts as a failure.");
    }

    Detail gives() const override { return Detail::normal; }

    void attach(Host& host) override {
        Narrowphase::attach(host);
        chunks_.resize(max_chunks);
    }

    void prepare(const World& world) override {
        volumes_.clear();
        for (const Shape& shape : world.shapes) volumes_.push_back(fit_volume(shape, VolumeKind::obb));
    }

    void find_contacts(const NarrowphaseInput& input, Contacts& contacts) override {
        const std::size_t count = input.pairs.size();
        const std::size_t grain = std::max<std::size_t>(4, (count + max_chunks - 1) / max_chunks);
        host().parallel_for(count, grain, [&](std::size_t number, std::size_t begin, std::size_t end) {
            Chunk& chunk = chunks_[number];
            chunk.rows.clear();
            chunk.failures = 0;
            for (std::size_t i = begin; i < end; ++i) collide(input.world, input.pairs[i], input.detail[i], chunk);
        });
        for (std::size_t number = 0; number < Host::chunk_count(count, grain); ++number) {
            const Chunk& chunk = chunks_[number];
            contacts.rows.insert(contacts.rows.end(), chunk.rows.begin(), chunk.rows.end());
            contacts.failures += chunk.failures;
        }
    }

private:
    void collide(const World& world, const Pair& pair, Detail detail, Chunk& chunk) const {
        for (const std::uint32_t body : {pair.a, pair.b})
            if (!world.position[body].allFinite() || !world.orientation[body].coeffs().allFinite())
                throw std::invalid_argument("body " + std::to_string(body) + " has a pose that is not finite");
        const bool swapped = goes_first(world, pair.b, pair.a);
        const std::uint32_t a = swapped ? pair.b : pair.a, b = swapped ? pair.a : pair.b;
        const Vec3 between = world.position[b] - world.position[a];
        const double size = size_of(world.shape_of(a)) + size_of(world.shape_of(b));
        const Solid first{&world.shape_of(a), world.orientation[a].toRotationMatrix(), Vec3::Zero(), 1 / size};
        const Solid second{&world.shape_of(b), world.orientation[b].toRotationMatrix(), between / size, 1 / size};
        if (!between.allFinite() || !second.position.allFinite()) return;  // farther apart than numbers reach
        Touch touch;
        Outcome outcome = meet(first, second, detail, touch);
        if (outcome == Outcome::failure) {
            ++chunk.failures;
            outcome = meet_bounds(world, a, b, size, touch);
        }
        if (outcome == Outcome::apart) return;
        Contact& row = chunk.rows.emplace_back();
        row.a = pair.a;
        row.b = pair.b;
        if (detail == Detail::overlap) return;
        row.normal = swapped ? Vec3(-touch.normal) : touch.normal;
        row.depth = size * touch.depth;
        const Vec3 from_a = size * touch.point, from_b = from_a - between;
        row.arm_a = swapped ? from_b : from_a;
        row.arm_b = swapped ? from_a : from_b;
    }

    // Decided by what does not change when the two exchange their numbers.
    static bool goes_first(const World& world, std::uint32_t x, std::uint32_t y) {
        const bool plane_x = world.shape_of(x).kind == ShapeKind::half_space;
        const bool plane_y = world.shape_of(y).kind == ShapeKind::half_space;
        if (plane_x != plane_y) return plane_y;  // a half-space comes second
        if (world.shape[x] != world.shape[y]) return world.shape[x] < world.shape[y];
        const Vec3 &p = world.position[x], &q = world.position[y];
        if (p != q) return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
        const auto &u = world.orientation[x].coeffs(), &v = world.orientation[y].coeffs();
        return std::lexicographical_compare(u.begin(), u.end(), v.begin(), v.end());
    }

    static double size_of(const Shape& shape) { return shape.kind == ShapeKind::half_space ? 0 : shape.radius; }

    Outcome meet(const Solid& first, const Solid& second, Detail detail, Touch& touch) const {
        if (second.shape->kind == ShapeKind::half_space) {
            touch.normal = -(second.rotation * second.shape->normal);
            touch.point = first.support(touch.normal);
            touch.depth = touch.normal.dot(touch.point - second.position);
            touch.point -= 0.5 * touch.depth * touch.normal;
            return touch.depth >= 0 ? Outcome::overlap : Outcome::apart;
        }
        ccd_t ccd;
        CCD_INIT(&ccd);
        ccd.support1 = ccd.support2 = &support_of;
        ccd.center1 = ccd.center2 = &center_of;
        ccd.max_iterations = static_cast<unsigned long>(max_iterations_);
        ccd.epa_tolerance = ccd.mpr_tolerance = ccd.dist_tolerance = tolerance_;
        if (detail == Detail::overlap && method_ == "epa")
            return ccdGJKIntersect(&first, &second, &ccd) ? Outcome::overlap : Outcome::apart;
        if (detail == Detail::overlap)
            return ccdMPRIntersect(&first, &second, &ccd) ? Outcome::overlap : Outcome::apart;
        const auto penetration = method_ == "epa" ? &ccdGJKPenetration : &ccdMPRPenetration;
        ccd_real_t depth = 0;
        ccd_vec3_t direction, position;
        const int result = penetration(&first, &second, &ccd, &depth, &direction, &position);
        if (result == -1) return Outcome::apart;
        touch.normal = to_vec(direction);
        touch.point = to_vec(position);
        if (result != 0 || !touch.normal.allFinite() || !touch.point.allFinite() ||
            !(std::abs(touch.normal.norm() - 1) < 1e-6))
            return Outcome::failure;
        touch.normal.normalize();
        touch.depth = touch.normal.dot(first.support(touch.normal) - second.support(-touch.normal));
        return touch.depth >= 0 && std::abs(touch.depth - depth) < 0.1 ? Outcome::overlap : Outcome::failure;
    }

    // What the bodies' boxes do.
    Outcome meet_bounds(const World& world, std::uint32_t a, std::uint32_t b, double size, Touch& touch) const {
        const auto placed = [&](std::uint32_t body) {
            return place_volume(volumes_[world.shape[body]], world.position[body],
                                world.orientation[body].toRotationMatrix());
        };
        const auto found = volume_contact(placed(a), placed(b));
        if (!found) return Outcome::apart;
        touch = {found->normal, found->point / size, found->depth / size};
        return Outcome::overlap;
    }

    std::string method_ = "epa";
    double tolerance_ = 1e-6;
    int max_iterations_ = 500;

    std::vector<ShapeVolume> volumes_;  // by shape of the world
    std::vector<Chunk> chunks_;         // of pairs
};

}  // namespace

KOLIZE_PLUGIN(GjkEpa, .name = "gjk_epa",
              .summary = "convex bodies by their support functions, by libccd: GJK with EPA or MPR",
              .source =
                  "Gilbert, Johnson and Keerthi 1988; van den Bergen, Collision Detection in Interactive 3D "
                  "Environments (2004), 4; "
                  "Snethen, XenoCollide, Game Programming Gems 7 (2008); libccd",
              .cost =
                  "A few support points for pairs that are apart; some dozens where polyhedra overlap, hundreds where "
                  "round bodies "
                  "do. A hull's support point is looked for among all its corners.",
              .accuracy =
                  "Overlap up to the tolerance. The depth is exact along the normal, and the normal the one of least "
                  "depth up to the "
                  "tolerance (method mpr: a normal that may be far from it where bodies overlap deeply). Where libccd "
                  "fails, the pair "
                  "is counted among the failures and answered by the bodies' oriented boxes.",
              .choose =
                  "For capsules and hulls with one contact point a pair, or to compare with: it is what many engines "
                  "do. For stacks "
                  "take moller or sat, which give whole manifolds.",
              .capabilities = {.shape_kinds = bit(ShapeKind::sphere) | bit(ShapeKind::box) |
                                              bit(ShapeKind::half_space) | bit(ShapeKind::capsule) |
                                              bit(ShapeKind::hull),
                               .gives = Detail::normal,
                               .allocates = true})
