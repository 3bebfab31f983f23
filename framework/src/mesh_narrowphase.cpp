#include <kolize/mesh_narrowphase.h>

#include "capsule_contacts.h"
#include "contact_model/contact_model.h"
#include "contact_model/containment.h"
#include "mesh_contacts.h"
#include "primitive_contacts.h"
#include "sweep/workspace.h"
#include "volume_hierarchies.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace kolize {

namespace {

constexpr std::size_t max_chunks = 32;  // workspaces exist for all of them, so that warm steps allocate nothing
constexpr std::size_t min_grain = 4;    // pairs; less is not worth a task

std::size_t grain_for(std::size_t pairs) { return std::max(min_grain, (pairs + max_chunks - 1) / max_chunks); }

void require_finite_pose(const World& world, std::uint32_t body) {
    if (!world.position[body].allFinite() || !world.orientation[body].coeffs().allFinite())
        throw std::invalid_argument("body " + std::to_string(body) + " has a pose that is not finite");
}

void rotate(ContactRegion& region, const Mat3& rotation) {
    region.normal = rotation * region.normal;
    region.center = rotation * region.center;
    for (int i = 0; i < region.count; ++i) region.points[i] = rotation * region.points[i];
}

// One region in place of several: what a model that knows no regions makes of them.
void merge(Regions& regions) {
    if (regions.size() < 2) return;
    Vec3 normal = Vec3::Zero(), center = Vec3::Zero();
    double depth = 0;
    for (const ContactRegion& r : regions) {
        normal += r.normal;
        center += r.center;
        depth = std::max(depth, r.depth);
    }
    const double norm = normal.norm();
    const Vec3 direction = norm > 1e-9 ? Vec3(normal / norm) : regions.front().normal;
    const ContactRegion merged = ContactRegion::single(direction, center / static_cast<double>(regions.size()), depth);
    regions.assign(1, merged);
}

}  // namespace

// What one chunk of pairs works with; its rows are joined in chunk order.
struct MeshNarrowphase::Workspace {
    TriangleHits triangles;
    ContourScratch contour;
    MeshScratch mesh;
    Regions regions;
    Contacts contacts;
};

// Finds the regions of one pair of bodies. Lives for one chunk.
class PairCollider {
public:
    PairCollider(const MeshNarrowphase& owner, const World& world, MeshNarrowphase::Workspace& workspace)
        : owner_(owner), world_(world), work_(workspace), averaged_(owner.contact == "averaged") {}

    void collide(const Pair& pair, Detail detail) {
        require_finite_pose(world_, pair.a);
        require_finite_pose(world_, pair.b);
        work_.regions.clear();
        detail_ = detail;
        const bool in_order = world_.shape_of(pair.a).kind <= world_.shape_of(pair.b).kind;
        if (in_order) {
            collide_ordered(pair.a, pair.b);
        } else {
            collide_ordered(pair.b, pair.a);
            swap_regions(pair.b, pair.a);
        }
        if (averaged_) merge(work_.regions);
        emit(pair);
    }

