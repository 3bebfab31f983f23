// What the trees of cells (octree, quadtree, kd_tree) have in common: boxes are filed in nodes, and stay filed while
// they do not move.
//
// A box is filed in the deepest node that takes it; what fits none of a node's children stays at the node. Each node
// keeps the tight bounds of its own boxes and of all boxes below it, and it is these that a search is guided by: how a
// tree divides space decides what it costs, and never what it finds. Static boxes have a tree of their own, made once
// for a generation. Of the moving ones those are filed and looked for again whose box is another one than in the last
// call; pairs of two that have not moved are kept.
#pragma once

#include <kolize/plugin.h>

#include <algorithm>
#include <array>
#include <functional>

namespace kolize {

// Space tells how a tree divides space:
//   Space::Cell                          what a node knows of its part of space
//   Space::children                      how many parts a node is divided into
//   Cell whole(const Aabb&)              the root's part, for boxes within these bounds; they may be empty
//   bool holds(const Cell&, const Aabb&) whether the root's part is still good for this box
//   bool divide(Cell&, count, next_box)  decides how the part is divided; false if that is of no use. The function
//                                        gives the boxes in it, one in each of as many calls
//   int child_of(const Cell&, box)       the child that takes the box, or -1
//   Cell child(const Cell&, int)
template <class Space>
class BoxTree {
public:
    using Cell = typename Space::Cell;
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    struct Node {
        Cell cell;
        std::uint32_t parent = none;
        std::uint32_t first_child = none;  // the others stand behind it
        std::uint32_t first_row = none;    // of a list through next_
        std::uint32_t count = 0;           // rows of its own
        std::uint32_t level = 0;
        bool stale = false;  // own and below have to be found again
        Aabb own, below;     // tight; below includes own
    };

    // Room for all rows of the input, so that filing them allocates nothing.
    void reserve(std::size_t rows) {
        next_.resize(rows);
        previous_.resize(rows);
        node_.assign(rows, none);
        nodes_.reserve(rows + 8 * Space::children);
        stale_.reserve(nodes_.capacity());
    }

    void build(const Space& space, std::span<const Aabb> bounds, std::span<const std::uint32_t> rows,
               std::uint32_t leaf_size, std::uint32_t max_depth) {
        space_ = &space;
        bounds_ = bounds;
        leaf_size_ = leaf_size;
        max_depth_ = max_depth;
        Aabb whole;
        for (const std::uint32_t row : rows) {
            whole.include(bounds[row].min);
            whole.include(bounds[row].max);
        }
        nodes_.clear();
        stale_.clear();
        surface_ = 0;
        add_node(space.whole(whole), none, 0);
        for (const std::uint32_t row : rows) link(row, 0);
        for (std::uint32_t node = 0; node < nodes_.size(); ++node)
            if (nodes_[node].count > leaf_size_) divide(node);
        refit();
    }

    // Files rows of build() again whose boxes have changed. Returns how many now stand in another node; if all of them
    // keep changing places the tree is not any more what build() would make.
    std::size_t refile(std::span<const Aabb> bounds, std::span<const std::uint32_t> rows) {
        bounds_ = bounds;
        std::size_t moved = 0;
        for (const std::uint32_t row : rows) {
            const std::uint32_t node = find_node(0, row);
            make_stale(node_[row]);
            if (node == node_[row]) continue;
            unlink(row);
            link(row, node);
            ++moved;
        }
        refit();
        return moved;
    }

    // Sum over the nodes of how likely a box is to meet them: a measure of what searching costs. m^2; it may overflow.
    double surface() const { return surface_; }

    bool holds(const Aabb& box) const { return space_->holds(nodes_[0].cell, box); }

    // Calls visit(row) for each row whose box overlaps the given one.
    template <class Visit>
    void search(const Aabb& box, Visit&& visit, std::uint32_t from = 0) const {
        const Node& node = nodes_[from];
        if (!node.below.overlaps(box)) return;
        if (node.own.overlaps(box))
            for (std::uint32_t row = node.first_row; row != none; row = next_[row])
                if (bounds_[row].overlaps(box)) visit(row);
        if (node.first_child == none) return;
        for (std::uint32_t i = 0; i < Space::children; ++i) search(box, visit, node.first_child + i);
    }

    // Calls visit(row, row) once for every two rows whose boxes overlap.
    template <class Visit>
    void search_all(Visit&& visit, std::uint32_t from = 0) const {
        const Node& node = nodes_[from];
        for (std::uint32_t a = node.first_row; a != none; a = next_[a])
            for (std::uint32_t b = next_[a]; b != none; b = next_[b])
                if (bounds_[a].overlaps(bounds_[b])) visit(a, b);
        if (node.first_child == none) return;
        for (std::uint32_t i = 0; i < Space::children; ++i) {
            search_own(node, node.first_child + i, visit);
            search_all(visit, node.first_child + i);
            for (std::uint32_t j = i + 1; j < Space::children; ++j)
                search_between(node.first_child + i, node.first_child + j, visit);
        }
    }

