#include <kolize/expectation.h>

#include "scene/table_reader.h"

#include <map>
#include <sstream>

namespace kolize {
namespace {

using namespace config;
using Field = double (*)(const RunResult&);

template <auto Member>
double field(const RunResult& result) {
    return static_cast<double>(result.*Member);
}

// Times of stages are left out: what a clock says is no property of the scene.
const std::map<std::string, Field> fields = {
    {"bodies", field<&RunResult::bodies>},
    {"contacts", field<&RunResult::contacts>},
    {"energy_drift", field<&RunResult::energy_drift>},
    {"energy_final_J", field<&RunResult::energy_final_J>},
    {"energy_initial_J", field<&RunResult::energy_initial_J>},
    {"escaped", field<&RunResult::escaped>},
    {"events", field<&RunResult::events>},
    {"max_penetration_m", field<&RunResult::max_penetration_m>},
    {"momentum_drift", field<&RunResult::momentum_drift>},
    {"angular_momentum_drift", field<&RunResult::angular_momentum_drift>},
    {"pairs", field<&RunResult::pairs>},
    {"stuck", field<&RunResult::stuck>},
    {"triangle_tests", field<&RunResult::triangle_tests>},
    {"failures", field<&RunResult::failures>},
    {"unresolved", field<&RunResult::unresolved>},
};

std::string as_toml(const toml::node& node) {
    std::ostringstream text;
    node.visit([&](const auto& concrete) { text << concrete; });
    return text.str();
}

// { step.dt = 0.01 } and { "step.dt" = 0.01 } are the same.
void read_settings(const toml::table& table, const std::string& prefix, Settings& settings) {
    for (const auto& [key, node] : table) {
        const std::string dotted = prefix + std::string(key.str());
        if (const toml::table* inner = node.as_table())
            read_settings(*inner, dotted + ".", settings);
        else
            settings.emplace_back(dotted, as_toml(node));
    }
}

Settings read_set(TableReader& reader, const toml::table& table) {
    Settings settings;
    if (!reader.has("set")) return settings;
    if (!table["set"].is_table()) reader.refuse("set", "must be a table such as { step.dt = 0.01 }");
    read_settings(*table["set"].as_table(), "", settings);
    return settings;
}

Bound read_bound(const std::string& name, const toml::node& node) {
    if (!node.is_table()) throw Error(location(node), name + " must be a table such as { max = 0 }");
    TableReader reader(*node.as_table(), name);
    Bound bound{name, reader.number("min", -infinity), reader.number("max", infinity), location(node)};
    reader.finish();
    if (bound.min > bound.max) reader.refuse("max", "must not be less than min");
    if (std::isinf(bound.min) && std::isinf(bound.max)) throw Error(location(node), name + " needs min or max");
    return bound;
}

std::vector<Bound> read_bounds(TableReader& reader, const toml::table& table) {
    std::vector<Bound> bounds;
    for (const auto& [name, unused] : fields)
        if (reader.has(name)) bounds.push_back(read_bound(name, *table.get(name)));
    return bounds;
}

Expectation read_expectation(const toml::table& table) {
    TableReader reader(table, "[[expect]]");
    Expectation expectation;
    expectation.where = location(table);
    if (reader.has("pipeline") && table["pipeline"].value_or(std::string("?")) != "") {
        expectation.pipeline = reader.text("pipeline", "");
        expectation.pipeline_file = reader.path("pipeline");
    }
    expectation.set = read_set(reader, table);
    expectation.time = reader.number("time", 0, positive);
    expectation.steps = static_cast<std::uint64_t>(reader.integer("steps", 0, {1, 1e9}));
    if (expectation.time > 0 && expectation.steps > 0) reader.refuse("steps", "cannot stand beside time");
    expectation.bounds = read_bounds(reader, table);
    reader.finish();
    if (expectation.bounds.empty())
        throw Error(expectation.where, "[[expect]] needs a bound such as stuck = { max = 0 }");
    return expectation;
}

std::string describe(const Expectation& expectation, std::uint64_t steps) {
    std::string text = expectation.pipeline.empty() ? "the scene's own pipeline" : expectation.pipeline;
    for (const auto& [key, value] : expectation.set) text += ", " + key + " = " + value;
    return text + ", " + std::to_string(steps) + " steps";
}

}  // namespace

std::vector<Expectation> read_expectations(const std::filesystem::path& file) {
    const toml::table content = parse_file(file, "expectation");
    std::vector<Expectation> expectations;
    for (const auto& [key, node] : content)
        if (key.str() != "expect")
            throw Error(location(key, node),
                        "no table '" + std::string(key.str()) + "' in expectations; only [[expect]]");
    for (const toml::table* table : tables(content, "expect")) expectations.push_back(read_expectation(*table));
    return expectations;
}

std::vector<std::string> failures(const Expectation& expectation, const RunResult& result) {
    std::vector<std::string> sentences;
    for (const Bound& bound : expectation.bounds) {
        const double value = fields.at(bound.field)(result);
        const std::string is = to_string(bound.where) + ": " + bound.field + " is " + to_string(Value(value));
        if (!std::isfinite(value)) sentences.push_back(is + ", expected a finite number");
        if (value > bound.max) sentences.push_back(is + ", expected at most " + to_string(Value(bound.max)));
        if (value < bound.min) sentences.push_back(is + ", expected at least " + to_string(Value(bound.min)));
    }
    return sentences;
}

ExpectationOutcome run_expectation(const Expectation& expectation, const std::filesystem::path& scene_file,
                                   const PluginDefaults& defaults, const PluginLibrary& plugins, Host& host) {
    const Scene scene = load_scene(scene_file, {expectation.pipeline_file, expectation.set, defaults}, plugins);
    const StepConfig& step = scene.pipeline.step;
    const double time = expectation.time > 0 ? expectation.time : step.time;
    const std::uint64_t steps = expectation.steps ? expectation.steps : steps_in(time, step.dt);
    Simulation simulation(scene, plugins, host, steps);
    for (std::uint64_t i = 0; i < steps; ++i) simulation.step();
    ExpectationOutcome outcome{describe(expectation, steps), failures(expectation, simulation.result())};
    if (const auto& broken = simulation.first_break())
        outcome.failures.push_back(to_string(*broken, simulation.world()));
    return outcome;
}

}  // namespace kolize
