#include "mesh_pairs_rivals.h"

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <ode/ode.h>

#include <algorithm>
#include <cstdarg>
#include <limits>

namespace bench {

using kolize::Transform;
using kolize::Triangle;
using kolize::TriangleSoup;
using kolize::Vec3;

namespace {

// --- FCL -----------------------------------------------------------------------------------------------------------

template <class Volume>
class FclModel final : public MeshQuery {
public:
    FclModel(const TriangleSoup& surface, const std::string& volume) {
        name = "FCL " + volume;
        std::vector<fcl::Triangle> triangles;
        for (const Triangle& t : surface.triangles) triangles.emplace_back(t[0], t[1], t[2]);
        model_.beginModel(static_cast<int>(triangles.size()), static_cast<int>(surface.vertices.size()));
        model_.addSubModel(surface.vertices, triangles);
        model_.endModel();
    }
    bool overlap(const Transform& copy_to_mesh) override { return collide(copy_to_mesh, 1).numContacts() > 0; }
    void intersect(const Transform& copy_to_mesh, TrianglePairs& pairs) override {
        const fcl::CollisionResultd result = collide(copy_to_mesh, std::numeric_limits<std::size_t>::max());
        for (std::size_t i = 0; i < result.numContacts(); ++i)
            pairs.emplace_back(result.getContact(i).b1, result.getContact(i).b2);
    }

private:
    fcl::CollisionResultd collide(const Transform& copy_to_mesh, std::size_t most) const {
        fcl::Transform3d placement = fcl::Transform3d::Identity();
        placement.linear() = copy_to_mesh.rotation;
        placement.translation() = copy_to_mesh.translation;
        fcl::CollisionResultd result;
        fcl::collide(&model_, fcl::Transform3d::Identity(), &model_, placement, {most, false}, result);
        return result;
    }

    fcl::BVHModel<Volume> model_;
};

// --- Bullet --------------------------------------------------------------------------------------------------------

// Bullet has no way to stop at the first contact. It reports points, several for some triangle pairs.
class GImpact final : public MeshQuery {
    struct Collect final : btManifoldResult {
        using btManifoldResult::btManifoldResult;
        int a = 0, b = 0;
        TrianglePairs pairs;
        void setShapeIdentifiersA(int, int triangle) override { a = triangle; }
        void setShapeIdentifiersB(int, int triangle) override { b = triangle; }
        void addContactPoint(const btVector3&, const btVector3&, btScalar) override { pairs.emplace_back(a, b); }
    };

public:
    explicit GImpact(const TriangleSoup& surface)
        : vertices_(surface.vertices.size()), mesh_(surface, vertices_), shapes_{&mesh_.arrays, &mesh_.arrays} {
        name = "Bullet GImpact";
        btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
        for (int i = 0; i < 2; ++i) {
            shapes_[i].setMargin(0);
            shapes_[i].updateBound();
            objects_[i].setCollisionShape(&shapes_[i]);
        }
    }
    bool overlap(const Transform& copy_to_mesh) override { return !collide(copy_to_mesh).empty(); }
    void intersect(const Transform& copy_to_mesh, TrianglePairs& pairs) override {
        TrianglePairs found = collide(copy_to_mesh);
        std::sort(found.begin(), found.end());
        pairs.insert(pairs.end(), found.begin(), std::unique(found.begin(), found.end()));
    }

private:
    struct Arrays {
        std::vector<int> indices;
        btTriangleIndexVertexArray arrays;
        Arrays(const TriangleSoup& surface, std::vector<btVector3>& vertices) {
            for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = to_bullet(surface.vertices[v]);
            for (const Triangle& t : surface.triangles)
                for (const std::uint32_t v : t) indices.push_back(static_cast<int>(v));
            btIndexedMesh mesh;
            mesh.m_numTriangles = static_cast<int>(surface.triangles.size());
            mesh.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices.data());
            mesh.m_triangleIndexStride = 3 * sizeof(int);
            mesh.m_numVertices = static_cast<int>(vertices.size());
            mesh.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices.data());
            mesh.m_vertexStride = sizeof(btVector3);
            arrays.addIndexedMesh(mesh, PHY_INTEGER);
        }
    };

    static btVector3 to_bullet(const Vec3& p) { return {btScalar(p.x()), btScalar(p.y()), btScalar(p.z())}; }