    // The curves along which the surfaces of two closed meshes cross; a box is one too.
    void cross(const Pair& bodies, std::vector<CrossingLine>& lines) {
        const Shape &first = world_.shape_of(bodies.a), &second = world_.shape_of(bodies.b);
        if (!first.mesh || !second.mesh || !first.mesh->closed || !second.mesh->closed) return;
        require_finite_pose(world_, bodies.a);
        require_finite_pose(world_, bodies.b);
        const MeshPair pair = mesh_pair(bodies.a, bodies.b);
        find_hits(pair);
        work_.regions.clear();
        contour_regions(pair, work_.triangles.hits, work_.contour, work_.regions);
        const Transform to_world = world_.pose(bodies.a);
        std::vector<std::uint32_t> loops;  // first segments, in the order of their numbers
        for (const ContourSegment& s : work_.contour.segments) {
            const auto known = std::find(loops.begin(), loops.end(), s.loop);
            lines.push_back({bodies, static_cast<std::uint32_t>(known - loops.begin()), to_world * s.from.point,
                             to_world * s.to.point});
            if (known == loops.end()) loops.push_back(s.loop);
        }
    }

private:
    // Shape kinds ascending: sphere, box, half-space, mesh, capsule, hull. Regions: world axes about the centre of `a`.
    void collide_ordered(std::uint32_t a, std::uint32_t b) {
        const Shape &first = world_.shape_of(a), &second = world_.shape_of(b);
        const Vec3 offset = world_.position[b] - world_.position[a];
        const auto rotation = [&](std::uint32_t body) { return world_.orientation[body].toRotationMatrix(); };
        Regions& regions = work_.regions;
        switch (second.kind) {
        case ShapeKind::sphere: return sphere_sphere(first.radius, second.radius, offset, regions);
        case ShapeKind::box:
            if (first.kind == ShapeKind::sphere)
                return sphere_box(first.radius, second.half_extents, rotation(b), offset, regions);
            return box_box(first.half_extents, rotation(a), second.half_extents, rotation(b), offset, regions);
        case ShapeKind::half_space: {
            const Vec3 normal = world_.orientation[b] * second.normal;
            if (first.kind == ShapeKind::sphere) return sphere_half_space(first.radius, normal, offset, regions);
            if (first.kind == ShapeKind::box)
                return box_half_space(first.half_extents, rotation(a), normal, offset, regions);
            return;
        }
        case ShapeKind::capsule: return collide_with_capsule(a, b);
        case ShapeKind::hull:
        case ShapeKind::mesh:
            if (first.kind == ShapeKind::capsule) return collide_capsule_mesh(a, b);
            if (first.kind == ShapeKind::sphere) return collide_sphere_mesh(a, b);
            if (first.kind == ShapeKind::half_space) return collide_half_space_mesh(a, b);
            return collide_meshes(a, b);
        }
    }

    void collide_with_capsule(std::uint32_t a, std::uint32_t capsule) {
        const Shape &first = world_.shape_of(a), &second = world_.shape_of(capsule);
        const Vec3 offset = world_.position[capsule] - world_.position[a];
        const Segment core = capsule_core(second, offset, world_.orientation[capsule]);
        if (first.kind == ShapeKind::sphere)
            return sphere_capsule(first.radius, core, second.cap_radius, work_.regions);
        if (first.kind == ShapeKind::capsule)
            return capsule_capsule(capsule_core(first, Vec3::Zero(), world_.orientation[a]), first.cap_radius, core,
                                   second.cap_radius, work_.regions);
        if (first.kind == ShapeKind::half_space) {
            const Vec3 normal = world_.orientation[a] * first.normal;
            capsule_half_space(capsule_core(second, Vec3::Zero(), world_.orientation[capsule]), second.cap_radius,
                               normal, -normal.dot(offset), work_.regions);
        } else {
            collide_capsule_mesh(capsule, a);
        }
        swap_regions(capsule, a);
    }

    // A box is its twelve triangles.
    void collide_capsule_mesh(std::uint32_t capsule, std::uint32_t mesh) {
        const Quat to_mesh = world_.orientation[mesh].conjugate();
        const Segment core =
            capsule_core(world_.shape_of(capsule), to_mesh * (world_.position[capsule] - world_.position[mesh]),
                         to_mesh * world_.orientation[capsule]);
        mesh_capsule(*world_.shape_of(mesh).mesh, core, world_.shape_of(capsule).cap_radius, work_.mesh, work_.regions);
        rotate_all(world_.orientation[mesh].toRotationMatrix());
        swap_regions(mesh, capsule);
    }

    void collide_sphere_mesh(std::uint32_t sphere, std::uint32_t mesh) {
        const Mat3 rotation = world_.orientation[mesh].toRotationMatrix();
        const Vec3 center = rotation.transpose() * (world_.position[sphere] - world_.position[mesh]);
        mesh_sphere(*world_.shape_of(mesh).mesh, center, world_.shape_of(sphere).radius, work_.mesh, work_.regions);
        rotate_all(rotation);
        swap_regions(mesh, sphere);
    }

