#include "witness.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace kolize::cli {

Witness::Witness(const StageConfig& config, const PluginLibrary& library, Host& host)
    : config_(config),
      plugin_(&library.require(StageKind::narrowphase, config.plugin, config.where)),
      stage_(library.make<Narrowphase>(config, host)) {}

bool Witness::takes_shape(const Shape& shape) const {
    return (plugin_->descriptor->capabilities.shape_kinds & bit(shape.kind)) != 0;
}

bool Witness::takes(const World& world, const Pair& pair) const {
    return takes_shape(world.shape_of(pair.a)) && takes_shape(world.shape_of(pair.b));
}

void Witness::prepare(const World& world) {
    prepared_ = world;
    std::vector<Shape>& shapes = prepared_.shapes;
    const auto taken = std::find_if(shapes.begin(), shapes.end(), [&](const Shape& s) { return takes_shape(s); });
    if (taken == shapes.end()) return;  // it will not be asked
    const Shape stand_in = *taken;
    for (Shape& shape : shapes)
        if (!takes_shape(shape)) shape = stand_in;
    stage_->prepare(prepared_);
}

bool Witness::looks_at_triangles() const { return dynamic_cast<const MeshNarrowphase*>(stage_.get()) != nullptr; }

TriangleHits Witness::intersect(const World& world, const Pair& pair, bool first_only) const {
    MeshPair meshes = mesh_pair(world, pair);
    meshes.first_only = first_only;
    TriangleHits found;
    dynamic_cast<const MeshNarrowphase&>(*stage_).intersect_meshes(meshes, found);
    return found;
}

std::optional<bool> Witness::surfaces_meet(const World& world, const Pair& pair) const {
    if (!looks_at_triangles()) return std::nullopt;
    return !intersect(world, pair, true).hits.empty();
}

std::vector<TriangleHit> Witness::meeting_triangles(const World& world, const Pair& pair) const {
    std::vector<TriangleHit> hits = intersect(world, pair, false).hits;
    std::sort(hits.begin(), hits.end(),
              [](const TriangleHit& x, const TriangleHit& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    return hits;
}

MeshPair mesh_pair(const World& world, const Pair& pair) {
    const bool in_order = world.shape_of(pair.a).kind <= world.shape_of(pair.b).kind;
    const std::uint32_t a = in_order ? pair.a : pair.b, b = in_order ? pair.b : pair.a;
    const Mat3 rotation = world.orientation[a].toRotationMatrix();
    MeshPair meshes{*world.shape_of(a).mesh, *world.shape_of(b).mesh, {}};
    meshes.b_to_a.rotation = rotation.transpose() * world.orientation[b].toRotationMatrix();
    meshes.b_to_a.translation = rotation.transpose() * (world.position[b] - world.position[a]);
    meshes.shape_a = world.shape[a];
    meshes.shape_b = world.shape[b];
    return meshes;
}

std::vector<std::span<const Contact>> rows_of_pairs(std::span<const Pair> pairs, std::span<const Contact> rows) {
    std::vector<std::span<const Contact>> found;
    std::size_t begin = 0;
    for (const Pair& pair : pairs) {
        std::size_t end = begin;
        while (end < rows.size() && rows[end].a == pair.a && rows[end].b == pair.b) ++end;
        found.push_back(rows.subspan(begin, end - begin));
        begin = end;
    }
    if (begin < rows.size())
        throw std::runtime_error("it reported a contact of bodies " + std::to_string(rows[begin].a) + " and " +
                                 std::to_string(rows[begin].b) + ", about which it was not asked there");
    return found;
}

}  // namespace kolize::cli
