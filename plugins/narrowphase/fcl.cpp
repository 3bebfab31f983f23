// Meshes by the Flexible Collision Library: its OBBRSS hierarchy and its triangle test.
//
// FCL finds the intersecting triangle pairs of two meshes; the contact model makes contacts of them as for every other
// triangle test. Spheres, boxes and half-spaces are handled by the framework.
#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin.h>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include <limits>

namespace {

using namespace kolize;

using Model = fcl::BVHModel<fcl::OBBRSSd>;

std::unique_ptr<Model> make_model(const Mesh& mesh) {
    auto model = std::make_unique<Model>();
    model->beginModel(static_cast<int>(mesh.triangles.size()), static_cast<int>(mesh.vertices.size()));
    std::vector<fcl::Triangle> triangles;
    for (const Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    model->addSubModel(mesh.vertices, triangles);
    model->endModel();
    return model;
}

class Fcl final : public MeshNarrowphase {
public:
    static void parameters(Parameters<Fcl>& p) { mesh_parameters<Fcl>(p); }

    void prepare(const World& world) override {
        MeshNarrowphase::prepare(world);
        models_.clear();
        for (const Shape& shape : world.shapes) models_.push_back(shape.mesh ? make_model(*shape.mesh) : nullptr);
    }

private:
    void intersect_meshes(const MeshPair& pair, TriangleHits& hits) const override {
        fcl::Transform3d b_to_a = fcl::Transform3d::Identity();
        b_to_a.linear() = pair.b_to_a.rotation;
        b_to_a.translation() = pair.b_to_a.translation;
        const std::size_t most = pair.first_only ? 1 : std::numeric_limits<std::size_t>::max();
        const fcl::CollisionRequestd request(most, pair.want_segments);
        fcl::CollisionResultd result;
        fcl::collide(models_[pair.shape_a].get(), fcl::Transform3d::Identity(), models_[pair.shape_b].get(), b_to_a,
                     request, result);
        hits.tests += result.numContacts();  // FCL does not tell how many pairs it tested: a lower bound
        for (std::size_t i = 0; i < result.numContacts(); ++i) add(result.getContact(i), pair.want_segments, hits);
    }

    // With points asked for, FCL reports a triangle pair once for each of its contact points.
    static void add(const fcl::Contactd& contact, bool with_point, TriangleHits& hits) {
        const auto a = static_cast<std::uint32_t>(contact.b1), b = static_cast<std::uint32_t>(contact.b2);
        const Vec3 point = with_point ? Vec3(contact.pos) : Vec3::Zero();
        if (!hits.hits.empty() && hits.hits.back().a == a && hits.hits.back().b == b)
            hits.hits.back().segment.q = point;
        else
            hits.hits.push_back({a, b, {point, point}});
    }

    std::vector<std::unique_ptr<Model>> models_;  // by shape; null where the shape has no mesh
};

}  // namespace

KOLIZE_PLUGIN(
    Fcl, .name = "fcl", .summary = "meshes by the Flexible Collision Library (OBBRSS hierarchy)",
    .source = "Pan, Chitta & Manocha, FCL: A general purpose library for collision and proximity queries, ICRA 2012",
    .cost = "A model is built once for each shape; queries allocate. Debian builds FCL with assertions on.",
    .accuracy =
        "A separating-axis test along eleven axes in double: right in general position, and without an error bound "
        "where triangles touch or nearly do. Its contact points are used by the contact model averaged.",
    .choose = "To compare with, or to check another narrowphase against; moller is exact.",
    .capabilities = {.shape_kinds = all_shape_kinds | bit(ShapeKind::capsule),
                     .time_of_impact = true,
                     .allocates = true,
                     .crossings = true})
