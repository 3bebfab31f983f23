#include "overlay/overlay.h"

#include "overlay/pens.h"

#include <kolize/error.h>

#include <algorithm>
#include <charconv>
#include <set>

namespace kolize::cli {
namespace {

constexpr Rgba moving_colour = {120, 220, 140, 255}, static_colour = {140, 150, 165, 140},
               pair_colour = {255, 220, 90, 255}, rejected_colour = {255, 110, 90, 255},
               segment_colour = {255, 60, 200, 255}, contact_colour = {255, 255, 255, 255},
               normal_colour = {90, 200, 255, 255}, impulse_colour = {255, 140, 40, 255};

// What the drawing functions work with.
struct Page {
    const Simulation& simulation;
    std::optional<std::uint32_t> level;
    std::vector<Line>& lines;

    const World& world() const { return simulation.world(); }
    bool wants(std::uint32_t other) const { return !level || *level == other; }
    // m; of the smaller of two bodies that have one.
    double size_of(const Contact& c) const {
        double size = infinity;
        for (const std::uint32_t body : {c.a, c.b}) {
            const Shape& shape = world().shape_of(body);
            if (shape.kind != ShapeKind::half_space) size = std::min(size, shape.radius);
        }
        return size;
    }
};

void draw_bounds(Page& page) {
    const World& world = page.world();
    for (std::uint32_t body = 0; body < world.size(); ++body) {
        const Aabb box = world_bounds(world, body);
        if (!world.removed[body] && box.finite() && !is_room_wall(world, body))
            draw_box(box, world.is_static[body] ? static_colour : moving_colour, page.lines);
    }
}

void draw_outline(Page& page) {
    Outline outline;
    page.simulation.outline(outline);
    for (const Outline::Box& piece : outline.boxes)
        if (page.wants(piece.level)) draw_box(piece.box, colour_of(piece.level), page.lines);
    for (const Outline::Ball& ball : outline.balls)
        if (page.wants(ball.level)) draw_ball(ball.center, ball.radius, colour_of(ball.level), page.lines);
}

// Where a pair's line ends at a body: its centre, or, at a half-space, the foot of the other one's centre.
Vec3 end_at(const World& world, std::uint32_t body, std::uint32_t other) {
    const Shape& shape = world.shape_of(body);
    if (shape.kind != ShapeKind::half_space) return world.position[body];
    const Vec3 normal = world.orientation[body] * shape.normal;
    return world.position[other] - normal.dot(world.position[other] - world.position[body]) * normal;
}

void draw_pair(Page& page, const Pair& pair, const Rgba& colour) {
    page.lines.push_back({end_at(page.world(), pair.a, pair.b), end_at(page.world(), pair.b, pair.a), colour});
}

void draw_pairs(Page& page) {
    for (const Pair& pair : page.simulation.pairs()) draw_pair(page, pair, pair_colour);
}

void draw_rejected(Page& page) {
    std::set<Pair> touching;
    for (const Contact& c : page.simulation.contacts().rows) touching.insert({c.a, c.b});
    for (const Pair& pair : page.simulation.pairs())
        if (!touching.contains(pair)) draw_pair(page, pair, rejected_colour);
}

void draw_crossings(Page& page, bool by_loop) {
    std::vector<CrossingLine> crossings;
    page.simulation.find_crossings(crossings);
    for (const CrossingLine& line : crossings)
        page.lines.push_back({line.from, line.to, by_loop ? colour_of(line.loop) : segment_colour});
}

// Bodies may have moved on since the contact was found; static ones have not.
Vec3 place_of(const World& world, const Contact& c) {
    return world.is_static[c.b] ? Vec3(world.position[c.b] + c.arm_b) : Vec3(world.position[c.a] + c.arm_a);
}

void draw_contacts(Page& page) {
    for (const Contact& c : page.simulation.contacts().rows)
        if (!c.normal.isZero(0))
            draw_point(place_of(page.world(), c), 0.12 * page.size_of(c), contact_colour, page.lines);
}

void draw_normals(Page& page) {
    for (const Contact& c : page.simulation.contacts().rows)
        if (!c.normal.isZero(0))
            draw_arrow(place_of(page.world(), c), 0.8 * page.size_of(c) * c.normal, normal_colour, page.lines);
}

// The largest impulse of the step is an arrow as long as the normals'.
void draw_impulses(Page& page) {
    double largest = 0;
    for (const Contact& c : page.simulation.contacts().rows) largest = std::max(largest, c.impulse);
    for (const Contact& c : page.simulation.contacts().rows)
        if (c.impulse > 0)
            draw_arrow(place_of(page.world(), c), 0.8 * page.size_of(c) * (c.impulse / largest) * c.normal,
                       impulse_colour, page.lines);
}

enum class Need { nothing, outline, crossings, normals };

struct Entry {
    OverlayText text;
    Need need;
    void (*draw)(Page&);
};

constexpr const char* triangles = "a narrowphase that finds where surfaces cross";
constexpr const char* touching = "a response that asks for normals";

const std::vector<Entry>& entries() {
    static const std::vector<Entry> all = {
        {{"bounds", "boxes around bodies: green if they move, grey if not", "nothing"}, Need::nothing, draw_bounds},
        {{"cells", "cells of a grid with something in them, coloured by level",
          "a broadphase that divides space by cells"},
         Need::outline,
         draw_outline},
        {{"planes", "planes that halve space, coloured by level", "a broadphase that divides space by planes"},
         Need::outline,
         draw_outline},
        {{"spheres", "spheres of a tree, coloured by level", "a broadphase that divides space by spheres"},
         Need::outline,
         draw_outline},
        {{"pairs", "candidate pairs: what the broadphase found", "nothing"}, Need::nothing, draw_pairs},
        {{"rejected", "candidate pairs without a contact: what the narrowphase threw out", "nothing"},
         Need::nothing,
         draw_rejected},
        {{"segments", "segments in which surfaces cross", triangles},
         Need::crossings,
         [](Page& page) { draw_crossings(page, false); }},
        {{"loops", "the same, each closed curve in a colour of its own", triangles},
         Need::crossings,
         [](Page& page) { draw_crossings(page, true); }},
        {{"contacts", "contact points", touching}, Need::normals, draw_contacts},
        {{"normals", "contact normals, from body A to body B", touching}, Need::normals, draw_normals},
        {{"impulses", "impulses on body B, the largest of the step as long as a normal", touching},
         Need::normals,
         draw_impulses},
    };
    return all;
}

const Entry* find(const std::string& name) {
    const auto found =
        std::find_if(entries().begin(), entries().end(), [&](const Entry& entry) { return name == entry.text.name; });
    return found == entries().end() ? nullptr : &*found;
}

bool would_do(const Capabilities& c, const Entry& entry) {
    switch (entry.need) {
    case Need::outline: return c.outline && std::string(c.outline) == entry.text.name;
    case Need::crossings: return c.crossings;
    case Need::normals: return c.uses != Detail::overlap;
    default: return true;
    }
}

StageKind stage_of(Need need) {
    return need == Need::outline     ? StageKind::broadphase
           : need == Need::crossings ? StageKind::narrowphase
                                     : StageKind::response;
}

std::vector<std::string> plugins_in_force(const Simulation& simulation, StageKind stage) {
    if (stage == StageKind::broadphase) return {simulation.broadphase().plugin};
    if (stage == StageKind::narrowphase) return {simulation.narrowphase().plugin};
    std::vector<std::string> names;
    for (const EffectiveStage& response : simulation.responses()) names.push_back(response.plugin);
    return names;
}

std::string refusal(const Entry& entry, const Simulation& simulation, const PluginLibrary& plugins) {
    if (entry.need == Need::nothing) return "";
    const StageKind stage = stage_of(entry.need);
    std::string in_force, others;
    for (const std::string& name : plugins_in_force(simulation, stage)) {
        const LoadedPlugin* plugin = plugins.find(stage, name);
        if (plugin && would_do(plugin->descriptor->capabilities, entry)) return "";
        in_force += (in_force.empty() ? "'" : ", '") + name + "'";
    }
    for (const LoadedPlugin& plugin : plugins.plugins())
        if (plugin.descriptor->stage == stage && would_do(plugin.descriptor->capabilities, entry))
            others += (others.empty() ? "" : ", ") + std::string(plugin.descriptor->name);
    return "overlay '" + std::string(entry.text.name) + "' needs " + entry.text.needs + ", and " + in_force +
           " does not; " + (others.empty() ? "no plugin found does" : "these would do: " + others);
}

std::uint32_t parse_level(const std::string& name, const std::string& text) {
    std::uint32_t level = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), level);
    if (error != std::errc() || end != text.data() + text.size() || find(name)->need != Need::outline)
        throw Error("--overlay " + name + ":" + text +
                    ": a level is a number after cells, planes or spheres, as in spheres:3");
    return level;
}

}  // namespace

