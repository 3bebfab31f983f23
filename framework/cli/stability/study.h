// kolize stability: how far each plugin can be pushed along an axis (distance from the origin, mass ratio, ...) before
// its answers leave the tolerance, and what its failure looks like.
//
// A study is a question to the plugins of one stage. It has axes; a point holds one magnitude for each of them, and the
// probe makes the input for that point, asks the plugin and judges the answer. search.h finds where an axis ends.
#pragma once

#include "common.h"

#include <functional>
#include <random>
#include <stdexcept>

namespace kolize::cli::stability {

enum class Failure {
    none,
    wrong,       // a yes that should be a no, or an answer that no tolerance excuses
    missed,      // a no that should be a yes
    late,        // found after it happened
    inaccurate,  // beyond the tolerance
    not_finite,
    hang,     // more work than the question can need
    escaped,  // a body left its room
    stuck,    // a body rests or overlaps where it should bounce
    refused,  // with a message: the only failure that is not silent
};

const char* word(Failure failure);

struct Outcome {
    Failure failure = Failure::none;
    std::string sentence = {};  // what happened; empty if it holds

    bool holds() const { return failure == Failure::none; }
    bool silent() const { return !holds() && failure != Failure::refused; }
};

// Magnitudes go by decades: 3 stands for 1000 units.
struct Axis {
    std::string name;
    std::string unit;  // "" for a pure number
    std::string doc;   // what is made greater or smaller
    double from = 0;   // the easy end, decades
    double to = 0;     // the hard end
    double usual = 0;  // where it stands while another axis is followed
};

using Point = std::vector<double>;  // one magnitude an axis, decades

// "2e+07", in the axis's unit.
std::string magnitude(double decades);

inline double value(const Point& point, int axis) { return std::pow(10.0, point[static_cast<std::size_t>(axis)]); }

struct Subject {
    explicit Subject(std::string subject_name, StageConfig plugin_config = {}, const LoadedPlugin* loaded = nullptr)
        : name(std::move(subject_name)), config(std::move(plugin_config)), plugin(loaded) {}

    std::string name;
    StageConfig config;          // of a plugin
    const LoadedPlugin* plugin;  // null for integrators and pipelines
    std::string pipeline = {};   // file; "": the stepping of that name with the default plugins
};

struct Study {
    std::string stage;   // "broadphase", ..., "continuous", "integrator", "pipeline"
    std::string output;  // what is judged: "pairs", "depth"
    std::string asks;    // the input, the oracle and the tolerance, in a sentence or two
    std::vector<Axis> axes;
    std::vector<Subject> subjects;
    std::function<Outcome(const Subject& subject, const Point& point)> probe;
    std::vector<std::string> left_out = {};  // who is not asked, and why: "explode: it moves nothing"

    Point usual() const;
};

// Thrown by a probe that has counted more work than the question can need.
struct Hang : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The probe; any other exception is a refusal with its message. At the same point always the same outcome.
Outcome ask(const Study& study, const Subject& subject, const Point& point);

struct Context {
    const PluginLibrary& plugins;
    Host& host;
    std::uint64_t seed;
};

// The studies of one stage, for those of the subjects that can be asked.
std::vector<Study> broadphase_studies(const Context& context, const std::vector<Subject>& subjects);
std::vector<Study> narrowphase_studies(const Context& context, const std::vector<Subject>& subjects);
std::vector<Study> continuous_studies(const Context& context, const std::vector<Subject>& narrowphases);
std::vector<Study> response_studies(const Context& context, const std::vector<Subject>& subjects);
std::vector<Study> integrator_studies(const Context& context, const std::vector<Subject>& subjects);
std::vector<Study> pipeline_studies(const Context& context, const std::vector<Subject>& subjects);

// The same numbers with every standard library.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : random_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
    }
    int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
    Vec3 point(double side) {  // of the cube about the origin
        const double x = between(-side, side), y = between(-side, side), z = between(-side, side);
        return {x / 2, y / 2, z / 2};
    }
    Vec3 direction() {
        for (;;)
            if (const Vec3 p = point(2); p.norm() > 0.1 && p.norm() < 1) return p.normalized();
    }
    Quat rotation() {
        const Vec3 axis = direction();
        return Quat(Eigen::AngleAxisd(between(-3, 3), axis));
    }

private:
    std::mt19937_64 random_;
};

}  // namespace kolize::cli::stability
