// One scene in kolize and in other engines behind one interface: the same start, one thread, one time per step.
#pragma once

#include <kolize/simulation.h>

#include <memory>
#include <string>
#include <vector>

namespace bench {

// A simulation that goes on by one dt at a time.
class Engine {
public:
    virtual ~Engine() = default;
    virtual void step() = 0;
    // Of a dynamic body of the scene; frames and units as in World.
    virtual kolize::BodyState state(std::uint32_t body) const = 0;
    // Appends the pairs that overlapped in the last step, in any order, repeated or not.
    virtual void add_touching(std::vector<kolize::Pair>& pairs) const = 0;
    // The share of the time in step() that is the simulation itself, where the engine also takes measurements there.
    virtual double share() const { return 1; }
};

// What kolize needs to run a scene.
struct Workshop {
    const kolize::PluginLibrary& plugins;
    kolize::Host& host;
};

// The scene's world with the walls of its rooms as bodies, made of what [narrowphase] walls says: half-spaces or boxes.
kolize::World world_with_walls(const kolize::Scene& scene, const Workshop& workshop);

struct BulletOptions {
    // Overlaps are pushed apart without adding velocity at every depth, not only beyond 4 cm, and contacts act when
    // bodies overlap, not before: the settings that keep most energy.
    bool elastic = false;
    bool swept = false;  // continuous collision detection by a swept sphere in each body
};
struct OdeOptions {
    int contacts_per_pair = 32;
    double push = kolize::infinity;  // m/s; fastest parting of overlapping bodies beyond the bounce
};
// Both throw Error if the bodies differ in restitution or friction: each engine has its own rule to combine them.
std::unique_ptr<Engine> make_bullet(const kolize::World& world, double dt, const BulletOptions& options);
std::unique_ptr<Engine> make_ode(const kolize::World& world, double dt, const OdeOptions& options);

// bullet, bullet_elastic, bullet_swept, ode, ode_8 (contacts a pair), ode_elastic (push at most 1 cm/s)
const std::vector<std::string>& rival_names();
// `name`: kolize or one of rival_names().
std::unique_ptr<Engine> make_engine(const std::string& name, const kolize::Scene& scene, const Workshop& workshop,
                                    std::uint64_t steps);

// "Bullet 3.24 (float), ODE 0.16.2 (double)": as they are linked.
std::string rival_versions();
std::string bullet_version();
std::string ode_version();

// The material that all bodies have in common. Throws Error if there is none.
const kolize::Material& common_material(const kolize::World& world);

}  // namespace bench