    void collide_half_space_mesh(std::uint32_t half_space, std::uint32_t mesh) {
        const Mat3 rotation = world_.orientation[mesh].toRotationMatrix();
        const Vec3 world_normal = world_.orientation[half_space] * world_.shape_of(half_space).normal;
        const double offset = world_normal.dot(world_.position[half_space] - world_.position[mesh]);
        mesh_half_space(*world_.shape_of(mesh).mesh, rotation.transpose() * world_normal, offset, work_.mesh,
                        work_.regions);
        rotate_all(rotation);
        swap_regions(mesh, half_space);
    }

    void collide_meshes(std::uint32_t a, std::uint32_t b) {
        MeshPair pair = mesh_pair(a, b);
        pair.first_only = detail_ == Detail::overlap;
        pair.want_segments = averaged_ && !pair.first_only;

        find_hits(pair);
        if (pair.first_only)
            find_overlap(pair);
        else
            find_regions(pair, a, b);
        rotate_all(world_.orientation[a].toRotationMatrix());
    }

    MeshPair mesh_pair(std::uint32_t a, std::uint32_t b) const {
        const Mat3 rotation = world_.orientation[a].toRotationMatrix();
        MeshPair pair{*world_.shape_of(a).mesh, *world_.shape_of(b).mesh, {}};
        pair.b_to_a.rotation = rotation.transpose() * world_.orientation[b].toRotationMatrix();
        pair.b_to_a.translation = rotation.transpose() * (world_.position[b] - world_.position[a]);
        pair.shape_a = world_.shape[a];
        pair.shape_b = world_.shape[b];
        return pair;
    }

    // In canonical order, each pair once.
    void find_hits(const MeshPair& pair) {
        auto& found = work_.triangles;
        found.clear();
        owner_.intersect_meshes(pair, found);
        work_.contacts.triangle_tests += found.tests;
        work_.contacts.triangle_hits += found.hits.size();
        const auto ids = [](const TriangleHit& hit) { return std::tie(hit.a, hit.b); };
        std::sort(found.hits.begin(), found.hits.end(),
                  [&](const TriangleHit& x, const TriangleHit& y) { return ids(x) < ids(y); });
        const auto end = std::unique(found.hits.begin(), found.hits.end(),
                                     [&](const TriangleHit& x, const TriangleHit& y) { return ids(x) == ids(y); });
        found.hits.erase(end, found.hits.end());
    }

    // The first hit decides, unless it is a mere touch that the contact model does not count.
    void find_overlap(MeshPair pair) {
        const auto& hits = work_.triangles.hits;
        bool overlap = !hits.empty() && (averaged_ || surfaces_cross(pair, hits));
        if (!overlap && !hits.empty()) {
            pair.first_only = false;
            find_hits(pair);
            overlap = surfaces_cross(pair, hits);
        }
        if (overlap || contained_region(pair, work_.mesh)) work_.regions.push_back(ContactRegion{});
    }

    void find_regions(const MeshPair& pair, std::uint32_t a, std::uint32_t b) {
        const auto& hits = work_.triangles.hits;
        if (averaged_)
            averaged_region(pair, hits, world_.is_static[a], world_.is_static[b], work_.contour, work_.regions);
        else
            contour_regions(pair, hits, work_.contour, work_.regions);
        if (!work_.regions.empty()) return;
        if (const auto region = contained_region(pair, work_.mesh)) work_.regions.push_back(*region);
    }

    void rotate_all(const Mat3& rotation) {
        for (ContactRegion& region : work_.regions) rotate(region, rotation);
    }

    // From regions about `from` to regions about `to`, which becomes body A.
    void swap_regions(std::uint32_t from, std::uint32_t to) {
        const Vec3 offset = world_.position[to] - world_.position[from];
        for (ContactRegion& region : work_.regions) region = swapped(region, offset);
    }

