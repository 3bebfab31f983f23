// A narrowphase that is asked beside the one that drives a run, about those pairs whose shapes it takes.
#pragma once

#include <kolize/mesh_narrowphase.h>
#include <kolize/plugin_library.h>

#include <optional>

namespace kolize::cli {

class Witness {
public:
    // Throws Error as PluginLibrary::make does.
    Witness(const StageConfig& config, const PluginLibrary& library, Host& host);

    const std::string& name() const { return config_.plugin; }
    const StageConfig& config() const { return config_; }
    const LoadedPlugin& plugin() const { return *plugin_; }
    Narrowphase& stage() const { return *stage_; }
    Detail gives() const { return stage_->gives(); }

    // To be called before the first question, and again whenever the world's shapes change. Shapes that the plugin
    // does not take are kept from it.
    void prepare(const World& world);
    bool takes(const World& world, const Pair& pair) const;

    // Whether any triangles of two meshes intersect; the world's shapes are those prepared for. Nothing where the
    // plugin does not look at triangles. Meshes need not be closed.
    std::optional<bool> surfaces_meet(const World& world, const Pair& pair) const;
    // All triangles that do, in canonical order.
    std::vector<TriangleHit> meeting_triangles(const World& world, const Pair& pair) const;
    bool looks_at_triangles() const;

private:
    bool takes_shape(const Shape& shape) const;
    TriangleHits intersect(const World& world, const Pair& pair, bool first_only) const;

    StageConfig config_;
    const LoadedPlugin* plugin_;
    StagePtr<Narrowphase> stage_;
    World prepared_;
};

// Two meshes in the frame of the first of them, in the order in which MeshNarrowphase looks at them.
MeshPair mesh_pair(const World& world, const Pair& pair);

// The rows of each of the pairs. Throws std::runtime_error for a row that belongs to none of them or stands out of
// order.
std::vector<std::span<const Contact>> rows_of_pairs(std::span<const Pair> pairs, std::span<const Contact> rows);

}  // namespace kolize::cli
