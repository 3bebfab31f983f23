// One ring of stages around one world: what a stepping strategy drives.
#pragma once

#include "measure.h"

#include <kolize/simulation.h>

namespace kolize {

struct Rule {
    const LoadedPlugin* plugin;
    StagePtr<Response> stage;
    std::vector<std::string> kinds;
    Detail detail;                  // what the narrowphase is asked for on behalf of this rule
    std::vector<Contact> contacts;  // of this step, canonical order
    std::vector<std::size_t> rows;  // where they stand in Pipeline::contacts
    std::vector<std::uint8_t> hit;  // see ResponseInput
};

class Pipeline {
public:
    Pipeline(const Scene& scene, const PluginLibrary& plugins, Host& host, std::uint64_t expected_steps);

    // Free motion of all bodies.
    void integrate(double dt);
    // Pairs and contacts of the present poses. Measures nothing but time: a stepping may look as often as it likes.
    void detect();
    // Hands the contacts to their rules and takes removed bodies out.
    void respond(double dt);

    // Contacts whose bodies approach each other at the contact point.
    bool approaching() const;

    // Poses and velocities, kept in buffers that are allocated once.
    void save();
    void restore();
    // Puts one body's pose back to the saved one. It keeps its velocity, and its angular velocity in its own frame.
    void put_back(std::uint32_t body);

    void begin_step();
    void end_step(double dt);

    World world;
    std::vector<Pair> pairs;
    Contacts contacts;
    std::vector<Event> events;
    Measure measure;

    const LoadedPlugin* broadphase_plugin;
    const LoadedPlugin* narrowphase_plugin;
    StagePtr<Broadphase> broadphase;
    StagePtr<Narrowphase> narrowphase;
    std::vector<Rule> rules;
    ShapeKind walls = ShapeKind::half_space;

private:
    static constexpr std::uint32_t no_rule = ~0u;

    void negotiate(const PipelineConfig& config, const PluginLibrary& plugins);
    void use_bounding_spheres();
    void reserve();
    void number_rows();
    void update_bounds();
    void find_pairs();
    void add_half_space_pairs();
    void route_pairs();
    void find_contacts();
    void respond_with(Rule& rule, double dt);
    void remove_bodies();

    template <class Call>
    void run_stage(StageKind kind, const char* plugin, Call&& call);

    Host& host_;
    std::unique_ptr<Integrator> integrator_;
    std::vector<std::uint32_t> rule_of_kinds_;  // kinds x kinds -> rule; no_rule where none fits
    std::vector<std::uint32_t> rows_;           // broadphase row -> body
    std::vector<std::uint32_t> unbounded_;      // half-space bodies
    std::vector<Aabb> bounds_;                  // by row
    std::vector<std::uint8_t> row_is_static_;
    std::uint64_t generation_ = 0;
    std::vector<Pair> found_;   // what the broadphase said, rows
    std::vector<Pair> routed_;  // pairs that a rule takes and whose boxes do overlap
    std::vector<Detail> detail_;
    std::vector<std::uint32_t> rule_;  // by routed pair
    struct Saved {
        std::vector<Vec3> position, velocity, angular_velocity;
        std::vector<Quat> orientation;
    } saved_;
};

}  // namespace kolize
