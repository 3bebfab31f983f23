// What the trees of cells (octree, quadtree, kd_tree) have in common: boxes are filed in nodes, and stay filed while
// they do not move.
//
// A box is filed in the deepest node that takes it; what fits none of a node's children stays at the node. Each node
// keeps the tight bounds of its own boxes and of all boxes below it, and it is these that a search is guided by: how a
// tree divides space decides what it costs, and never what it finds. Static boxes have a tree of their own, made once
// for a generation. Of the moving ones those are filed and looked for again whose box is another one than in the last
// call; pairs of two that have not moved are kept.
//
// When a tree is built its boxes are copied into slots, one node's after the other's, so that boxes that lie near each
// other in space also do so in memory. Boxes that change their node keep their slot till the tree is built anew.
#pragma once

#include <kolize/plugin.h>

#include <emmintrin.h>

#include <algorithm>
#include <functional>

namespace kolize {

// A box as its min and its -max: two of them overlap if six numbers are not greater than six others, and the smaller
// ones of their numbers bound both. An empty one overlaps nothing.
struct alignas(16) Bounds {
    __m128d lanes[3];

    Bounds() { std::fill(lanes, lanes + 3, _mm_set1_pd(infinity)); }
    explicit Bounds(const Aabb& box)
        : lanes{_mm_setr_pd(box.min[0], box.min[1]), _mm_setr_pd(box.min[2], -box.max[0]),
                _mm_setr_pd(-box.max[1], -box.max[2])} {}