    TrianglePairs collide(const Transform& copy_to_mesh) {
        const kolize::Mat3& r = copy_to_mesh.rotation;
        const auto at = [&](int row, int column) { return btScalar(r(row, column)); };
        const btMatrix3x3 rotation(at(0, 0), at(0, 1), at(0, 2), at(1, 0), at(1, 1), at(1, 2), at(2, 0), at(2, 1),
                                   at(2, 2));
        objects_[1].setWorldTransform(btTransform(rotation, to_bullet(copy_to_mesh.translation)));
        const auto wrapped = [&](int i) {
            return btCollisionObjectWrapper(nullptr, &shapes_[i], &objects_[i], objects_[i].getWorldTransform(), -1,
                                            -1);
        };
        const btCollisionObjectWrapper a = wrapped(0), b = wrapped(1);
        Collect collect(&a, &b);
        btCollisionAlgorithm* algorithm = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
        algorithm->processCollision(&a, &b, {}, &collect);
        algorithm->~btCollisionAlgorithm();
        dispatcher_.freeCollisionAlgorithm(algorithm);
        return std::move(collect.pairs);
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    std::vector<btVector3> vertices_;
    Arrays mesh_;
    btGImpactMeshShape shapes_[2];
    btCollisionObject objects_[2];
};

// --- ODE -----------------------------------------------------------------------------------------------------------

class OdeTrimesh final : public MeshQuery {
public:
    explicit OdeTrimesh(const TriangleSoup& surface) : contacts_(most) {
        name = "ODE trimesh";
        dInitODE2(0);
        dSetMessageHandler([](int, const char*, va_list) {});  // one for every full bucket of its hash table
        for (const Vec3& p : surface.vertices)                 // ODE wants four numbers a vertex
            vertices_.insert(vertices_.end(), {dReal(p.x()), dReal(p.y()), dReal(p.z()), 0});
        for (const Triangle& t : surface.triangles) indices_.insert(indices_.end(), t.begin(), t.end());
        data_ = dGeomTriMeshDataCreate();
        dGeomTriMeshDataBuildSimple(data_, vertices_.data(), static_cast<int>(surface.vertices.size()), indices_.data(),
                                    static_cast<int>(indices_.size()));
        for (dGeomID& geometry : geometries_) geometry = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
    }
    ~OdeTrimesh() override {
        for (const dGeomID geometry : geometries_) dGeomDestroy(geometry);
        dGeomTriMeshDataDestroy(data_);
        dCloseODE();
    }
    OdeTrimesh(const OdeTrimesh&) = delete;
    OdeTrimesh& operator=(const OdeTrimesh&) = delete;

    bool overlap(const Transform& copy_to_mesh) override { return collide(copy_to_mesh, 1 | CONTACTS_UNIMPORTANT) > 0; }
    void intersect(const Transform& copy_to_mesh, TrianglePairs& pairs) override {
        const int count = collide(copy_to_mesh, most);
        TrianglePairs found;
        for (int i = 0; i < count; ++i) found.emplace_back(contacts_[i].side1, contacts_[i].side2);
        std::sort(found.begin(), found.end());
        pairs.insert(pairs.end(), found.begin(), std::unique(found.begin(), found.end()));
    }

private:
    static constexpr int most = 65535;  // contacts that one call can give

    int collide(const Transform& copy_to_mesh, int flags) {
        dMatrix3 rotation = {};
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                rotation[4 * row + column] = static_cast<dReal>(copy_to_mesh.rotation(row, column));
        const Vec3& t = copy_to_mesh.translation;
        dGeomSetRotation(geometries_[1], rotation);
        dGeomSetPosition(geometries_[1], static_cast<dReal>(t.x()), static_cast<dReal>(t.y()),
                         static_cast<dReal>(t.z()));
        return dCollide(geometries_[0], geometries_[1], flags, contacts_.data(), sizeof(dContactGeom));
    }

    std::vector<dReal> vertices_;
    std::vector<dTriIndex> indices_;
    dTriMeshDataID data_;
    dGeomID geometries_[2];
    std::vector<dContactGeom> contacts_;
};

}  // namespace

std::vector<std::unique_ptr<MeshQuery>> rival_queries(const TriangleSoup& surface) {
    std::vector<std::unique_ptr<MeshQuery>> rivals;
    rivals.push_back(std::make_unique<FclModel<fcl::OBBd>>(surface, "OBB"));
    rivals.push_back(std::make_unique<FclModel<fcl::OBBRSSd>>(surface, "OBBRSS"));
    rivals.push_back(std::make_unique<GImpact>(surface));
    rivals.push_back(std::make_unique<OdeTrimesh>(surface));
    return rivals;
}

}  // namespace bench
