// kolize check: static queries. Two meshes, one narrowphase, many relative poses; or a capsule and every narrowphase.
#include "check_capsule.h"

#include <kolize/mesh_io.h>

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <stdexcept>

namespace kolize::cli {
namespace {

struct CheckOptions {
    std::string model_a;
    std::string model_b;
    std::string poses;
    std::vector<std::string> set;
    std::vector<std::string> plugin_path;
    std::string detail = "manifold";
    int threads = 1;
    std::string json;
};

constexpr int timing_repeats = 5;

struct PoseResult {
    Contacts contacts;
    double time_us = 0;  // median of the repeats
};

Shape read_solid(const std::string& file) {
    const TriangleSoup soup = read_mesh(file);
    const MeshDefects defects = inspect(soup);
    if (!defects.closed()) throw Error("mesh '" + file + "' is not the closed surface of a solid: " + defects.first);
    try {
        return make_mesh(file, soup);
    } catch (const std::invalid_argument& error) {
        throw Error("mesh '" + file + "' cannot be used: " + error.what());
    }
}

// Body 0 is A, whose model frame is the world's; body 1 is B.
World make_world(const CheckOptions& options) {
    World world;
    world.materials.push_back({});
    world.shapes = {read_solid(options.model_a), read_solid(options.model_b)};
    for (const std::uint32_t shape : {0u, 1u}) {
        BodyDescription body;
        body.shape = shape;
        body.mass = 1;
        world.add(body);
    }
    return world;
}

void place_b(World& world, const BodyDescription& pose) {
    const Shape& shape = world.shape_of(1);
    world.position[1] = pose.position + pose.orientation * shape.center_in_model;
    world.orientation[1] = (pose.orientation * shape.body_to_model).normalized();
}

Detail parse_detail(const std::string& name) {
    for (const Detail detail : {Detail::overlap, Detail::normal})
        if (name == to_string(detail)) return detail;
    return Detail::manifold;
}

PoseResult query(const World& world, Detail detail, Narrowphase& narrowphase) {
    const Pair pair{0, 1};
    PoseResult result;
    std::vector<double> times;
    for (int i = 0; i < timing_repeats; ++i) {
        result.contacts.clear();
        const auto start = std::chrono::steady_clock::now();
        narrowphase.find_contacts({world, {&pair, 1}, {&detail, 1}}, result.contacts);
        const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
        times.push_back(time.count());
    }
    result.time_us = median(std::move(times));
    return result;
}

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// Points and normals in A's model frame.
Json pose_json(const PoseResult& result, const World& world, Detail detail) {
    Json contacts = Json::array();
    for (const Contact& contact : result.contacts.rows)
        if (detail != Detail::overlap)
            contacts.push_back({{"point", vector_json(world.position[0] + contact.arm_a)},
                                {"normal", vector_json(contact.normal)},
                                {"depth", contact.depth}});
    return {{"overlap", !result.contacts.rows.empty()},
            {"triangle_pairs", result.contacts.triangle_hits},
            {"contacts", contacts},
            {"time_us", result.time_us}};
}

void print_summary(const std::vector<PoseResult>& results, const CheckOptions& options, const std::string& plugin) {
    std::vector<double> times;
    std::size_t overlaps = 0, contacts = 0;
    std::uint64_t tests = 0, hits = 0;
    for (const PoseResult& result : results) {
        times.push_back(result.time_us);
        overlaps += !result.contacts.rows.empty();
        contacts += result.contacts.rows.size();
        tests += result.contacts.triangle_tests;
        hits += result.contacts.triangle_hits;
    }
    std::cout << options.model_a << " against " << options.model_b << ", " << options.detail << " by " << plugin
              << "\n\n";
    Table table({"poses", "overlapping", "contacts", "triangle tests", "triangle pairs", "median us", "p95 us"});
    table.add({std::to_string(results.size()), std::to_string(overlaps), std::to_string(contacts),
               std::to_string(tests), std::to_string(hits), number(median(times)), number(quantile(times, 0.95))});
    table.print(std::cout);
}

Json effective_json(const PluginLibrary& plugins, const StageConfig& config, const Stage& stage) {
    Json json{{"plugin", config.plugin}};
    for (const auto& [name, value] : effective_settings(plugins.require(StageKind::narrowphase, config.plugin), stage))
        json[name] = to_json(value);
    return json;
}

int check(const CheckOptions& options) {
    if (options.poses.empty()) throw Error("--poses is wanted: a CSV file with the poses of B in A's frame");
    const PluginLibrary plugins = open_plugins(options.plugin_path, {});
    const std::unique_ptr<Host> host = make_host(options.threads);
    const StageConfig config =
        stage_config(StageKind::narrowphase, parse_settings(options.set), plugin_defaults().narrowphase);
    const StagePtr<Narrowphase> narrowphase = plugins.make<Narrowphase>(config, *host);
    const Detail detail = parse_detail(options.detail);
    if (detail > narrowphase->gives())
        throw Error(config.where, "narrowphase '" + config.plugin + "' gives " + to_string(narrowphase->gives()) +
                                      " at most, not " + options.detail);
    World world = make_world(options);
    narrowphase->prepare(world);

    Json poses = Json::array();
    std::vector<PoseResult> results;
    for (const BodyDescription& pose : read_states(options.poses, {"qw", "qx", "qy", "qz", "x", "y", "z"})) {
        place_b(world, pose);
        results.push_back(query(world, detail, *narrowphase));
        poses.push_back(pose_json(results.back(), world, detail));
    }
    if (options.json != "-") print_summary(results, options, config.plugin);
    if (!options.json.empty())
        write_json({{"model_a", options.model_a},
                    {"model_b", options.model_b},
                    {"narrowphase", effective_json(plugins, config, *narrowphase)},
                    {"detail", options.detail},
                    {"poses", poses},
                    {"host", host_block()}},
                   options.json);
    return 0;
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<CheckOptions>();
    CLI::App* command = app.add_subcommand(
        "check", "Test two meshes for overlap at given poses, or hold narrowphases against the exact one in a capsule");
    command->add_option("model_a", options->model_a, "Mesh A; or a capsule, alone")->required();
    CLI::Option* model_b = command->add_option("model_b", options->model_b, "Mesh B");
    command->add_option("--poses", options->poses, "CSV: a pose of B in A's frame per row: qw,qx,qy,qz,x,y,z")
        ->needs(model_b);
    add_set_option(*command, options->set);
    command->add_option("--detail", options->detail, "What to find out: overlap, normal or manifold")
        ->check(CLI::IsMember({"overlap", "normal", "manifold"}))
        ->capture_default_str();
    add_threads_option(*command, options->threads);
    add_plugin_path_option(*command, options->plugin_path);
    add_json_option(*command, options->json);
    command->footer(
        "Example: kolize check hand.obj cup.obj --poses poses.csv --set narrowphase.plugin=fcl --json -\n"
        "Example: kolize check disagreements/0.moller.step12.bodies3-7.capsule.toml\n"
        "Of a capsule, exit code 1 says that a narrowphase disagrees with the exact one.");
    command->callback([options, &exit_code] {
        exit_code =
            options->model_b.empty()
                ? check_capsule({options->model_a, options->set, options->plugin_path, options->threads, options->json})
                : check(*options);
    });
}

}  // namespace kolize::cli