    Aabb box() const {
        alignas(16) double x[6];
        for (int i = 0; i < 3; ++i) _mm_store_pd(x + 2 * i, lanes[i]);
        return {{x[0], x[1], x[2]}, {-x[3], -x[4], -x[5]}};
    }
    // For the other side of a comparison: its max and its -min.
    Bounds probe() const {
        const __m128d sign = _mm_set1_pd(-0.0);
        Bounds turned;
        turned.lanes[0] = _mm_xor_pd(_mm_shuffle_pd(lanes[1], lanes[2], 0b01), sign);
        turned.lanes[1] = _mm_xor_pd(_mm_shuffle_pd(lanes[2], lanes[0], 0b01), sign);
        turned.lanes[2] = _mm_xor_pd(_mm_shuffle_pd(lanes[0], lanes[1], 0b01), sign);
        return turned;
    }
    bool meets(const Bounds& probe) const {
        const __m128d no_greater =
            _mm_and_pd(_mm_and_pd(_mm_cmple_pd(lanes[0], probe.lanes[0]), _mm_cmple_pd(lanes[1], probe.lanes[1])),
                       _mm_cmple_pd(lanes[2], probe.lanes[2]));
        return _mm_movemask_pd(no_greater) == 0b11;
    }
    void include(const Bounds& o) {
        for (int i = 0; i < 3; ++i) lanes[i] = _mm_min_pd(lanes[i], o.lanes[i]);
    }
};

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
        std::uint32_t first_slot = none;   // of a list through next_
        std::uint32_t count = 0;           // slots of its own
        std::uint32_t level = 0;
        bool stale = false;  // own and below have to be found again
        Bounds own, below;   // tight; below includes own
    };

    // Room for all rows of the input, so that filing them allocates nothing.
    void reserve(std::size_t rows) {
        for (auto* boxes : {&boxes_, &sorted_boxes_}) boxes->reserve(rows);
        for (auto* numbers : {&rows_, &sorted_rows_}) numbers->reserve(rows);
        next_.resize(rows);
        previous_.resize(rows);
        node_.assign(rows, none);
        nodes_.reserve(rows + 8 * Space::children);
        stale_.reserve(nodes_.capacity());
    }

    void build(const Space& space, std::span<const Aabb> bounds, std::span<const std::uint32_t> rows,
               std::uint32_t leaf_size, std::uint32_t max_depth) {
        space_ = &space;
        leaf_size_ = leaf_size;
        max_depth_ = max_depth;
        rows_.assign(rows.begin(), rows.end());
        boxes_.clear();
        Bounds whole;
        for (const std::uint32_t row : rows) whole.include(boxes_.emplace_back(bounds[row]));
        nodes_.clear();
        stale_.clear();
        surface_ = 0;
        add_node(space.whole(whole.box()), none, 0);
        for (std::uint32_t slot = 0; slot < size(); ++slot) link(slot, 0);
        for (std::uint32_t node = 0; node < nodes_.size(); ++node)
            if (nodes_[node].count > leaf_size_) divide(node);
        sort_slots();
        refit();
    }

    std::uint32_t size() const { return static_cast<std::uint32_t>(rows_.size()); }
    std::uint32_t row(std::uint32_t slot) const { return rows_[slot]; }
    std::span<const std::uint32_t> rows() const { return rows_; }  // by slot
    const Bounds& bounds(std::uint32_t slot) const { return boxes_[slot]; }

    // False if it is the box that was there.
    bool replace(std::uint32_t slot, const Aabb& box) {
        const Aabb old = boxes_[slot].box();
        if (box.min == old.min && box.max == old.max) return false;
        boxes_[slot] = Bounds(box);
        return true;
    }

    // Files slots again whose boxes have been replaced. Returns how many now stand in another node; if all of them keep
    // changing places the tree is not any more what build() would make.
    std::size_t refile(std::span<const std::uint32_t> slots) {
        std::size_t moved = 0;
        for (const std::uint32_t slot : slots) {
            const std::uint32_t node = find_node(boxes_[slot].box());
            make_stale(node_[slot]);
            if (node == node_[slot]) continue;
            unlink(slot);
            link(slot, node);
            ++moved;
        }
        refit();
        return moved;
    }

    // Sum over the nodes of how likely a box is to meet them: a measure of what searching costs. m^2; it may overflow.
    double surface() const { return surface_; }

    bool holds(const Aabb& box) const { return space_->holds(nodes_[0].cell, box); }

    // Calls visit(row) for each row whose box meets the probe.
    template <class Visit>
    void search(const Bounds& probe, Visit&& visit, std::uint32_t from = 0) const {
        const Node& node = nodes_[from];
        if (!node.below.meets(probe)) return;
        if (node.own.meets(probe)) search_list(node.first_slot, probe, visit);
        if (node.first_child == none) return;
        for (std::uint32_t i = 0; i < Space::children; ++i) search(probe, visit, node.first_child + i);
    }

    // Calls visit(row, row) once for every two rows whose boxes overlap.
    template <class Visit>
    void search_all(Visit&& visit, std::uint32_t from = 0) const {
        const Node& node = nodes_[from];
        for (std::uint32_t slot = node.first_slot; slot != none; slot = next_[slot])
            search_list(next_[slot], boxes_[slot].probe(), [&](std::uint32_t other) { visit(rows_[slot], other); });
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
    template <class Visit>
    void search_list(std::uint32_t first, const Bounds& probe, Visit&& visit) const {
        for (std::uint32_t slot = first; slot != none; slot = next_[slot])
            if (boxes_[slot].meets(probe)) visit(rows_[slot]);
    }

    // The boxes below one node against those below the other one.
    template <class Visit>
    void search_between(std::uint32_t a, std::uint32_t b, Visit&& visit) const {
        const Node &x = nodes_[a], &y = nodes_[b];
        const Bounds probe = y.below.probe();
        if (!x.below.meets(probe)) return;
        search_own(x, b, visit);
        if (x.first_child == none) return;
        for (std::uint32_t child = x.first_child; child < x.first_child + Space::children; ++child) {
            if (!nodes_[child].below.meets(probe)) continue;
            search_own(y, child, visit);
            for (std::uint32_t j = 0; y.first_child != none && j < Space::children; ++j)
                search_between(child, y.first_child + j, visit);
        }
    }

    // A node's own boxes against all below another one.
    template <class Visit>
    void search_own(const Node& node, std::uint32_t from, Visit&& visit) const {
        const Node& other = nodes_[from];
        if (node.count == 0) return;
        const Bounds probe = node.own.probe();
        if (!other.below.meets(probe)) return;
        if (other.own.meets(probe))
            for (std::uint32_t slot = node.first_slot; slot != none; slot = next_[slot]) {
                const Bounds one = boxes_[slot].probe();
                if (other.own.meets(one))
                    search_list(other.first_slot, one, [&](std::uint32_t row) { visit(rows_[slot], row); });
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

    std::uint32_t find_node(const Aabb& box) {
        for (std::uint32_t from = 0;;) {
            if (nodes_[from].first_child == none && !(has_doubled(from) && divide(from))) return from;
            const int child = space_->child_of(nodes_[from].cell, box);
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
        std::uint32_t slot = nodes_[leaf].first_slot;
        const auto next_box = [&] {
            const Aabb box = boxes_[slot].box();
            slot = next_[slot];
            return box;
        };
        if (!space_->divide(nodes_[leaf].cell, nodes_[leaf].count, next_box)) return false;
        const auto first = static_cast<std::uint32_t>(nodes_.size());
        for (std::uint32_t i = 0; i < Space::children; ++i)
            add_node(space_->child(nodes_[leaf].cell, static_cast<int>(i)), leaf, nodes_[leaf].level + 1);
        nodes_[leaf].first_child = first;
        for (slot = nodes_[leaf].first_slot; slot != none;) {
            const std::uint32_t present = slot;
            slot = next_[slot];
            const int child = space_->child_of(nodes_[leaf].cell, boxes_[present].box());
            if (child < 0) continue;
            unlink(present);
            link(present, first + static_cast<std::uint32_t>(child));
        }
        return true;
    }

    void link(std::uint32_t slot, std::uint32_t number) {
        Node& node = nodes_[number];
        node_[slot] = number;
        previous_[slot] = none;
        next_[slot] = node.first_slot;
        if (node.first_slot != none) previous_[node.first_slot] = slot;
        node.first_slot = slot;
        ++node.count;
        make_stale(number);
    }

    void unlink(std::uint32_t slot) {
        Node& node = nodes_[node_[slot]];
        (previous_[slot] == none ? node.first_slot : next_[previous_[slot]]) = next_[slot];
        if (next_[slot] != none) previous_[next_[slot]] = previous_[slot];
        --node.count;
        make_stale(node_[slot]);
    }

    // Each node's slots one after the other, in the order of the nodes.
    void sort_slots() {
        sorted_boxes_.clear();
        sorted_rows_.clear();
        for (std::uint32_t number = 0; number < nodes_.size(); ++number) {
            for (std::uint32_t slot = nodes_[number].first_slot; slot != none; slot = next_[slot]) {
                sorted_boxes_.push_back(boxes_[slot]);
                sorted_rows_.push_back(rows_[slot]);
            }
        }
        boxes_.swap(sorted_boxes_);
        rows_.swap(sorted_rows_);
        std::uint32_t begin = 0;
        for (std::uint32_t number = 0; number < nodes_.size(); ++number) {
            const std::uint32_t end = begin + nodes_[number].count;
            if (begin != end) nodes_[number].first_slot = begin;
            for (std::uint32_t slot = begin; slot < end; ++slot) {
                node_[slot] = number;
                previous_[slot] = slot == begin ? none : slot - 1;
                next_[slot] = slot + 1 == end ? none : slot + 1;
            }
            begin = end;
        }
    }

    void make_stale(std::uint32_t node) {
        for (; node != none && !nodes_[node].stale; node = nodes_[node].parent) {
            nodes_[node].stale = true;
            stale_.push_back(node);
        }
    }

    // Children before their parents, which have smaller numbers.
    void refit() {
        sort_stale();
        for (const std::uint32_t number : stale_) {
            Node& node = nodes_[number];
            node.stale = false;
            surface_ -= surface_of(node.below);
            node.own = Bounds();
            for (std::uint32_t slot = node.first_slot; slot != none; slot = next_[slot]) node.own.include(boxes_[slot]);
            node.below = node.own;
            for (std::uint32_t i = 0; node.first_child != none && i < Space::children; ++i)
                node.below.include(nodes_[node.first_child + i].below);
            surface_ += surface_of(node.below);
        }
        stale_.clear();
    }

    void sort_stale() {
        if (stale_.size() < nodes_.size() / 16) return std::sort(stale_.begin(), stale_.end(), std::greater<>());
        stale_.clear();
        for (auto number = static_cast<std::uint32_t>(nodes_.size()); number-- > 0;)
            if (nodes_[number].stale) stale_.push_back(number);
    }

    static double surface_of(const Bounds& bounds) {
        const Aabb box = bounds.box();
        if (!box.finite()) return 0;
        const Vec3 side = box.max - box.min;
        return side.x() * side.y() + side.y() * side.z() + side.z() * side.x();
    }

    const Space* space_ = nullptr;
    std::uint32_t leaf_size_ = 0, max_depth_ = 0;
    std::vector<Node> nodes_;
    std::vector<Bounds> boxes_;                                 // by slot, as the next ones
    std::vector<std::uint32_t> rows_, next_, previous_, node_;  // rows_: of the input
    std::vector<Bounds> sorted_boxes_;                          // what sort_slots() makes
    std::vector<std::uint32_t> sorted_rows_;
    std::vector<std::uint32_t> stale_;
    double surface_ = 0;
};

template <class Space>
class TreeBroadphase : public Broadphase {
public:
    void find_pairs(const BroadphaseInput& input, std::vector<Pair>& pairs) override {
        require_valid_bounds(input.bounds);
        if (input.generation != generation_ || input.bounds.size() != has_moved_.size())
            begin_anew(input);
        else
            follow(input);
        if (2 * moved_.size() > moving_.size())
            find_all_pairs();
        else
            for (const std::uint32_t slot : moved_) find_partners(slot);
        for (const std::uint32_t slot : moved_) has_moved_[moving_.row(slot)] = 0;
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
        has_moved_.assign(rows, 0);
        moved_.clear();
        moved_.reserve(rows);
        rows_.reserve(rows);
        kept_.clear();
        kept_.reserve(8 * rows);
        for (const bool standing : {true, false}) {
            rows_.clear();
            for (std::uint32_t row = 0; row < rows; ++row)
                if (bool(input.is_static[row]) == standing) rows_.push_back(row);
            BoxTree<Space>& tree = standing ? static_ : moving_;
            tree.reserve(rows_.size());
            build(tree, input.bounds);
        }
        note_built();
        for (std::uint32_t slot = 0; slot < moving_.size(); ++slot) note_moved(slot);
    }

    void follow(const BroadphaseInput& input) {
        moved_.clear();
        bool held = true;
        for (std::uint32_t slot = 0; slot < moving_.size(); ++slot) {
            const Aabb& box = input.bounds[moving_.row(slot)];
            if (!moving_.replace(slot, box)) continue;
            held = held && moving_.holds(box);
            note_moved(slot);
        }
        if (moved_.empty()) return;
        refiled_ = held ? refiled_ + moving_.refile(moved_) : moving_.size();
        if (refiled_ >= moving_.size() || moving_.surface() > rebuild_at_ * built_surface_) rebuild(input.bounds);
        std::erase_if(kept_, [this](const Pair& pair) { return has_moved_[pair.a] || has_moved_[pair.b]; });
    }

    void note_moved(std::uint32_t slot) {
        has_moved_[moving_.row(slot)] = 1;
        moved_.push_back(slot);
    }

    void build(BoxTree<Space>& tree, std::span<const Aabb> bounds) {
        tree.build(space_, bounds, rows_, static_cast<std::uint32_t>(leaf_size_),
                   static_cast<std::uint32_t>(max_depth_));
    }
    // Slots are others then.
    void rebuild(std::span<const Aabb> bounds) {
        rows_.assign(moving_.rows().begin(), moving_.rows().end());
        build(moving_, bounds);
        note_built();
        moved_.clear();
        for (std::uint32_t slot = 0; slot < moving_.size(); ++slot)
            if (has_moved_[moving_.row(slot)]) moved_.push_back(slot);
    }
    void note_built() {
        refiled_ = 0;
        built_surface_ = moving_.surface();
    }

    // All at once costs less than one by one.
    void find_all_pairs() {
        kept_.clear();
        const auto add = [this](std::uint32_t a, std::uint32_t b) {
            kept_.push_back({std::min(a, b), std::max(a, b)});
        };
        for (std::uint32_t slot = 0; slot < moving_.size(); ++slot)
            static_.search(moving_.bounds(slot).probe(), [&](std::uint32_t row) { add(moving_.row(slot), row); });
        moving_.search_all(add);
    }

    // Of two that have both moved the first one finds the pair.
    void find_partners(std::uint32_t slot) {
        const std::uint32_t row = moving_.row(slot);
        const Bounds probe = moving_.bounds(slot).probe();
        const auto add = [&](std::uint32_t other) { kept_.push_back({std::min(row, other), std::max(row, other)}); };
        static_.search(probe, add);
        moving_.search(probe, [&](std::uint32_t other) {
            if (other != row && (row < other || !has_moved_[other])) add(other);
        });
    }

    std::uint64_t generation_ = 0;
    std::vector<std::uint32_t> rows_;      // to build a tree of
    std::vector<std::uint32_t> moved_;     // slots, since the last call
    std::vector<std::uint8_t> has_moved_;  // by row
    BoxTree<Space> static_, moving_;
    std::size_t refiled_ = 0;   // since the moving tree was built
    double built_surface_ = 0;  // of the moving tree then
    std::vector<Pair> kept_;
};

}  // namespace kolize
