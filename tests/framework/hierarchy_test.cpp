#include "framework/solids.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>

using namespace kolize;
using namespace kolize::test;

namespace {

TriangleSoup random_triangles(std::uint32_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-10, 10);
    TriangleSoup soup;
    for (std::uint32_t v = 0; v < 3 * count; ++v) {
        soup.vertices.emplace_back(place(random), place(random), place(random));
        if (v % 3 == 2) soup.triangles.push_back({v - 2, v - 1, v});
    }
    return soup;
}

// long double holds the difference of these doubles exactly.
bool holds(const HierarchyNode& node, const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(static_cast<long double>(p[axis]) - node.center[axis]) > node.half[axis]) return false;
    return true;
}

// Checks the tree below a node; returns the triangles in it and adds to the longest path.
std::vector<std::uint32_t> walk(const Hierarchy& tree, const TriangleSoup& soup, std::uint32_t id, std::size_t depth,
                                std::size_t& longest) {
    const HierarchyNode& node = tree.nodes.at(id);
    longest = std::max(longest, depth);
    std::vector<std::uint32_t> triangles;
    if (node.is_leaf()) {
        REQUIRE(node.count <= 4);
        for (std::uint32_t i = 0; i < node.count; ++i) triangles.push_back(tree.order.at(node.first + i));
    } else {
        triangles = walk(tree, soup, node.first, depth + 1, longest);
        for (const std::uint32_t t : walk(tree, soup, node.first + 1, depth + 1, longest)) triangles.push_back(t);
    }
    for (const std::uint32_t t : triangles)
        for (const std::uint32_t v : soup.triangles[t]) REQUIRE(holds(node, soup.vertices[v]));
    return triangles;
}

}  // namespace

TEST_CASE("Every node of a hierarchy holds all its triangles, and every triangle has one leaf", "[hierarchy]") {
    for (const std::uint32_t count : {1u, 2u, 4u, 5u, 8u, 9u, 100u, 1000u}) {
        CAPTURE(count);
        const TriangleSoup soup = random_triangles(count, count);
        const Hierarchy tree = build_hierarchy(soup.vertices, soup.triangles);
        std::size_t depth = 0;
        std::vector<std::uint32_t> triangles = walk(tree, soup, 0, 0, depth);
        std::sort(triangles.begin(), triangles.end());
        std::vector<std::uint32_t> all(count);
        std::iota(all.begin(), all.end(), 0u);
        CHECK(triangles == all);
        CHECK(depth <= static_cast<std::size_t>(std::ceil(std::log2(count))));  // halved at each level
    }
}

TEST_CASE("The hierarchy of an empty mesh has no nodes", "[hierarchy]") {
    const Hierarchy tree = build_hierarchy({}, {});
    CHECK(tree.nodes.empty());
    CHECK(tree.order.empty());
}

TEST_CASE("Triangles that all lie in one place are still split into small leaves", "[hierarchy]") {
    TriangleSoup soup = random_triangles(1, 1);
    soup.triangles.resize(777, soup.triangles[0]);
    const Hierarchy tree = build_hierarchy(soup.vertices, soup.triangles);
    std::size_t depth = 0;
    CHECK(walk(tree, soup, 0, 0, depth).size() == 777);
    CHECK(depth <= 10);
}

TEST_CASE("The hierarchy of a far mesh holds it in spite of rounding", "[hierarchy]") {
    std::mt19937 random(11);
    const TriangleSoup soup = moved(cone48(), random_rotation(random), Vec3(1e9, -3e7, 0.1));
    std::size_t depth = 0;
    walk(build_hierarchy(soup.vertices, soup.triangles), soup, 0, 0, depth);
    CHECK(depth >= 5);
}
