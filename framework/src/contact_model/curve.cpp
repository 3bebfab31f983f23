#include "contact_model/curve.h"

#include <algorithm>
#include <tuple>

namespace kolize {

namespace {

using Ends = std::vector<std::pair<std::uint64_t, std::uint32_t>>;
using Parent = std::uint32_t ContourSegment::*;

void collect_ends(ContourScratch& scratch) {
    scratch.ends.clear();
    for (std::uint32_t i = 0; i < scratch.segments.size(); ++i) {
        scratch.ends.emplace_back(scratch.segments[i].from.key, i);
        scratch.ends.emplace_back(scratch.segments[i].to.key, i);
    }
    std::sort(scratch.ends.begin(), scratch.ends.end());
}

const Crossing& crossing_of(const ContourScratch& scratch, const Ends::value_type& end) {
    const ContourSegment& segment = scratch.segments[end.second];
    return segment.from.key == end.first ? segment.from : segment.to;
}

bool is_found(std::span<const ContourSegment> segments, std::uint32_t a, std::uint32_t b) {
    return std::any_of(segments.begin(), segments.end(),
                       [&](const ContourSegment& s) { return s.triangle_a == a && s.triangle_b == b; });
}

// Appends the segment beyond a crossing that has only one.
void follow(const MeshPair& pair, Nudge& nudge, std::size_t known, const Ends::value_type& end,
            ContourScratch& scratch) {
    const Crossing& crossing = crossing_of(scratch, end);
    std::uint32_t a = scratch.segments[end.second].triangle_a, b = scratch.segments[end.second].triangle_b;
    std::uint32_t& beyond = crossing.edge_of_a ? a : b;
    const Edge& edge = (crossing.edge_of_a ? pair.a : pair.b).edges[crossing.edge];
    beyond = edge.t0 == beyond ? edge.t1 : edge.t0;
    // The next segment may have been reached from its other end already.
    if (is_found(std::span(scratch.segments).subspan(known), a, b)) return;
    if (const auto segment = cross(pair, nudge, a, b)) scratch.segments.push_back(*segment);
}

// One more segment beyond each open end.
void extend(const MeshPair& pair, Nudge& nudge, ContourScratch& scratch) {
    const std::size_t known = scratch.segments.size();
    const Ends& ends = scratch.ends;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const bool shared = (i > 0 && ends[i - 1].first == ends[i].first) ||
                            (i + 1 < ends.size() && ends[i + 1].first == ends[i].first);
        if (!shared) follow(pair, nudge, known, ends[i], scratch);
    }
}

std::uint32_t root(std::vector<ContourSegment>& segments, std::uint32_t i, Parent parent) {
    while (segments[i].*parent != i) i = segments[i].*parent = segments[segments[i].*parent].*parent;
    return i;
}

// The lower root wins: a set is named after its first segment.
void unite(std::vector<ContourSegment>& segments, std::uint32_t i, std::uint32_t j, Parent parent) {
    const auto [low, high] = std::minmax({root(segments, i, parent), root(segments, j, parent)});
    segments[high].*parent = low;
}

void settle(std::vector<ContourSegment>& segments, Parent parent) {
    for (std::uint32_t i = 0; i < segments.size(); ++i) segments[i].*parent = root(segments, i, parent);
}

void find_loops(ContourScratch& scratch) {
    auto& segments = scratch.segments;
    for (std::uint32_t i = 0; i < segments.size(); ++i) segments[i].loop = i;
    for (std::size_t i = 1; i < scratch.ends.size(); ++i)
        if (scratch.ends[i].first == scratch.ends[i - 1].first)
            unite(segments, scratch.ends[i].second, scratch.ends[i - 1].second, &ContourSegment::loop);
    settle(segments, &ContourSegment::loop);
    for (ContourSegment& s : segments) s.region = s.loop;
}

// Where an edge goes in at one crossing and out at the next, both bound the same part of the overlap.
void join_along_edge(std::span<const Ends::value_type> crossings, ContourScratch& scratch) {
    auto& order = scratch.along_edge;
    order.clear();
    for (std::uint32_t i = 0; i < crossings.size(); ++i)
        if (i == 0 || crossings[i].first != crossings[i - 1].first) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
        return std::tie(crossing_of(scratch, crossings[i]).part, i) <
               std::tie(crossing_of(scratch, crossings[j]).part, j);
    });
    for (std::size_t k = 1; k < order.size(); ++k)
        if (crossing_of(scratch, crossings[order[k - 1]]).goes_in)
            unite(scratch.segments, crossings[order[k - 1]].second, crossings[order[k]].second,
                  &ContourSegment::region);
}