    void emit(const Pair& pair) {
        Contact contact;
        contact.a = pair.a;
        contact.b = pair.b;
        auto& rows = work_.contacts.rows;
        if (detail_ == Detail::overlap) {
            if (!work_.regions.empty()) rows.push_back(contact);
            return;
        }
        const Vec3 offset = world_.position[pair.b] - world_.position[pair.a];
        for (const ContactRegion& region : work_.regions) {
            const auto add = [&](const Vec3& point, double depth) {
                contact.normal = region.normal;
                contact.arm_a = point;
                contact.arm_b = point - offset;
                contact.depth = depth;
                rows.push_back(contact);
            };
            if (detail_ == Detail::normal)
                add(region.center, region.depth);
            else
                for (int i = 0; i < region.count; ++i) add(region.points[i], region.depths[i]);
            ++contact.region;
        }
    }

    const MeshNarrowphase& owner_;
    const World& world_;
    MeshNarrowphase::Workspace& work_;
    bool averaged_;
    Detail detail_ = Detail::overlap;
};

MeshNarrowphase::MeshNarrowphase() = default;
MeshNarrowphase::~MeshNarrowphase() = default;

Detail MeshNarrowphase::gives() const { return contact == "averaged" ? Detail::normal : Detail::manifold; }

void MeshNarrowphase::attach(Host& host) {
    Narrowphase::attach(host);
    workspaces_.clear();
    sweeps_.clear();
    for (std::size_t i = 0; i < max_chunks; ++i) {
        workspaces_.push_back(std::make_unique<Workspace>());
        sweeps_.push_back(std::make_unique<SweepWorkspace>());
    }
}

// Sizes every workspace for the largest mesh, so that which pair comes to which chunk costs no allocation later.
void MeshNarrowphase::prepare(const World& world) {
    std::size_t vertices = 0, edges = 0, triangles = 0;
    for (const Shape& shape : world.shapes)
        if (shape.mesh) {
            vertices = std::max(vertices, shape.mesh->vertices.size());
            edges = std::max(edges, shape.mesh->edges.size());
            triangles = std::max(triangles, shape.mesh->triangles.size());
        }
    volumes_.reset();
    if (hierarchy != "aabb") volumes_ = std::make_unique<VolumeHierarchies>(volume_kind(hierarchy), world);
    for (const auto& work : workspaces_) {
        work->contour.reserve(vertices, edges, triangles);
        work->triangles.hits.reserve(512);
        work->mesh.candidates.reserve(triangles);
        work->mesh.parent.reserve(vertices);
        work->mesh.points.reserve(vertices);
        work->mesh.triangles.reserve(triangles);
        work->mesh.edges.reserve(3 * triangles);
        work->mesh.vertices.reserve(3 * triangles);
        work->mesh.crossings.reserve(triangles);
        work->mesh.regions.reserve(64);
        work->regions.reserve(64);
        work->contacts.rows.reserve(256);
    }
}

void MeshNarrowphase::find_contacts(const NarrowphaseInput& input, Contacts& contacts) {
    const std::size_t count = input.pairs.size(), grain = grain_for(count);
    host().parallel_for(count, grain, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        Workspace& work = *workspaces_[chunk];
        work.contacts.clear();
        PairCollider collider(*this, input.world, work);
        for (std::size_t i = begin; i < end; ++i) collider.collide(input.pairs[i], input.detail[i]);
    });
    for (std::size_t chunk = 0; chunk < Host::chunk_count(count, grain); ++chunk) {
        const Contacts& part = workspaces_[chunk]->contacts;
        contacts.rows.insert(contacts.rows.end(), part.rows.begin(), part.rows.end());
        contacts.triangle_tests += part.triangle_tests;
        contacts.triangle_hits += part.triangle_hits;
    }
}

void MeshNarrowphase::find_crossings(const NarrowphaseInput& input, std::vector<CrossingLine>& crossings) {
    PairCollider collider(*this, input.world, *workspaces_.front());
    for (const Pair& pair : input.pairs) collider.cross(pair, crossings);
}

}  // namespace kolize
