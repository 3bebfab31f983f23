// What a plugin library exports: one constant, kolize_plugin, that begins with an ABI tag.
//
//     class Grid final : public kolize::Broadphase { ... };
//     KOLIZE_PLUGIN(Grid, .name = "grid", .summary = "uniform grid ...", .source = "Ericson 2005, 7.1")
//
// The tag is compared field by field before anything else of the library is read.
#pragma once

#include <kolize/broadphase.h>
#include <kolize/narrowphase.h>
#include <kolize/parameters.h>
#include <kolize/renderer.h>
#include <kolize/response.h>

#include <cstddef>
#include <cstdint>

namespace kolize {

inline constexpr std::uint32_t plugin_api = 5;  // raised when a stage contract changes

constexpr std::uint64_t layout_hash();

struct AbiTag {
    std::uint64_t magic = 0x6b6f6c697a650a1a;  // "kolize" LF SUB
    std::uint32_t api = plugin_api;
    std::uint32_t scalar_bytes = sizeof(Vec3::Scalar);
    std::uint32_t eigen_alignment = EIGEN_MAX_ALIGN_BYTES;
    std::uint32_t eigen_version = EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION;
    std::uint32_t cxx11_strings = _GLIBCXX_USE_CXX11_ABI;
#ifdef _GLIBCXX_DEBUG
    std::uint32_t debug_stl = 1;
#else
    std::uint32_t debug_stl = 0;
#endif
    std::uint64_t layout = layout_hash();
};

// What a narrowphase can do at most, and what a response cannot do without. Fields that do not belong to the stage
// keep their defaults.
struct Capabilities {
    std::uint32_t shape_kinds = all_shape_kinds;  // narrowphase: bits of ShapeKind that it takes, in any combination
    Detail gives = Detail::manifold;              // narrowphase: the most it can give, whatever its parameters
    bool time_of_impact = false;                  // narrowphase: finds when moving bodies meet (stepping `continuous`)
    Detail needs = Detail::overlap;               // response: refused with a narrowphase that gives less
    Detail uses = Detail::overlap;                // response: more than this is not computed for it (>= needs)
    bool allocates = false;                       // calls allocate even when warm, because a library it uses does
    bool exact = false;  // broadphase: reports no pair whose boxes are apart. Narrowphase: decides whether the surfaces
                         // of meshes meet as real arithmetic on the coordinates in the frame of body A would
    bool chooses = false;           // broadphase: see Broadphase::choose_from
    bool moves = false;             // response: moves bodies apart that overlap
    bool rests = false;             // response: models resting contact
    bool sleeps = false;            // response: lays bodies to sleep, and wakes them
    bool friction = false;          // response: models friction; where none does, the friction of a scene has no effect
    // Response: treats the dynamic bodies that only it serves as their bounding spheres. Narrowphase: answers for bounding
    // volumes in place of all bodies.
    bool bounding_spheres = false;
    const char* outline = nullptr;  // broadphase: what outline() gives: "cells", "planes", "spheres"
    bool crossings = false;         // narrowphase: find_crossings() gives where surfaces cross
};

struct PluginDescriptor {
    AbiTag abi;
    StageKind stage = StageKind::broadphase;
    const char* name = nullptr;      // the word in [broadphase] plugin = "..."
    const char* summary = nullptr;   // one line
    const char* source = nullptr;    // paper or book, section
    const char* cost = nullptr;      // time and memory, in sentences
    const char* accuracy = nullptr;  // what it gets right, and what not
    const char* choose = nullptr;    // when to take it, and when something else
    Capabilities capabilities;
    void (*declare)(ParameterList& list) = nullptr;
    Stage* (*create)() = nullptr;
    void (*destroy)(Stage* stage) = nullptr;
};

// A fold of the sizes and offsets of the types that cross the boundary: catches stale plugins that kept the API number.
constexpr std::uint64_t layout_hash() {
    std::uint64_t h = 14695981039346656037ull;
    for (std::uint64_t size : {sizeof(World),
                               sizeof(Shape),
                               sizeof(Mesh),
                               sizeof(HierarchyNode),
                               sizeof(Material),
                               sizeof(Contact),
                               sizeof(Contacts),
                               sizeof(Aabb),
                               sizeof(Pair),
                               sizeof(BroadphaseInput),
                               sizeof(NarrowphaseInput),
                               sizeof(ResponseInput),
                               sizeof(ResponseOutput),
                               sizeof(Event),
                               sizeof(Room),
                               sizeof(Frame),
                               sizeof(Light),
                               sizeof(Explosion),
                               sizeof(Image),
                               sizeof(Line),
                               sizeof(Caption),
                               sizeof(Skin),
                               sizeof(WindowEvent),
                               sizeof(PanelItem),
                               sizeof(Outline),
                               sizeof(CrossingLine),
                               sizeof(Parameter),
                               sizeof(Value),
                               sizeof(PluginDescriptor),
                               sizeof(Capabilities),
                               offsetof(PluginDescriptor, create),
                               offsetof(Contact, normal),
                               offsetof(Contact, impulse),
                               offsetof(Contact, friction),
                               offsetof(HierarchyNode, first),
                               offsetof(Shape, mesh),
                               offsetof(Shape, moments),
                               offsetof(World, removed),
                               offsetof(World, asleep),
                               offsetof(World, forces)})
        h = (h ^ size) * 1099511628211ull;
    return h;
}

namespace detail {
template <class T>
void declare(ParameterList& list) {
    if constexpr (requires(Parameters<T> & p) { T::parameters(p); }) {
        const T defaults{};
        Parameters<T> parameters(list, defaults);
        T::parameters(parameters);
    }
}
}  // namespace detail

struct PluginText {
    const char* name;
    const char* summary;
    const char* source;
    const char* cost = "";
    const char* accuracy = "";
    const char* choose = "";
    Capabilities capabilities = {};
};

template <class T>
constexpr PluginDescriptor describe(const PluginText& text) {
    PluginDescriptor d;
    d.stage = T::kind;
    d.name = text.name;
    d.summary = text.summary;
    d.source = text.source;
    d.cost = text.cost;
    d.accuracy = text.accuracy;
    d.choose = text.choose;
    d.capabilities = text.capabilities;
    d.declare = &detail::declare<T>;
    d.create = []() -> Stage* { return new T; };
    d.destroy = [](Stage* stage) { delete stage; };
    return d;
}

}  // namespace kolize

// The one exported symbol. Constant-initialised: reading it runs no code of the plugin.
#define KOLIZE_PLUGIN(Class, ...)                                       \
    extern "C" KOLIZE_API const kolize::PluginDescriptor kolize_plugin; \
    constinit const kolize::PluginDescriptor kolize_plugin = kolize::describe<Class>(kolize::PluginText{__VA_ARGS__});
