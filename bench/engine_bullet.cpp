// Bullet as its manual and demos set it up: btDiscreteDynamicsWorld, the dynamic tree, the sequential impulse solver
// with ten iterations, default margins, no damping (its default), no sleeping.
#include "engine.h"

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletDynamicsCommon.h>

#include <map>

namespace bench {
namespace {

using kolize::Quat;
using kolize::Shape;
using kolize::ShapeKind;
using kolize::Vec3;
using kolize::World;

btVector3 to_bullet(const Vec3& v) { return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())}; }

btTransform to_bullet(const Quat& q, const Vec3& p) {
    return btTransform(btQuaternion(btScalar(q.x()), btScalar(q.y()), btScalar(q.z()), btScalar(q.w())), to_bullet(p));
}

Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

// The triangles that a mesh shape refers to.
class Triangles {
public:
    explicit Triangles(const kolize::Mesh& mesh) {
        for (const Vec3& v : mesh.vertices) vertices_.push_back(to_bullet(v));
        for (const kolize::Triangle& t : mesh.triangles)
            for (const std::uint32_t index : t) indices_.push_back(static_cast<int>(index));
        btIndexedMesh part;
        part.m_numTriangles = static_cast<int>(mesh.triangles.size());
        part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices_.data());
        part.m_triangleIndexStride = 3 * sizeof(int);
        part.m_numVertices = static_cast<int>(vertices_.size());
        part.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices_.data());
        part.m_vertexStride = sizeof(btVector3);
        interface.addIndexedMesh(part);
    }

    btTriangleIndexVertexArray interface;

private:
    std::vector<btVector3> vertices_;
    std::vector<int> indices_;
};

class BulletEngine final : public Engine {
public:
    BulletEngine(const World& world, double dt, const BulletOptions& options)
        : dt_(static_cast<btScalar>(dt)), options_(options), material_(common_material(world)) {
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
        if (options.elastic) dynamics_.getSolverInfo().m_splitImpulsePenetrationThreshold = BT_LARGE_FLOAT;
        dynamics_.getSolverInfo().m_restitutionVelocityThreshold = 0;  // slow hits bounce too
        dynamics_.setGravity(to_bullet(world.forces.gravity));
        for (std::uint32_t body = 0; body < world.size(); ++body) add(world, body);
    }
    ~BulletEngine() override {
        for (const auto& body : bodies_) dynamics_.removeRigidBody(body.get());
    }

    // No sub-steps: one step of exactly dt.
    void step() override { dynamics_.stepSimulation(dt_, 0); }

    kolize::BodyState state(std::uint32_t body) const override {
        const btRigidBody& b = *bodies_[body];
        const btQuaternion q = b.getWorldTransform().getRotation();
        return {from_bullet(b.getWorldTransform().getOrigin()), Quat(q.w(), q.x(), q.y(), q.z()),
                from_bullet(b.getLinearVelocity()), from_bullet(b.getAngularVelocity())};
    }

    // Manifolds also hold points that are within a margin of touching.
    void add_touching(std::vector<kolize::Pair>& pairs) const override {
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
            const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
            bool overlaps = false;
            for (int k = 0; k < manifold.getNumContacts(); ++k)
                overlaps = overlaps || manifold.getContactPoint(k).getDistance() < 0;
            const auto a = static_cast<std::uint32_t>(manifold.getBody0()->getUserIndex());
            const auto b = static_cast<std::uint32_t>(manifold.getBody1()->getUserIndex());
            if (overlaps) pairs.push_back({std::min(a, b), std::max(a, b)});
        }
    }

private:
    void add(const World& world, std::uint32_t body);
    btCollisionShape& shape(const World& world, std::uint32_t body);
    std::unique_ptr<btCollisionShape> make_shape(const Shape& shape, bool is_static);

    btScalar dt_;
    BulletOptions options_;
    kolize::Material material_;
    std::vector<std::unique_ptr<Triangles>> triangles_;
    std::map<std::pair<std::uint32_t, bool>, std::unique_ptr<btCollisionShape>> shapes_;  // by shape id, static or not
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    btDefaultCollisionConfiguration configuration_;
    mutable btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld dynamics_{&dispatcher_, &broadphase_, &solver_, &configuration_};
};

// Moving triangle meshes are GImpact's; for those at rest Bullet has a quicker kind.
std::unique_ptr<btCollisionShape> BulletEngine::make_shape(const Shape& shape, bool is_static) {
    switch (shape.kind) {
    case ShapeKind::sphere: return std::make_unique<btSphereShape>(btScalar(shape.radius));
    case ShapeKind::box: return std::make_unique<btBoxShape>(to_bullet(shape.half_extents));
    case ShapeKind::half_space: return std::make_unique<btStaticPlaneShape>(to_bullet(shape.normal), btScalar(0));
    case ShapeKind::capsule:
    case ShapeKind::hull:
    case ShapeKind::mesh: break;
    }
    triangles_.push_back(std::make_unique<Triangles>(*shape.mesh));
    if (is_static) return std::make_unique<btBvhTriangleMeshShape>(&triangles_.back()->interface, true);
    auto mesh = std::make_unique<btGImpactMeshShape>(&triangles_.back()->interface);
    mesh->updateBound();
    return mesh;
}

btCollisionShape& BulletEngine::shape(const World& world, std::uint32_t body) {
    const bool is_static = world.is_static[body];
    auto& found = shapes_[{world.shape[body], is_static}];
    if (!found) found = make_shape(world.shape_of(body), is_static);
    return *found;
}

void BulletEngine::add(const World& world, std::uint32_t body) {
    const bool is_static = world.is_static[body];
    const btScalar mass = is_static ? btScalar(0) : btScalar(1 / world.inverse_mass[body]);
    const Vec3 inertia = is_static ? Vec3(Vec3::Zero()) : Vec3(world.inverse_inertia[body].cwiseInverse());
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape(world, body), to_bullet(inertia));
    info.m_startWorldTransform = to_bullet(world.orientation[body], world.position[body]);
    info.m_restitution = btScalar(material_.restitution);
    info.m_friction = btScalar(material_.friction);
    auto& added = *bodies_.emplace_back(std::make_unique<btRigidBody>(info));
    added.setLinearVelocity(to_bullet(world.velocity[body]));
    added.setAngularVelocity(to_bullet(world.angular_velocity[body]));
    if (options_.elastic) added.setContactProcessingThreshold(0);
    added.setActivationState(DISABLE_DEACTIVATION);
    added.setUserIndex(static_cast<int>(body));
    if (options_.swept && !is_static) {  // as in Bullet's CcdPhysicsDemo
        const btScalar inner = btScalar(world.shape_of(body).bounds.half_extents().minCoeff());
        added.setCcdMotionThreshold(inner);
        added.setCcdSweptSphereRadius(btScalar(0.9) * inner);
    }
    dynamics_.addRigidBody(&added);
}

}  // namespace

std::string bullet_version() {
    const int version = btGetVersion();
    return "Bullet " + std::to_string(version / 100) + "." + std::to_string(version % 100) +
           (sizeof(btScalar) == sizeof(float) ? " (float)" : " (double)");
}

std::unique_ptr<Engine> make_bullet(const World& world, double dt, const BulletOptions& options) {
    return std::make_unique<BulletEngine>(world, dt, options);
}

}  // namespace bench
