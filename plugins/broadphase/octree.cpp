// Broadphase by an octree: a cube is divided into eight, and these again, where many boxes are.
//
// A box is filed in the smallest cell that takes it: with looseness 1 the whole box has to lie within the cell, so that
// small boxes across a large cell's middle stay at the large cell; with looseness 2 its centre has to, and it may stand
// out by half a cell on each side. How boxes are filed, kept and looked for is in box_tree.h.
#include "cubic_space.h"

namespace {

class Octree final : public kolize::TreeBroadphase<kolize::CubicSpace<3>> {
public:
    Octree() { space_.axes = {0, 1, 2}; }

    static void parameters(kolize::Parameters<Octree>& p) {
        add_tree_parameters(p);
        p.add("looseness", &Octree::looseness_)
            .range(1, 4)
            .doc("How many times as large as its cell the space is that takes boxes; 1: a plain octree.");
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<kolize::Pair>& pairs) override {
        space_.looseness = looseness_;
        TreeBroadphase::find_pairs(input, pairs);
    }

    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        std::vector<kolize::Pair> ignored;
        find_pairs(input, ignored);
        space_.outline(static_tree(), outline, {});
        space_.outline(moving_tree(), outline, {});
    }

private:
    double looseness_ = 2;
};

}  // namespace

KOLIZE_PLUGIN(
    Octree, .name = "octree", .summary = "a cube divided into eight, and these again, where many boxes are",
    .source =
        "Meagher, Geometric modeling using octree encoding (1982); loose cells: Ulrich, Loose octrees, Game "
        "Programming Gems (2000)",
    .cost =
        "A box that has moved is filed and looked for in O(log N) where boxes lie evenly; those that have not "
        "cost a comparison. About 400 bytes a box.",
    .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
    .choose = "Worlds of unevenly spread boxes in which few move. Where all move grid is several times faster.",
    .capabilities = {.exact = true, .outline = "cells"})