// Crossings of one edge stand side by side in `ends`, and each of them twice.
void visit_edges(const MeshPair& pair, ContourScratch& scratch) {
    scratch.pierced_a.reset(pair.a.edges.size());
    scratch.pierced_b.reset(pair.b.edges.size());
    scratch.repeated_a.reset(pair.a.edges.size());
    scratch.repeated_b.reset(pair.b.edges.size());
    const Ends& ends = scratch.ends;
    for (std::size_t begin = 0, end = 0; begin < ends.size(); begin = end) {
        const auto edge_of = [&](std::size_t i) { return ends[i].first >> 31; };
        while (end < ends.size() && edge_of(end) == edge_of(begin)) ++end;
        const Crossing& first = crossing_of(scratch, ends[begin]);
        (first.edge_of_a ? scratch.pierced_a : scratch.pierced_b).set(first.edge);
        if (ends[end - 1].first == ends[begin].first) continue;
        (first.edge_of_a ? scratch.repeated_a : scratch.repeated_b).set(first.edge);
        join_along_edge(std::span(ends).subspan(begin, end - begin), scratch);
    }
}

// Floods the inside of one mesh from all regions at once, over edges that nothing pierces; floods that meet are one.
class InnerFlood {
public:
    InnerFlood(const Mesh& mesh, bool of_a, ContourScratch& scratch)
        : mesh_(mesh),
          scratch_(scratch),
          pierced_(of_a ? scratch.pierced_a : scratch.pierced_b),
          repeated_(of_a ? scratch.repeated_a : scratch.repeated_b),
          triangles_(of_a ? scratch.patch_a.triangles : scratch.patch_b.triangles),
          of_a_(of_a) {}

    void run() {
        triangles_.clear();
        scratch_.vertices.reset(mesh_.vertices.size());
        scratch_.triangles.reset(mesh_.triangles.size());
        scratch_.inside_of.resize(std::max(scratch_.inside_of.size(), mesh_.vertices.size()));
        for (std::uint32_t i = 0; i < scratch_.segments.size(); ++i) {
            const ContourSegment& segment = scratch_.segments[i];
            add(of_a_ ? segment.triangle_a : segment.triangle_b);
            for (const Crossing* c : {&segment.from, &segment.to})
                if (c->edge_of_a == of_a_ && !repeated_.test(c->edge)) reach(c->inner_vertex, i);
        }
        for (std::size_t i = 0; i < triangles_.size(); ++i)
            for (const std::uint32_t e : mesh_.triangle_edges[triangles_[i]])
                if (!pierced_.test(e)) spread(mesh_.edges[e]);
    }

private:
    void add(std::uint32_t triangle) {
        if (scratch_.triangles.test(triangle)) return;
        scratch_.triangles.set(triangle);
        triangles_.push_back(triangle);
    }
    void reach(std::uint32_t vertex, std::uint32_t segment) {
        if (scratch_.vertices.test(vertex))
            return unite(scratch_.segments, scratch_.inside_of[vertex], segment, &ContourSegment::region);
        scratch_.vertices.set(vertex);
        scratch_.inside_of[vertex] = segment;
    }
    void spread(const Edge& edge) {
        const bool from_v0 = scratch_.vertices.test(edge.v0);
        if (!from_v0 && !scratch_.vertices.test(edge.v1)) return;
        reach(from_v0 ? edge.v1 : edge.v0, scratch_.inside_of[from_v0 ? edge.v0 : edge.v1]);
        add(edge.t0);
        add(edge.t1);
    }

    const Mesh& mesh_;
    ContourScratch& scratch_;
    const Marks &pierced_, &repeated_;
    std::vector<std::uint32_t>& triangles_;
    bool of_a_;
};

bool is_one_loop(std::span<const ContourSegment> segments) {
    return std::all_of(segments.begin(), segments.end(), [](const ContourSegment& s) { return s.region == 0; });
}

}  // namespace

void find_segments(const MeshPair& pair, std::span<const TriangleHit> hits, Nudge& nudge, ContourScratch& scratch) {
    scratch.segments.clear();
    for (const TriangleHit& hit : hits)
        if (const auto segment = cross(pair, nudge, hit.a, hit.b)) scratch.segments.push_back(*segment);
    collect_ends(scratch);
    const std::size_t found = scratch.segments.size();
    for (std::size_t before = 0; before != scratch.segments.size();) {
        before = scratch.segments.size();
        extend(pair, nudge, scratch);
        if (before != scratch.segments.size()) collect_ends(scratch);
    }
    if (found == scratch.segments.size()) return;
    std::sort(scratch.segments.begin(), scratch.segments.end(), [](const ContourSegment& s, const ContourSegment& t) {
        return std::tie(s.triangle_a, s.triangle_b) < std::tie(t.triangle_a, t.triangle_b);
    });
    collect_ends(scratch);
}

void join_segments(const MeshPair& pair, ContourScratch& scratch) {
    find_loops(scratch);
    visit_edges(pair, scratch);
    settle(scratch.segments, &ContourSegment::region);
    if (is_one_loop(scratch.segments)) return;
    InnerFlood(pair.a, true, scratch).run();
    InnerFlood(pair.b, false, scratch).run();
    settle(scratch.segments, &ContourSegment::region);
}

bool surfaces_cross(const MeshPair& pair, std::span<const TriangleHit> hits) {
    Nudge nudge(pair.b_to_a.translation);
    return std::any_of(hits.begin(), hits.end(),
                       [&](const TriangleHit& hit) { return cross(pair, nudge, hit.a, hit.b).has_value(); });
}

}  // namespace kolize
