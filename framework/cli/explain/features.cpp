#include "explain/features.h"

#include "explain/thickness.h"

#include <algorithm>

namespace kolize::cli {

namespace {

std::string quoted(const std::string& name) { return "'" + name + "'"; }
std::string bodies(std::size_t n) { return std::to_string(n) + (n == 1 ? " body" : " bodies"); }
std::string rooms(std::size_t n) { return std::to_string(n) + (n == 1 ? " room" : " rooms"); }

class Explainer {
public:
    Explainer(const Scene& scene, const Simulation& simulation, const PluginLibrary& plugins)
        : scene_(scene),
          simulation_(simulation),
          plugins_(plugins),
          world_(simulation.world()),
          pipeline_(simulation.pipeline()),
          result_(simulation.result()) {
        for (std::uint32_t body = 0; body < world_.size(); ++body) (world_.is_static[body] ? statics_ : movers_)++;
    }

    std::vector<Feature> run() {
        explain_pairs();
        explain_statics();
        explain_detail();
        explain_bounding_spheres();
        explain_walls();
        explain_cull();
        explain_leaps();
        explain_friction();
        explain_rest();
        explain_forces();
        explain_gyration();
        explain_ledger();
        return std::move(features_);
    }

private:
    void add(Feature feature) { features_.push_back(std::move(feature)); }

    const Capabilities& response(std::size_t rule) const {
        return plugins_.require(StageKind::response, pipeline_.responses[rule].stage.plugin).descriptor->capabilities;
    }
    const Capabilities& narrowphase() const {
        return plugins_.require(StageKind::narrowphase, pipeline_.narrowphase.plugin).descriptor->capabilities;
    }

    void explain_pairs() {
        const double all = 0.5 * static_cast<double>(world_.size()) * static_cast<double>(world_.size() - 1);
        const double found =
            static_cast<double>(result_.pairs) / static_cast<double>(std::max<std::uint64_t>(1, result_.steps));
        const bool brute = pipeline_.broadphase.plugin == "brute_force";
        add({"broadphase " + quoted(pipeline_.broadphase.plugin),
             !brute,
             bodies(world_.size()) + " make " + number(all) + " pairs, of which " + number(found) +
                 " a step have boxes that overlap",
             "",
             {{"broadphase.plugin", brute ? "grid" : "brute_force"}}});
    }

    void explain_statics() {
        const double pairs = 0.5 * static_cast<double>(statics_) * (static_cast<double>(statics_) - 1);
        add({"pairs of static bodies",
             false,
             number(pairs) + " of them: neither moves, so no response could do anything",
             "",
             {}});
    }

    void explain_detail() {
        for (std::size_t rule = 0; rule < pipeline_.responses.size(); ++rule) {
            const Detail uses = response(rule).uses, most = narrowphase().gives;
            const bool all = pipeline_.model.detail == "most" || uses >= most;
            const std::string name = quoted(pipeline_.responses[rule].stage.plugin);
            add({"contacts up to " + std::string(to_string(all ? most : uses)) + " for response " + name, all,
                 "it uses " + std::string(to_string(uses)) + "; narrowphase " + quoted(pipeline_.narrowphase.plugin) +
                     " could give " + to_string(most),
                 all ? "" : "another response takes these contacts, which uses more",
                 all && pipeline_.model.detail != "most"
                     ? Settings{}
                     : Settings{{"model.detail", pipeline_.model.detail == "most" ? "needed" : "most"}}});
        }
    }

    // Bodies whose shape the pipeline has exchanged for its bounding sphere.
    void explain_bounding_spheres() {
        std::size_t balls = 0, meant = 0;
        for (std::uint32_t body = 0; body < scene_.world.size(); ++body) {
            const bool is_ball = world_.shape_of(body).kind == ShapeKind::sphere;
            const bool was_ball = scene_.world.shape_of(body).kind == ShapeKind::sphere;
            balls += is_ball && !was_ball;
            meant += !was_ball && !world_.is_static[body];
        }
        if (meant == 0) return;
        add({"surfaces of bodies", balls < meant,
             balls == 0 ? "a rule that takes them wants where surfaces meet"
                        : std::to_string(balls) + " of " + std::to_string(meant) +
                              " are balls to the narrowphase: all rules that take them ask for bounding spheres",
             balls == 0 ? "" : "it matters where in its bounding sphere a body is",
             balls == 0 ? Settings{} : Settings{{"model.bounding_spheres", "false"}}});
    }

    void explain_walls() {
        if (scene_.rooms.empty()) return;
        const std::string walls = simulation_.walls();
        const bool endless = walls == "half_space";
        add({"walls of rooms as solids with an end",
             !endless,
             rooms(scene_.rooms.size()) + ", made of " + walls + (pipeline_.walls == "auto" ? "" : " as told"),
             endless ? "a body is to leave a room, or something is outside: behind a half-space everything is inside "
                       "the wall"
                     : "",
             {{"narrowphase.walls", endless ? "box" : "half_space"}}});
    }

    void explain_cull() {
        const bool culls = pipeline_.cull != "none";
        add({"bounding volumes in front of the narrowphase",
             culls,
             "narrowphase.cull is " + quoted(pipeline_.cull),
             "",
             {{"narrowphase.cull", culls ? "none" : "auto"}}});
    }

