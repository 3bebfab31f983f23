// Convex bodies by their support functions: the farthest point in a direction is all that is asked of a body.
//
// Round bodies are a core, a point or a segment, and a radius around it. GJK finds the distance of the two cores; where
// it is less than the radii, that is the contact. Where polyhedra overlap, libccd finds the normal, by EPA or MPR, and
// the depth is what the support functions say along it; a core inside a polyhedron has few ways out, and all are tried.
// The contact point is where the two would touch,
// were they moved apart along the normal.
//
// Everything is computed in the frame of the first body and in units of the pair's size, so that turning, moving and
// scaling the two changes nothing; and which one is the first is decided by where they stand and not by their numbers.
// Half-spaces need no search: the deepest point is the support against their normal.
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

// A shape where its body stands, in the frame of the first body and in units of the pair's size.
struct Solid {
    const Shape* shape;
    const ShapeVolume* bounds;
    Mat3 rotation;
    Vec3 position;
    double scale;          // units a metre
    bool is_core = false;  // without the radius of a round body

    double radius() const {
        if (shape->kind == ShapeKind::sphere) return scale * shape->radius;
        return shape->kind == ShapeKind::capsule ? scale * shape->cap_radius : 0;
    }
    Vec3 support(const Vec3& direction) const {
        const Vec3 core = position + rotation * (scale * farthest(rotation.transpose() * direction));
        const double length = direction.norm();
        return is_core || length == 0 ? core : Vec3(core + radius() / length * direction);
    }

private:
    // Of the core, in the body frame, m.
    Vec3 farthest(const Vec3& d) const {
        switch (shape->kind) {
        case ShapeKind::sphere: return Vec3::Zero();
        case ShapeKind::capsule: return {0, std::copysign(shape->half_height, d.y()), 0};
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

// The points of two solids that are nearest to each other.
struct Nearest {
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    Vec3 between() const { return b - a; }
};

// Gilbert, Johnson, Keerthi (1988): up to four points of the difference of the two, that which they span being ever
// nearer to the origin.
class Gjk {
public:
    // False if the two overlap, or are nearer than `least`.
    bool separate(const Solid& a, const Solid& b, double least, int max_iterations, Nearest& nearest) {
        count_ = 0;
        add(a, b, b.position - a.position);
        for (int i = 0; i < max_iterations; ++i) {
            if (!shrink()) return false;
            const Vec3 v = nearest_.between();
            if (v.norm() <= least) return false;
            const Vec3 from_a = a.support(v), from_b = b.support(-v);
            constexpr double enough = 1e-14;
            if (v.squaredNorm() - v.dot(from_b - from_a) <= enough * v.squaredNorm() || has(from_a, from_b)) break;
            points_[count_++] = {from_a, from_b};
        }
        nearest = nearest_;
        return true;
    }

private:
    void add(const Solid& a, const Solid& b, const Vec3& direction) {
        points_[count_++] = {a.support(direction), b.support(-direction)};
    }
    bool has(const Vec3& a, const Vec3& b) const {
        for (int i = 0; i < count_; ++i)
            if (points_[i].a == a && points_[i].b == b) return true;
        return false;
    }

    // Keeps the fewest points that span what is nearest to the origin. False if that is the origin.
    bool shrink() {
        double best = infinity;
        unsigned kept = 0;
        double weights[4];
        for (unsigned subset = 1; subset < 1u << count_; ++subset) {
            double w[4];
            if (!weigh(subset, w)) continue;
            Vec3 place = Vec3::Zero();
            for (int i = 0; i < count_; ++i) place += w[i] * points_[i].between();
            if (!(place.squaredNorm() < best * (1 - 1e-15))) continue;
            best = place.squaredNorm();
            kept = subset;
            std::copy(w, w + 4, weights);
        }
        if (kept == 0 || kept == 0b1111) return false;
        nearest_ = {};
        int left = 0;
        for (int i = 0; i < count_; ++i) {
            if (!(kept >> i & 1)) continue;
            nearest_.a += weights[i] * points_[i].a;
            nearest_.b += weights[i] * points_[i].b;
            points_[left++] = points_[i];
        }
        count_ = left;
        return true;
    }

    // Weights of the point nearest to the origin in what a subset of the points spans; false if it is not between them.
    bool weigh(unsigned subset, double (&w)[4]) const {
        int chosen[4], n = 0;
        for (int i = 0; i < count_; ++i) {
            w[i] = 0;
            if (subset >> i & 1) chosen[n++] = i;
        }
        const Vec3 origin = points_[chosen[0]].between();
        Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, n - 1);
        for (int k = 1; k < n; ++k) edges.col(k - 1) = points_[chosen[k]].between() - origin;
        Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> part(n - 1);
        if (n > 1) {
            const auto qr = edges.colPivHouseholderQr();
            if (qr.rank() < n - 1) return false;
            part = qr.solve(-origin);
        }
        w[chosen[0]] = 1 - part.sum();
        for (int k = 1; k < n; ++k) w[chosen[k]] = part[k - 1];
        for (int k = 0; k < n; ++k)
            if (!(w[chosen[k]] >= 0)) return false;
        return true;
    }

    int count_ = 0;
    Nearest points_[5];
    Nearest nearest_;
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

// In the frame and the units of the solids.
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
        const Mat3 frame = world.orientation[a].toRotationMatrix();
        const Solid first{&world.shape_of(a), &volumes_[world.shape[a]], Mat3::Identity(), Vec3::Zero(), 1 / size};
        const Solid second{&world.shape_of(b), &volumes_[world.shape[b]],
                           (world.orientation[a].conjugate() * world.orientation[b]).toRotationMatrix(),
                           frame.transpose() * between / size, 1 / size};
        if (!second.position.allFinite()) return;  // farther apart than numbers reach
        Touch touch;
        Outcome outcome = meet(first, second, touch);
        if (outcome == Outcome::failure) {
            ++chunk.failures;
            outcome = meet_bounds(first, second, touch);
        }
        if (outcome == Outcome::apart) return;
        Contact& row = chunk.rows.emplace_back();
        row.a = pair.a;
        row.b = pair.b;
        if (detail == Detail::overlap) return;
        const Vec3 normal = frame * touch.normal;
        row.normal = swapped ? Vec3(-normal) : normal;
        row.depth = size * touch.depth;
        const Vec3 from_a = size * (frame * touch.point), from_b = from_a - between;
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

    Outcome meet(const Solid& first, const Solid& second, Touch& touch) const {
        if (second.shape->kind == ShapeKind::half_space) {
            touch.normal = -(second.rotation * second.shape->normal);
            touch.point = first.support(touch.normal);
            touch.depth = touch.normal.dot(touch.point - second.position);
            touch.point -= 0.5 * touch.depth * touch.normal;
            return touch.depth > 0 ? Outcome::overlap : Outcome::apart;
        }
        Solid a = first, b = second;
        a.is_core = b.is_core = true;
        const double radii = a.radius() + b.radius();
        constexpr double least = 1e-10;  // nearer than that a normal is not to be had from the distance
        Nearest nearest;
        if (Gjk().separate(a, b, least, max_iterations_, nearest)) {
            const double distance = nearest.between().norm();
            touch.depth = radii - distance;
            touch.normal = nearest.between() / distance;
            touch.point = nearest.a + (a.radius() - 0.5 * touch.depth) * touch.normal;
            return touch.depth > 0 ? Outcome::overlap : Outcome::apart;
        }
        if (a.radius() > 0 && second.shape->mesh) return lead_out(a, second, first, second, touch);
        if (b.radius() > 0 && first.shape->mesh) return lead_out(b, first, first, second, touch);
        // The difference of two points or segments has no inside.
        const bool solid = first.radius() == 0 || second.radius() == 0;
        return penetrate(solid ? a : first, solid ? b : second, first, second, touch);
    }

    // A core inside a polyhedron: the least depth is along a face's normal, or across a segment and an edge.
    Outcome lead_out(const Solid& core, const Solid& polyhedron, const Solid& first, const Solid& second,
                     Touch& touch) const {
        const Mesh& mesh = *polyhedron.shape->mesh;
        touch.depth = infinity;
        const auto consider = [&](const Vec3& normal) {
            const double depth = normal.dot(first.support(normal) - second.support(-normal));
            if (depth < touch.depth) touch.depth = depth, touch.normal = normal;
        };
        for (const Vec3& outward : mesh.normals) {
            const Vec3 normal = polyhedron.rotation * outward;
            consider(&polyhedron == &first ? normal : Vec3(-normal));
        }
        const Vec3 axis = core.rotation * Vec3(0, core.shape->half_height, 0);
        for (const Edge& edge : mesh.edges) {
            const Vec3 along = polyhedron.rotation * (mesh.vertices[edge.v1] - mesh.vertices[edge.v0]);
            const Vec3 across = axis.cross(along);
            if (!(across.norm() > 1e-9 * axis.norm() * along.norm())) continue;
            for (const double sign : {1.0, -1.0}) consider(sign * across.normalized());
        }
        return put_point(first, second, touch) ? Outcome::overlap : Outcome::failure;
    }

    // In the middle of the overlap, where the bodies would touch if they were led apart along the normal.
    bool put_point(const Solid& first, const Solid& second, Touch& touch) const {
        Solid moved = second;
        constexpr double gap = 0.1;
        moved.position += (touch.depth + gap) * touch.normal;
        Nearest nearest;
        if (!Gjk().separate(first, moved, 0, max_iterations_, nearest)) return false;
        touch.point = nearest.a - 0.5 * touch.depth * touch.normal;
        return true;
    }

    Outcome penetrate(const Solid& a, const Solid& b, const Solid& first, const Solid& second, Touch& touch) const {
        ccd_t ccd;
        CCD_INIT(&ccd);
        ccd.support1 = ccd.support2 = &support_of;
        ccd.center1 = ccd.center2 = &center_of;
        ccd.max_iterations = static_cast<unsigned long>(max_iterations_);
        ccd.epa_tolerance = ccd.mpr_tolerance = tolerance_;
        ccd_real_t depth = 0;
        ccd_vec3_t direction, position;
        const int result =
            (method_ == "epa" ? &ccdGJKPenetration : &ccdMPRPenetration)(&a, &b, &ccd, &depth, &direction, &position);
        touch.normal = to_vec(direction);
        if (result == -1) return Outcome::apart;
        if (result != 0 || !touch.normal.allFinite() || !(std::abs(touch.normal.norm() - 1) < 1e-6))
            return Outcome::failure;
        touch.normal.normalize();
        touch.depth = touch.normal.dot(first.support(touch.normal) - second.support(-touch.normal));
        if (std::abs(touch.depth) < 1e-12) return Outcome::apart;  // they touch
        // EPA's depth is that of the plane it has found, or it has found none.
        const double round = a.is_core ? first.radius() + second.radius() : 0;
        if (!(touch.depth > 0) || (method_ == "epa" && !(std::abs(touch.depth - depth - round) < 1e-3)))
            return Outcome::failure;
        return put_point(first, second, touch) ? Outcome::overlap : Outcome::failure;
    }

    // What the bodies' boxes do.
    Outcome meet_bounds(const Solid& first, const Solid& second, Touch& touch) const {
        const auto placed = [&](const Solid& solid) {
            return place_volume(*solid.bounds, solid.position / solid.scale, solid.rotation);
        };
        const auto found = volume_contact(placed(first), placed(second));
        if (!found || !(found->depth > 0)) return Outcome::apart;
        touch = {found->normal, first.scale * found->point, first.scale * found->depth};
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
                  "Distances of round bodies' cores are exact to rounding. The depth of polyhedra is exact along the "
                  "normal; libccd's "
                  "EPA finds the normal of least depth but in about one pair of boxes in a hundred, where it is up to "
                  "a few percent "
                  "deeper, and MPR's may be far from it where bodies overlap deeply. Where libccd fails, the pair is "
                  "counted among "
                  "the failures and answered by the bodies' oriented boxes.",
              .choose =
                  "For capsules and hulls with one contact point a pair, or to compare with: it is what many engines "
                  "do. For stacks "
                  "take moller or sat, which give whole manifolds.",
              .capabilities = {.shape_kinds = bit(ShapeKind::sphere) | bit(ShapeKind::box) |
                                              bit(ShapeKind::half_space) | bit(ShapeKind::capsule) |
                                              bit(ShapeKind::hull),
                               .gives = Detail::normal,
                               .allocates = true})
