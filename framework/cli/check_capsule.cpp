#include "check_capsule.h"

#include "judge/witness.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>

namespace kolize::cli {
namespace {

enum class Answer { not_asked, apart, overlap };

const char* to_string(Answer answer) {
    return answer == Answer::overlap ? "overlap" : answer == Answer::apart ? "apart" : "not asked";
}

constexpr const char* truth_name = "exact";
constexpr std::size_t most_pairs_listed = 20;

struct Statement {
    std::string plugin;
    std::vector<Answer> answers;  // by pair
    std::string failure;
    std::size_t misses = 0, false_hits = 0;

    std::size_t count(Answer answer) const {
        return static_cast<std::size_t>(std::count(answers.begin(), answers.end(), answer));
    }
};

struct Question {
    World world;
    std::vector<Pair> pairs;
};

bool is_open(const World& world, const Pair& pair) {
    const Mesh *a = world.shape_of(pair.a).mesh.get(), *b = world.shape_of(pair.b).mesh.get();
    return (a && !a->closed) || (b && !b->closed);
}

// Those whose boxes overlap, of bodies that may move against each other or are open surfaces, which have no mass.
std::vector<Pair> pairs_of(const World& world) {
    std::vector<Aabb> bounds;
    for (std::uint32_t body = 0; body < world.size(); ++body) bounds.push_back(world_bounds(world, body));
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < world.size(); ++a)
        for (std::uint32_t b = a + 1; b < world.size(); ++b) {
            const bool any_removed = world.removed[a] || world.removed[b];
            const bool both_stand = world.is_static[a] && world.is_static[b] && !is_open(world, {a, b});
            if (!any_removed && !both_stand && bounds[a].overlaps(bounds[b])) pairs.push_back({a, b});
        }
    return pairs;
}

// Open surfaces have no inside: of them it is asked whether any triangles meet.
Answer ask(Witness& witness, const World& world, const Pair& pair) {
    if (!witness.takes(world, pair)) return Answer::not_asked;
    if (is_open(world, pair)) {
        const bool both = world.shape_of(pair.a).mesh && world.shape_of(pair.b).mesh;
        const std::optional<bool> meet = both ? witness.surfaces_meet(world, pair) : std::nullopt;
        return !meet ? Answer::not_asked : *meet ? Answer::overlap : Answer::apart;
    }
    const Detail detail = witness.gives();
    Contacts contacts;
    witness.stage().find_contacts({world, {&pair, 1}, {&detail, 1}}, contacts);
    return contacts.rows.empty() ? Answer::apart : Answer::overlap;
}

Statement take_statement(const StageConfig& config, const Question& question, const PluginLibrary& plugins,
                         Host& host) {
    Witness witness(config, plugins, host);
    Statement statement{config.plugin, std::vector<Answer>(question.pairs.size(), Answer::not_asked), {}};
    try {
        witness.prepare(question.world);
        for (std::size_t i = 0; i < question.pairs.size(); ++i)
            statement.answers[i] = ask(witness, question.world, question.pairs[i]);
    } catch (const std::exception& failure) {
        statement.failure = failure.what();
    }
    return statement;
}

void compare(Statement& statement, const Statement& truth) {
    for (std::size_t i = 0; i < truth.answers.size(); ++i) {
        const Answer right = truth.answers[i], said = statement.answers[i];
        statement.misses += right == Answer::overlap && said == Answer::apart;
        statement.false_hits += right == Answer::apart && said == Answer::overlap;
    }
}

bool names_narrowphase(const Settings& settings) {
    return std::any_of(settings.begin(), settings.end(),
                       [](const auto& setting) { return setting.first == "narrowphase.plugin"; });
}

// The one that is named; else all but those that answer for bounding volumes, which is another question.
std::vector<StageConfig> witnesses(const Settings& settings, const PluginLibrary& plugins,
                                   std::vector<std::string>& left_out) {
    if (names_narrowphase(settings)) return {stage_config(StageKind::narrowphase, settings, "")};
    std::vector<StageConfig> configs;
    for (const std::string& name : plugins.names(StageKind::narrowphase)) {
        const LoadedPlugin& plugin = plugins.require(StageKind::narrowphase, name);
        if (plugin.descriptor->capabilities.bounding_spheres) {
            left_out.push_back(name);
            continue;
        }
        StageConfig config{name, {}, {}};
        for (const auto& [key, setting] : stage_config(StageKind::narrowphase, settings, name).settings)
            if (plugin.parameters.find(key)) config.settings[key] = setting;
        configs.push_back(config);
    }
    return configs;
}

void print_summary(const std::vector<Statement>& statements) {
    Table table({"narrowphase", "asked", "not asked", "overlap", "misses", "false hits"});
    for (const Statement& s : statements)
        table.add({s.plugin, std::to_string(s.answers.size() - s.count(Answer::not_asked)),
                   std::to_string(s.count(Answer::not_asked)), std::to_string(s.count(Answer::overlap)),
                   std::to_string(s.misses), std::to_string(s.false_hits)});
    table.print(std::cout);
}

std::string pair_name(const World& world, const Pair& pair) {
    const auto name = [&](std::uint32_t body) {
        return std::to_string(body) + (world.name[body].empty() ? "" : " '" + world.name[body] + "'");
    };
    return name(pair.a) + ", " + name(pair.b);
}

bool is_disputed(const std::vector<Statement>& statements, std::size_t pair) {
    return std::any_of(statements.begin(), statements.end(), [&](const Statement& s) {
        const Answer right = statements.front().answers[pair], said = s.answers[pair];
        return right != Answer::not_asked && said != Answer::not_asked && said != right;
    });
}

// All pairs of a small capsule, else those that someone disputes.
void print_pairs(const std::vector<Statement>& statements, const Question& question) {
    std::vector<std::string> head{"bodies"};
    for (const Statement& statement : statements) head.push_back(statement.plugin);
    Table table(head);
    std::size_t listed = 0;
    for (std::size_t i = 0; i < question.pairs.size() && listed < most_pairs_listed; ++i) {
        if (question.pairs.size() > most_pairs_listed && !is_disputed(statements, i)) continue;
        std::vector<std::string> row{pair_name(question.world, question.pairs[i])};
        for (const Statement& statement : statements) row.emplace_back(to_string(statement.answers[i]));
        table.add(row);
        ++listed;
    }
    if (listed == 0) return;
    std::cout << '\n';
    table.print(std::cout);
}

void print(const CheckCapsuleOptions& options, const std::vector<Statement>& statements, const Question& question,
           const std::vector<std::string>& left_out) {
    std::cout << options.capsule << ": " << question.pairs.size() << " pairs\n\n";
    print_summary(statements);
    print_pairs(statements, question);
    for (const Statement& s : statements)
        if (!s.failure.empty()) std::cout << s.plugin << " failed: " << s.failure << '\n';
    for (const std::string& name : left_out)
        std::cout << name << " is left out: it answers for bounding volumes; name it to ask it\n";
}

Json to_json(const CheckCapsuleOptions& options, const std::vector<Statement>& statements, const Question& question) {
    Json rows = Json::array();
    for (const Statement& s : statements) {
        Json answers = Json::array();
        for (const Answer answer : s.answers) answers.push_back(to_string(answer));
        rows.push_back(
            {{"plugin", s.plugin}, {"misses", s.misses}, {"false_hits", s.false_hits}, {"answers", answers}});
        if (!s.failure.empty()) rows.back()["failure"] = s.failure;
    }
    Json pairs = Json::array();
    for (const Pair& pair : question.pairs) pairs.push_back({pair.a, pair.b});
    return {{"capsule", options.capsule}, {"truth", truth_name},  {"pairs", pairs},
            {"narrowphases", rows},       {"host", host_block()}, {"command", command_line()}};
}

Question read_question(const CheckCapsuleOptions& options, const PluginLibrary& plugins) {
    const Scene scene = load_scene(options.capsule, {{}, {}, plugin_defaults()}, plugins);
    if (!scene.capsule_step)
        throw Error("'" + options.capsule +
                    "' is no capsule of a step; kolize run SCENE --capsule-at N writes one (and two meshes are checked "
                    "with --poses)");
    Question question{scene.world, pairs_of(scene.world)};
    if (question.pairs.empty()) throw Error("capsule '" + options.capsule + "' has no two bodies that may overlap");
    return question;
}

}  // namespace

int check_capsule(const CheckCapsuleOptions& options) {
    const PluginLibrary plugins =
        open_plugins(options.plugin_path, std::filesystem::path(options.capsule).parent_path());
    const std::unique_ptr<Host> host = make_host(options.threads);
    const Question question = read_question(options, plugins);
    std::vector<Statement> statements{take_statement({truth_name, {}, {}}, question, plugins, *host)};
    if (!statements.front().failure.empty())
        throw std::runtime_error(std::string(truth_name) + " failed: " + statements.front().failure);
    std::vector<std::string> left_out;
    for (const StageConfig& config : witnesses(parse_settings(options.set), plugins, left_out)) {
        if (config.plugin == truth_name && config.settings.empty()) continue;
        statements.push_back(take_statement(config, question, plugins, *host));
        compare(statements.back(), statements.front());
    }
    if (options.json != "-") print(options, statements, question, left_out);
    if (!options.json.empty()) write_json(to_json(options, statements, question), options.json);
    return std::all_of(statements.begin(), statements.end(),
                       [](const Statement& s) { return s.misses + s.false_hits == 0 && s.failure.empty(); })
               ? 0
               : 1;
}

}  // namespace kolize::cli
