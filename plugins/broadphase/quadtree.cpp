// Broadphase by a quadtree: the ground is divided into four squares, and these again, where many boxes are. Height is
// left to the bounds of the boxes in a square.
//
// A box is filed in the smallest square that takes it: with looseness 1 all of it has to lie over the square, with
// looseness 2 its centre. How boxes are filed, kept and looked for is in box_tree.h.
#include "cubic_space.h"

namespace {

class Quadtree final : public kolize::TreeBroadphase<kolize::CubicSpace<2>> {
public:
    static void parameters(kolize::Parameters<Quadtree>& p) {
        add_tree_parameters(p);
        p.add("looseness", &Quadtree::looseness_)
            .range(1, 4)
            .doc("How many times as large as its square the ground is that takes boxes; 1: a plain quadtree.");
        p.add("up", &Quadtree::up_).choices({"x", "y", "z"}).doc("The axis that is not divided.");
    }

    void find_pairs(const kolize::BroadphaseInput& input, std::vector<kolize::Pair>& pairs) override {
        space_.looseness = looseness_;
        space_.axes = {(up() + 1) % 3, (up() + 2) % 3};
        TreeBroadphase::find_pairs(input, pairs);
    }

    void outline(const kolize::BroadphaseInput& input, kolize::Outline& outline) override {
        std::vector<kolize::Pair> ignored;
        find_pairs(input, ignored);
        const int flat[] = {up()};
        space_.outline(static_tree(), outline, flat);
        space_.outline(moving_tree(), outline, flat);
    }

private:
    int up() const { return up_[0] - 'x'; }

    double looseness_ = 2;
    std::string up_ = "y";
};

}  // namespace

KOLIZE_PLUGIN(Quadtree, .name = "quadtree",
              .summary = "the ground divided into four squares, and these again, where many boxes are",
              .source =
                  "Finkel and Bentley, Quad trees: a data structure for retrieval on composite keys (1974); Ericson, "
                  "Real-Time Collision Detection (2005), 7.3; loose cells: Ulrich, Game Programming Gems (2000)",
              .cost =
                  "As octree, as long as few boxes stand above each other; a tower of n boxes costs n comparisons for "
                  "each of them.",
              .accuracy = "Exact: a pair is reported if and only if its closed boxes overlap.",
              .choose = "Flat worlds, a landscape or a floor, in which few boxes move. For towers take octree.",
              .capabilities = {.exact = true, .outline = "cells"})