    void explain_leaps() {
        const double dt = pipeline_.step.dt / pipeline_.step.substeps;
        const LeapWatch watch(world_, dt);
        const Leap leap = watch.largest(world_);
        const bool continuous = pipeline_.step.mode == "continuous";
        const std::string who = quoted(world_.name[leap.body]);
        Feature feature{"what happens between the ends of a step",
                        continuous,
                        {},
                        {},
                        {{"step.mode", continuous ? "discrete" : "continuous"}}};
        if (!narrowphase().time_of_impact) feature.other.clear();
        if (leap.room == infinity)
            feature.because = "nothing that can be passed through is thinner than a half-space";
        else
            feature.because = "body " + who + " closes at most " + number(leap.travel) +
                              " m in a step; it and the thinnest thing that it may meet are " + number(leap.room) +
                              " m thick together: " + number(leap.share()) + " of that";
        if (!continuous && leap.room < infinity)
            feature.wrong_when = "a step covers more than that thickness: from dt = " + number(dt / leap.share()) +
                                 " s on, or " + number(1 / leap.share()) +
                                 " times the present speed; the run warns then";
        add(feature);
    }

    void explain_friction() {
        const auto rough = std::find_if(world_.materials.begin(), world_.materials.end(),
                                        [](const Material& m) { return m.friction > 0; });
        bool able = false;
        for (std::size_t rule = 0; rule < pipeline_.responses.size(); ++rule) able = able || response(rule).friction;
        if (rough == world_.materials.end())
            add({"friction",
                 false,
                 "no material has any",
                 able ? "a material gets friction above 0: it is then modelled"
                      : "a material gets friction above 0: no response here models it",
                 {}});
        else
            add({"friction",
                 able,
                 "material " + quoted(rough->name) + " has " + number(rough->friction) +
                     (able ? "" : ", but no response here models it"),
                 able ? "" : "now: take response 'solver'",
                 {}});
    }

    void explain_rest() {
        bool rests = false, sleeps = false;
        for (std::size_t rule = 0; rule < pipeline_.responses.size(); ++rule)
            rests = rests || response(rule).rests, sleeps = sleeps || response(rule).sleeps;
        rests = rests || pipeline_.step.mode == "continuous";
        const auto dull = std::find_if(world_.materials.begin(), world_.materials.end(),
                                       [](const Material& m) { return m.restitution < 1; });
        const bool needed = dull != world_.materials.end() && !world_.forces.gravity.isZero(0);
        add({"resting contact",
             rests,
             needed ? "there is gravity, and material " + quoted(dull->name) + " has restitution " +
                          number(dull->restitution)
                    : "nothing comes to rest: there is no gravity, or every restitution is 1",
             rests || !needed
                 ? ""
                 : "now: bodies that come to rest sink in and are counted as stuck; take response 'solver'",
             {}});
        const auto asleep = static_cast<std::size_t>(std::count(world_.asleep.begin(), world_.asleep.end(), 1));
        add({"bodies that rest, as if they moved",
             !sleeps || asleep == 0,
             std::to_string(asleep) + " of " + std::to_string(movers_) + " are asleep now",
             "",
             {}});
    }

    void explain_forces() {
        const Forces& forces = world_.forces;
        const bool any = !forces.gravity.isZero(0) || forces.drag > 0 ||
                         std::any_of(world_.constant_force.begin(), world_.constant_force.end(),
                                     [](const Vec3& f) { return !f.isZero(0); });
        add({"forces",
             any,
             any ? "gravity " + number(forces.gravity.norm()) + " m/s^2, drag " + number(forces.drag) + " 1/s"
                 : "gravity, drag and constant forces are 0: motion between impacts is free, and its work is not "
                   "measured",
             "",
             {}});
    }

    void explain_gyration() {
        std::size_t even = 0;
        for (std::uint32_t body = 0; body < world_.size(); ++body) {
            const Vec3& inverse = world_.inverse_inertia[body];
            even += !world_.is_static[body] && (inverse.array() == inverse.x()).all();
        }
        add({"gyroscopic term",
             even < movers_,
             std::to_string(even) + " of " + std::to_string(movers_) +
                 " bodies have three equal moments of inertia: these turn about a fixed axis",
             "",
             {}});
    }

    void explain_ledger() {
        add({"ledger: what each stage changes",
             pipeline_.ledger.check,
             pipeline_.ledger.check ? "it was asked for" : "it was not asked for",
             "",
             {{"ledger.check", pipeline_.ledger.check ? "false" : "true"}}});
    }

    const Scene& scene_;
    const Simulation& simulation_;
    const PluginLibrary& plugins_;
    const World& world_;
    const PipelineConfig pipeline_;
    const RunResult result_;
    std::size_t statics_ = 0, movers_ = 0;
    std::vector<Feature> features_;
};

}  // namespace

std::vector<Feature> features_of(const Scene& scene, const Simulation& simulation, const PluginLibrary& plugins) {
    return Explainer(scene, simulation, plugins).run();
}

Settings all_modelled() {
    return {{"broadphase.plugin", "brute_force"},
            {"narrowphase.cull", "none"},
            {"model.detail", "most"},
            {"model.bounding_spheres", "false"}};
}

}  // namespace kolize::cli
