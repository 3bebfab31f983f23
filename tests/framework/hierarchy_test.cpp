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

// A block's corners are those of its triangles, to half the spacing of floats there.
void check_block(const TriangleBlock& block, std::uint32_t lane, const TriangleSoup& soup, std::uint32_t triangle) {
    for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis) {
            const double exact = soup.vertices[soup.triangles[triangle][corner]][axis];
            REQUIRE(std::abs(block.corners[corner][axis][lane] - exact) <= 0x1p-24 * std::abs(exact) + 0x1p-149);
        }
}

void check_leaf(const Hierarchy& tree, const TriangleSoup& soup, const HierarchyNode& leaf) {
    REQUIRE(leaf.first % TriangleBlock::size == 0);
    for (std::uint32_t i = 0; i < leaf.count; ++i)
        check_block(tree.blocks.at(leaf.first / TriangleBlock::size), i, soup, tree.order.at(leaf.first + i));
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
        if (soup.vertices.front().cwiseAbs().maxCoeff() < 1e38) check_leaf(tree, soup, node);
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

TEST_CASE("The boxes of a hierarchy hold meshes that float cannot, however large, small or far", "[hierarchy]") {
    const double scale = GENERATE(1e-310, 1e-60, 1e-40, 1e-30, 1e30, 3e38, 1e60, 1e200, 1e306);
    const double offset = GENERATE(0.0, 1.0, 1e7, -1e15);  // in sizes of the mesh
    CAPTURE(scale, offset);
    TriangleSoup soup = random_triangles(50, 3);
    if (std::abs(offset) * scale > 1e300) return;  // double cannot hold that either
    for (Vec3& p : soup.vertices) p = (p.array() + offset) * scale;
    const Hierarchy tree = build_hierarchy(soup.vertices, soup.triangles);
    std::size_t depth = 0;
    CHECK(walk(tree, soup, 0, 0, depth).size() == 50);
    for (const HierarchyNode& node : tree.nodes) {
        CHECK(node.center.allFinite());
        CHECK((node.half.array() >= 0).all());
    }
}

TEST_CASE("The last block of a hierarchy is filled up with its last triangle", "[hierarchy]") {
    const TriangleSoup soup = random_triangles(9, 4);
    const Hierarchy tree = build_hierarchy(soup.vertices, soup.triangles);
    REQUIRE(tree.blocks.size() == 3);
    for (std::uint32_t lane = 0; lane < TriangleBlock::size; ++lane)
        check_block(tree.blocks.back(), lane, soup, tree.order.back());
}

TEST_CASE("The hierarchy of an empty mesh has no nodes", "[hierarchy]") {
    const Hierarchy tree = build_hierarchy({}, {});
    CHECK(tree.nodes.empty());
    CHECK(tree.order.empty());
    CHECK(tree.blocks.empty());
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