    const std::vector<Node>& nodes() const { return nodes_; }

private:
    // The boxes below one node against those below the other one.
    template <class Visit>
    void search_between(std::uint32_t a, std::uint32_t b, Visit&& visit) const {
        const Node &x = nodes_[a], &y = nodes_[b];
        if (!x.below.overlaps(y.below)) return;
        search_own(x, b, visit);
        if (x.first_child == none) return;
        for (std::uint32_t i = 0; i < Space::children; ++i) {
            search_own(y, x.first_child + i, visit);
            for (std::uint32_t j = 0; y.first_child != none && j < Space::children; ++j)
                search_between(x.first_child + i, y.first_child + j, visit);
        }
    }

    // A node's own boxes against all below another one.
    template <class Visit>
    void search_own(const Node& node, std::uint32_t from, Visit&& visit) const {
        const Node& other = nodes_[from];
        if (!node.own.overlaps(other.below)) return;
        if (node.own.overlaps(other.own))
            for (std::uint32_t a = node.first_row; a != none; a = next_[a]) {
                if (!bounds_[a].overlaps(other.own)) continue;
                for (std::uint32_t b = other.first_row; b != none; b = next_[b])
                    if (bounds_[a].overlaps(bounds_[b])) visit(a, b);
            }
        if (other.first_child == none) return;
        for (std::uint32_t i = 0; i < Space::children; ++i) search_own(node, other.first_child + i, visit);
    }

    void add_node(const Cell& cell, std::uint32_t parent, std::uint32_t level) {
        Node& node = nodes_.emplace_back();
        node.cell = cell;
        node.parent = parent;
        node.level = level;
    }

    std::uint32_t find_node(std::uint32_t from, std::uint32_t row) {
        for (;;) {
            if (nodes_[from].first_child == none && !(has_doubled(from) && divide(from))) return from;
            const int child = space_->child_of(nodes_[from].cell, bounds_[row]);
            if (child < 0) return from;
            from = nodes_[from].first_child + static_cast<std::uint32_t>(child);
        }
    }

    // Where dividing a leaf was of no use it is tried again when there are twice as many boxes.
    bool has_doubled(std::uint32_t leaf) const {
        const std::uint32_t fold = nodes_[leaf].count / leaf_size_;
        return nodes_[leaf].count % leaf_size_ == 0 && fold > 0 && (fold & (fold - 1)) == 0;
    }

    bool divide(std::uint32_t leaf) {
        if (nodes_[leaf].level >= max_depth_ || nodes_.size() + Space::children > nodes_.capacity()) return false;
        std::uint32_t row = nodes_[leaf].first_row;
        const auto next_box = [&]() -> const Aabb& {
            const Aabb& box = bounds_[row];
            row = next_[row];
            return box;
        };
        if (!space_->divide(nodes_[leaf].cell, nodes_[leaf].count, next_box)) return false;
        const auto first = static_cast<std::uint32_t>(nodes_.size());
        for (std::uint32_t i = 0; i < Space::children; ++i)
            add_node(space_->child(nodes_[leaf].cell, static_cast<int>(i)), leaf, nodes_[leaf].level + 1);
        nodes_[leaf].first_child = first;
        for (row = nodes_[leaf].first_row; row != none;) {
            const std::uint32_t present = row;
            row = next_[row];
            const int child = space_->child_of(nodes_[leaf].cell, bounds_[present]);
            if (child < 0) continue;
            unlink(present);
            link(present, first + static_cast<std::uint32_t>(child));
        }
        return true;
    }

    void link(std::uint32_t row, std::uint32_t number) {
        Node& node = nodes_[number];
        node_[row] = number;
        previous_[row] = none;
        next_[row] = node.first_row;
        if (node.first_row != none) previous_[node.first_row] = row;
        node.first_row = row;
        ++node.count;
        make_stale(number);
    }

    void unlink(std::uint32_t row) {
        Node& node = nodes_[node_[row]];
        (previous_[row] == none ? node.first_row : next_[previous_[row]]) = next_[row];
        if (next_[row] != none) previous_[next_[row]] = previous_[row];
        --node.count;
        make_stale(node_[row]);
    }

    void make_stale(std::uint32_t node) {
        for (; node != none && !nodes_[node].stale; node = nodes_[node].parent) {
            nodes_[node].stale = true;
            stale_.push_back(node);
        }
    }

    // Children before their parents, which have smaller numbers.
    void refit() {
        std::sort(stale_.begin(), stale_.end(), std::greater<>());
        for (const std::uint32_t number : stale_) {
            Node& node = nodes_[number];
            node.stale = false;
            surface_ -= surface_of(node.below);
            node.own = Aabb{};
            for (std::uint32_t row = node.first_row; row != none; row = next_[row]) include(node.own, bounds_[row]);
            node.below = node.own;
            for (std::uint32_t i = 0; node.first_child != none && i < Space::children; ++i)
                include(node.below, nodes_[node.first_child + i].below);
            surface_ += surface_of(node.below);
        }
        stale_.clear();
    }

    static double surface_of(const Aabb& box) {
        if (!box.finite()) return 0;
        const Vec3 side = box.max - box.min;
        return side.x() * side.y() + side.y() * side.z() + side.z() * side.x();
    }