const std::vector<OverlayText>& overlay_texts() {
    static const std::vector<OverlayText> texts = [] {
        std::vector<OverlayText> all;
        for (const Entry& entry : entries()) all.push_back(entry.text);
        return all;
    }();
    return texts;
}

std::string overlay_refusal(const std::string& name, const Simulation& simulation, const PluginLibrary& plugins) {
    return refusal(*find(name), simulation, plugins);
}

Overlays::Overlays(const std::string& names) {
    for (std::size_t at = 0; at < names.size();) {
        const std::size_t end = std::min(names.find(',', at), names.size());
        const std::string word = names.substr(at, end - at);
        const std::size_t colon = std::min(word.find(':'), word.size());
        Shown shown{word.substr(0, colon), {}};
        if (!find(shown.name)) {
            std::string known;
            for (const OverlayText& text : overlay_texts())
                known += (known.empty() ? "" : ", ") + std::string(text.name);
            throw Error("--overlay " + word + ": there is no such overlay; there are " + known);
        }
        if (colon < word.size()) shown.level = parse_level(shown.name, word.substr(colon + 1));
        shown_.push_back(shown);
        at = end + 1;
    }
}

bool Overlays::is_shown(const std::string& name) const {
    return std::any_of(shown_.begin(), shown_.end(), [&](const Shown& shown) { return shown.name == name; });
}

void Overlays::show(const std::string& name, bool shown) {
    std::erase_if(shown_, [&](const Shown& other) { return other.name == name; });
    if (shown) shown_.push_back({name, {}});
}

void Overlays::require(const Simulation& simulation, const PluginLibrary& plugins) const {
    for (const Shown& shown : shown_)
        if (const std::string why = overlay_refusal(shown.name, simulation, plugins); !why.empty()) throw Error(why);
}

void Overlays::draw(const Simulation& simulation, const PluginLibrary& plugins, std::vector<Line>& lines) const {
    for (const Shown& shown : shown_) {
        const Entry& entry = *find(shown.name);
        Page page{simulation, shown.level, lines};
        if (refusal(entry, simulation, plugins).empty()) entry.draw(page);
    }
}

}  // namespace kolize::cli
