// ODE as its manual and demos set it up: quickstep with its 20 iterations, sweep and prune, contact joints that bounce,
// nothing disabled automatically.
#include "engine.h"

#include <ode/ode.h>

namespace bench {
namespace {

using kolize::Quat;
using kolize::Shape;
using kolize::ShapeKind;
using kolize::Vec3;
using kolize::World;

// Once per process.
void require_ode() {
    static const bool ready = dInitODE2(0) != 0;
    if (!ready) throw kolize::Error("ODE cannot be initialised");
}

Vec3 from_ode(const dReal* v) { return {v[0], v[1], v[2]}; }

void* tag(std::uint32_t body) { return reinterpret_cast<void*>(static_cast<std::uintptr_t>(body)); }

std::uint32_t body_of(dGeomID geom) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(dGeomGetData(geom)));
}

class OdeEngine final : public Engine {
public:
    OdeEngine(const World& world, double dt, const OdeOptions& options)
        : dt_(dt), contacts_(static_cast<std::size_t>(options.contacts_per_pair)) {
        const Vec3& gravity = world.forces.gravity;
        dWorldSetGravity(dynamics_, gravity.x(), gravity.y(), gravity.z());
        dWorldSetContactMaxCorrectingVel(dynamics_, options.push);
        dRandSetSeed(0);  // quickstep shuffles its rows
        for (dContact& contact : contacts_) contact.surface = surface(common_material(world));
        for (std::uint32_t body = 0; body < world.size(); ++body) add(world, body);
    }
    ~OdeEngine() override {
        dJointGroupDestroy(joints_);
        dSpaceDestroy(space_);
        dWorldDestroy(dynamics_);
        for (const auto& [shape, data] : meshes_) dGeomTriMeshDataDestroy(data);
    }
    OdeEngine(const OdeEngine&) = delete;
    OdeEngine& operator=(const OdeEngine&) = delete;

    void step() override {
        touching_.clear();
        dSpaceCollide(space_, this, near_callback);
        dWorldQuickStep(dynamics_, dt_);
        dJointGroupEmpty(joints_);
    }

    kolize::BodyState state(std::uint32_t body) const override {
        const dBodyID b = bodies_[body];
        const dReal* q = dBodyGetQuaternion(b);
        return {from_ode(dBodyGetPosition(b)), Quat(q[0], q[1], q[2], q[3]), from_ode(dBodyGetLinearVel(b)),
                from_ode(dBodyGetAngularVel(b))};
    }

    void add_touching(std::vector<kolize::Pair>& pairs) const override {
        pairs.insert(pairs.end(), touching_.begin(), touching_.end());
    }

private:
    static dSurfaceParameters surface(const kolize::Material& material) {
        dSurfaceParameters surface{};
        surface.mode = dContactBounce | dContactApprox1;
        surface.mu = material.friction;
        surface.bounce = material.restitution;
        surface.bounce_vel = 0;
        return surface;
    }
    static void near_callback(void* engine, dGeomID a, dGeomID b) { static_cast<OdeEngine*>(engine)->collide(a, b); }
    void collide(dGeomID a, dGeomID b);
    void add(const World& world, std::uint32_t body);
    dGeomID make_geom(const World& world, std::uint32_t body);
    dTriMeshDataID mesh_data(const Shape& shape);

    double dt_;
    std::vector<dContact> contacts_;  // of the pair at hand
    dWorldID dynamics_ = dWorldCreate();
    dSpaceID space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY);
    dJointGroupID joints_ = dJointGroupCreate(0);
    std::vector<dBodyID> bodies_;  // null for a static body
    std::vector<std::pair<std::shared_ptr<const kolize::Mesh>, dTriMeshDataID>> meshes_;
    std::vector<kolize::Pair> touching_;
};

void OdeEngine::collide(dGeomID a, dGeomID b) {
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (!body_a && !body_b) return;
    const int count = dCollide(a, b, static_cast<int>(contacts_.size()), &contacts_[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i)
        dJointAttach(dJointCreateContact(dynamics_, joints_, &contacts_[static_cast<std::size_t>(i)]), body_a, body_b);
    const auto [low, high] = std::minmax({body_of(a), body_of(b)});
    if (count > 0) touching_.push_back({low, high});
}

// ODE reads vertices and triangles where kolize has them.
dTriMeshDataID OdeEngine::mesh_data(const Shape& shape) {
    for (const auto& [mesh, data] : meshes_)
        if (mesh == shape.mesh) return data;
    const kolize::Mesh& mesh = *shape.mesh;
    const dTriMeshDataID data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(data, mesh.vertices.data(), sizeof(Vec3), static_cast<int>(mesh.vertices.size()),
                                mesh.triangles.data(), static_cast<int>(3 * mesh.triangles.size()),
                                sizeof(kolize::Triangle));
    meshes_.emplace_back(shape.mesh, data);
    return data;
}

dGeomID OdeEngine::make_geom(const World& world, std::uint32_t body) {
    const Shape& shape = world.shape_of(body);
    const Vec3 sides = 2 * shape.half_extents;
    switch (shape.kind) {
    case ShapeKind::sphere: return dCreateSphere(space_, shape.radius);
    case ShapeKind::box: return dCreateBox(space_, sides.x(), sides.y(), sides.z());
    case ShapeKind::mesh: return dCreateTriMesh(space_, mesh_data(shape), nullptr, nullptr, nullptr);
    case ShapeKind::capsule:
    case ShapeKind::hull:
    case ShapeKind::half_space: break;
    }
    const Vec3 normal = world.orientation[body] * shape.normal;
    return dCreatePlane(space_, normal.x(), normal.y(), normal.z(), normal.dot(world.position[body]));
}

void OdeEngine::add(const World& world, std::uint32_t body) {
    const Vec3 &p = world.position[body], &v = world.velocity[body], &w = world.angular_velocity[body];
    const Quat& q = world.orientation[body];
    const dQuaternion rotation = {q.w(), q.x(), q.y(), q.z()};
    const dGeomID geom = make_geom(world, body);
    dGeomSetData(geom, tag(body));
    bodies_.push_back(nullptr);
    if (world.is_static[body]) {
        if (world.shape_of(body).kind == ShapeKind::half_space) return;  // has its place already
        dGeomSetPosition(geom, p.x(), p.y(), p.z());
        dGeomSetQuaternion(geom, rotation);
        return;
    }
    const dBodyID b = bodies_.back() = dBodyCreate(dynamics_);
    const Vec3 inertia = world.inverse_inertia[body].cwiseInverse();
    dMass mass;
    dMassSetParameters(&mass, 1 / world.inverse_mass[body], 0, 0, 0, inertia.x(), inertia.y(), inertia.z(), 0, 0, 0);
    dBodySetMass(b, &mass);
    dBodySetPosition(b, p.x(), p.y(), p.z());
    dBodySetQuaternion(b, rotation);
    dBodySetLinearVel(b, v.x(), v.y(), v.z());
    dBodySetAngularVel(b, w.x(), w.y(), w.z());
    dGeomSetBody(geom, b);
}

}  // namespace

std::string ode_version() { return "ODE " dODE_VERSION + std::string(sizeof(dReal) == 8 ? " (double)" : " (float)"); }

std::unique_ptr<Engine> make_ode(const World& world, double dt, const OdeOptions& options) {
    require_ode();
    return std::make_unique<OdeEngine>(world, dt, options);
}

}  // namespace bench