    static void include(Aabb& bounds, const Aabb& box) {
        bounds = {bounds.min.cwiseMin(box.min), bounds.max.cwiseMax(box.max)};
    }

    const Space* space_ = nullptr;
    std::span<const Aabb> bounds_;
    std::uint32_t leaf_size_ = 0, max_depth_ = 0;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> next_, previous_, node_;  // by row
    std::vector<std::uint32_t> stale_;
    double surface_ = 0;
};

template <class Space>
class TreeBroadphase : public Broadphase {
public:
    void find_pairs(const BroadphaseInput& input, std::vector<Pair>& pairs) override {
        require_valid_bounds(input.bounds);
        if (input.generation != generation_ || input.bounds.size() != boxes_.size())
            begin_anew(input);
        else
            follow(input);
        if (2 * moved_.size() > moving_rows_.size())
            find_all_pairs();
        else
            for (const std::uint32_t row : moved_) find_partners(row);
        for (const std::uint32_t row : moved_) has_moved_[row] = 0;
        pairs.insert(pairs.end(), kept_.begin(), kept_.end());
    }

protected:
    template <class Plugin>
    static void add_tree_parameters(Parameters<Plugin>& p) {
        p.add("leaf_size", &Plugin::leaf_size_).range(1, 1e6).doc("A node with fewer boxes than this is not divided.");
        p.add("max_depth", &Plugin::max_depth_).range(0, 64).doc("Levels below the root.");
    }

    const BoxTree<Space>& moving_tree() const { return moving_; }
    const BoxTree<Space>& static_tree() const { return static_; }

    Space space_;
    int leaf_size_ = 8;
    int max_depth_ = 24;
    double rebuild_at_ = 2;

private:
    void begin_anew(const BroadphaseInput& input) {
        generation_ = input.generation;
        const std::size_t rows = input.bounds.size();
        boxes_.assign(input.bounds.begin(), input.bounds.end());
        has_moved_.assign(rows, 0);
        moved_.clear();
        standing_.clear();
        moving_rows_.clear();
        for (std::uint32_t row = 0; row < rows; ++row) (input.is_static[row] ? standing_ : moving_rows_).push_back(row);
        moved_.reserve(rows);
        kept_.clear();
        kept_.reserve(8 * rows);
        static_.reserve(rows);
        moving_.reserve(rows);
        build(static_, standing_);
        build_moving();
        for (const std::uint32_t row : moving_rows_) note_moved(row);
    }

    void follow(const BroadphaseInput& input) {
        moved_.clear();
        bool held = true;
        for (const std::uint32_t row : moving_rows_) {
            const Aabb& box = input.bounds[row];
            if (box.min == boxes_[row].min && box.max == boxes_[row].max) continue;
            boxes_[row] = box;
            held = held && moving_.holds(box);
            note_moved(row);
        }
        if (moved_.empty()) return;
        refiled_ = held ? refiled_ + moving_.refile(boxes_, moved_) : moving_rows_.size();
        if (refiled_ >= moving_rows_.size() || moving_.surface() > rebuild_at_ * built_surface_) build_moving();
        std::erase_if(kept_, [this](const Pair& pair) { return has_moved_[pair.a] || has_moved_[pair.b]; });
    }

    void note_moved(std::uint32_t row) {
        has_moved_[row] = 1;
        moved_.push_back(row);
    }

    void build(BoxTree<Space>& tree, std::span<const std::uint32_t> rows) {
        tree.build(space_, boxes_, rows, static_cast<std::uint32_t>(leaf_size_),
                   static_cast<std::uint32_t>(max_depth_));
    }
    void build_moving() {
        build(moving_, moving_rows_);
        refiled_ = 0;
        built_surface_ = moving_.surface();
    }

    // All at once costs less than one by one.
    void find_all_pairs() {
        kept_.clear();
        const auto add = [this](std::uint32_t a, std::uint32_t b) {
            kept_.push_back({std::min(a, b), std::max(a, b)});
        };
        for (const std::uint32_t a : moving_rows_) static_.search(boxes_[a], [&](std::uint32_t b) { add(a, b); });
        moving_.search_all(add);
    }

    // Of two that have both moved the first one finds the pair.
    void find_partners(std::uint32_t row) {
        const auto add = [&](std::uint32_t other) { kept_.push_back({std::min(row, other), std::max(row, other)}); };
        static_.search(boxes_[row], add);
        moving_.search(boxes_[row], [&](std::uint32_t other) {
            if (other != row && (row < other || !has_moved_[other])) add(other);
        });
    }

    std::uint64_t generation_ = 0;
    std::vector<Aabb> boxes_;  // of the last call
    std::vector<std::uint32_t> standing_, moving_rows_;
    std::vector<std::uint32_t> moved_;  // since the last call
    std::vector<std::uint8_t> has_moved_;
    BoxTree<Space> static_, moving_;
    std::size_t refiled_ = 0;   // since the moving tree was built
    double built_surface_ = 0;  // of the moving tree then
    std::vector<Pair> kept_;
};

}  // namespace kolize
