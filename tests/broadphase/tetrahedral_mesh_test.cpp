// The mesh behind broadphase tetrahedral: that it is one, whatever points it joins, and what is found in it.
#include "../../plugins/broadphase/tetrahedral_mesh.h"

#include <catch2/catch.hpp>

#include <functional>
#include <random>
#include <set>

using namespace kolize;

namespace {

using Tetrahedron = TetrahedralMesh::Tetrahedron;
constexpr std::uint64_t seed = 3;

class Random {
public:
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    Vec3 point(double side) { return {between(-side, side), between(-side, side), between(-side, side)}; }

private:
    std::mt19937_64 engine_{seed};
};

struct Kind {
    const char* name;
    std::function<Vec3(Random&, int)> make;
};

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> kinds{
        {"anywhere", [](Random& r, int) -> Vec3 { return r.point(0.5); }},
        {"a lattice, in its order", [](Random&, int i) -> Vec3 { return Vec3(i % 7, i / 7 % 7, i / 49) / 16; }},
        {"a plane", [](Random& r, int) -> Vec3 { return r.point(0.5).cwiseProduct(Vec3(1, 1, 0)); }},
        {"a slanting plane",
         [](Random& r, int) -> Vec3 {
             const Vec3 p = TetrahedralMesh::snapped(r.point(0.25));
             return Vec3(p.x(), p.y(), p.x() + p.y());
         }},
        {"the cube's diagonal", [](Random& r, int) -> Vec3 { return Vec3::Constant(r.between(-0.5, 0.5)); }},
        {"a sphere", [](Random& r, int) -> Vec3 { return 0.5 * r.point(1).normalized(); }},
        {"nearly one place", [](Random& r, int) -> Vec3 { return r.point(0x1p-20); }},
        {"sizes over six decades",
         [](Random& r, int) -> Vec3 { return std::pow(10, r.between(-6, 0)) * r.point(0.5); }},
    };
    return kinds;
}

std::vector<Vec3> make_points(const Kind& kind, int count, Random& random) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const Vec3 p = TetrahedralMesh::snapped(kind.make(random, i));
        if (std::find(points.begin(), points.end(), p) == points.end()) points.push_back(p);
    }
    return points;
}

// By definition, exactly: on the inner side of all faces, or on them.
bool holds(const TetrahedralMesh& mesh, const Tetrahedron& t, const Vec3& p) {
    for (int k = 0; k < 4; ++k) {
        Vec3 corners[4];
        for (int l = 0; l < 4; ++l) corners[l] = l == k ? p : mesh.points()[t.corners[l]];
        if (orient3d(corners[0], corners[1], corners[2], corners[3]) < 0) return false;
    }
    return true;
}

// Every tetrahedron has an inside, those beyond its faces have it beyond the same faces, and together they are as large
// as the cube: so none overlaps another, and nothing of the cube is left out.
void require_mesh(const TetrahedralMesh& mesh, std::size_t joined) {
    double volume = 0;
    std::vector<std::uint8_t> is_corner(mesh.points().size(), 0);
    for (std::uint32_t number = 0; number < mesh.tetrahedra().size(); ++number) {
        const Tetrahedron& t = mesh.tetrahedra()[number];
        if (t.corners[0] == TetrahedralMesh::none) continue;
        const auto corner = [&](int k) { return mesh.points()[t.corners[k]]; };
        REQUIRE(orient3d(corner(0), corner(1), corner(2), corner(3)) > 0);
        volume += (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0)) / 6;
        for (int k = 0; k < 4; ++k) {
            is_corner[t.corners[k]] = 1;
            if (t.neighbours[k] == TetrahedralMesh::none) continue;
            const Tetrahedron& other = mesh.tetrahedra()[t.neighbours[k]];
            const auto back = std::find(other.neighbours, other.neighbours + 4, number) - other.neighbours;
            REQUIRE(back < 4);
            std::vector<std::uint32_t> face, same;
            for (int l = 0; l < 4; ++l) {
                if (l != k) face.push_back(t.corners[l]);
                if (l != back) same.push_back(other.corners[l]);
            }
            std::sort(face.begin(), face.end());
            std::sort(same.begin(), same.end());
            REQUIRE(face == same);
        }
    }
    CHECK(volume == Approx(8).epsilon(1e-12));
    CHECK(std::count(is_corner.begin(), is_corner.end(), 1) == static_cast<std::ptrdiff_t>(8 + joined));
}

}  // namespace

TEST_CASE("a tetrahedral mesh fills the cube and joins all points", "[broadphase]") {
    CAPTURE(seed);
    Random random;
    for (const Kind& kind : kinds())
        for (const int count : {0, 1, 2, 5, 343}) {
            CAPTURE(kind.name, count);
            const std::vector<Vec3> points = make_points(kind, count, random);
            TetrahedralMesh mesh;
            mesh.build(points);
            require_mesh(mesh, points.size());
            mesh.build(points);  // what it was before does not matter
            require_mesh(mesh, points.size());
        }
}

TEST_CASE("a point of the cube is located in a tetrahedron that holds it", "[broadphase]") {
    CAPTURE(seed);
    Random random;
    for (const Kind& kind : kinds()) {
        CAPTURE(kind.name);
        const std::vector<Vec3> points = make_points(kind, 200, random);
        TetrahedralMesh mesh;
        mesh.build(points);
        std::vector<Vec3> wanted = points;
        for (int i = 0; i < 200; ++i) wanted.push_back(TetrahedralMesh::snapped(random.point(1)));
        for (int i = 0; i < 8; ++i) wanted.push_back(mesh.points()[static_cast<std::size_t>(i)]);
        std::uint32_t at = TetrahedralMesh::none;
        for (const Vec3& p : wanted) {
            CAPTURE(p.transpose());
            at = mesh.locate(p, at);
            REQUIRE(holds(mesh, mesh.tetrahedra()[at], p));
        }
    }
}

TEST_CASE("no tetrahedron is missing that shares a point with a box", "[broadphase]") {
    CAPTURE(seed);
    Random random;
    for (const Kind& kind : kinds()) {
        TetrahedralMesh mesh;
        mesh.build(make_points(kind, 60, random));
        for (const double size : {0.0, 1e-4, 0.3, 2.0}) {
            const Vec3 a = TetrahedralMesh::snapped(random.point(1) * (1 - size / 2));
            Aabb box;
            box.include(a);
            box.include(TetrahedralMesh::snapped(a + random.point(size)).cwiseMax(-1).cwiseMin(1));
            std::vector<std::uint32_t> found;
            REQUIRE(mesh.find_overlapped(box, mesh.locate(a), mesh.tetrahedra().size(), found));
            CHECK(std::set<std::uint32_t>(found.begin(), found.end()).size() == found.size());
            for (int i = 0; i < 30; ++i) {
                const Vec3 part = 0.5 * (random.point(1) + Vec3::Ones());
                const Vec3 p = i == 0 ? box.max : (box.min + part.cwiseProduct(box.max - box.min)).eval();
                CAPTURE(kind.name, size, p.transpose());
                for (std::uint32_t t = 0; t < mesh.tetrahedra().size(); ++t)
                    if (mesh.tetrahedra()[t].corners[0] != TetrahedralMesh::none &&
                        holds(mesh, mesh.tetrahedra()[t], p))
                        REQUIRE(std::find(found.begin(), found.end(), t) != found.end());
            }
        }
    }
}
