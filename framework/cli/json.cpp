#include "common.h"

#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <unistd.h>

#include <fstream>
#include <iostream>
#include <thread>

namespace kolize::cli {
namespace {

Json stage_json(const EffectiveStage& stage) {
    Json json{{"plugin", stage.plugin}};
    if (!stage.when.empty()) json["when"] = stage.when;
    for (const auto& [name, value] : stage.settings) json[name] = to_json(value);
    if (!stage.report.empty()) json["report"] = stage.report;
    return json;
}

Json to_json(const StageTime& time) {
    return {{"median_us", time.median_us}, {"p95_us", time.p95_us}, {"total_s", time.total_s}};
}

Json accuracy_json(const RunResult& result) {
    return {{"energy_initial_J", result.energy_initial_J},
            {"energy_final_J", result.energy_final_J},
            {"energy_drift", result.energy_drift},
            {"momentum_drift", result.momentum_drift},
            {"angular_momentum_drift", result.angular_momentum_drift},
            {"max_penetration_m", result.max_penetration_m},
            {"escaped", result.escaped},
            {"stuck", result.stuck}};
}

std::string cpu_model() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name"))
            if (const std::size_t colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
    return "unknown";
}

std::string compiler() {
#ifdef __clang__
    return "clang++ " __clang_version__;
#else
    return "g++ " __VERSION__;
#endif
}

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace

Json to_json(const Value& value) {
    return std::visit([](const auto& plain) { return Json(plain); }, value);
}

Json pipeline_json(const Simulation& simulation) {
    Json responses = Json::array();
    for (const EffectiveStage& stage : simulation.responses()) responses.push_back(stage_json(stage));
    Json narrowphase = stage_json(simulation.narrowphase());
    narrowphase["walls"] = simulation.walls();
    narrowphase["cull"] = simulation.pipeline().cull;
    const StepConfig& step = simulation.step_config();
    const ModelConfig model = simulation.pipeline().model;
    return {{"broadphase", stage_json(simulation.broadphase())},
            {"narrowphase", narrowphase},
            {"response", responses},
            {"model", {{"detail", model.detail}, {"bounding_spheres", model.bounding_spheres}}},
            {"step",
             {{"dt", step.dt},
              {"substeps", step.substeps},
              {"mode", step.mode},
              {"integrator", step.integrator},
              {"tolerance", step.tolerance},
              {"max_impacts", step.max_impacts}}}};
}

Json to_json(const RunResult& result, const Json& pipeline) {
    return {{"scene", result.scene},
            {"pipeline", pipeline},
            {"bodies", result.bodies},
            {"steps", result.steps},
            {"dt", result.dt},
            {"time", result.time},
            {"threads", result.threads},
            {"stages",
             {{"broadphase", to_json(result.broadphase)},
              {"narrowphase", to_json(result.narrowphase)},
              {"response", to_json(result.response)},
              {"integrate", to_json(result.integrate)},
              {"step", to_json(result.step)}}},
            {"counts",
             {{"pairs", result.pairs},
              {"contacts", result.contacts},
              {"triangle_tests", result.triangle_tests},
              {"failures", result.failures},
              {"events", result.events},
              {"unresolved", result.unresolved}}},
            {"accuracy", accuracy_json(result)},
            {"peak_memory_bytes", peak_memory_bytes()},
            {"state_hash", hex(result.state_hash)}};
}

Json host_block() {
    return {{"version", KOLIZE_VERSION}, {"plugin_api", plugin_api},
            {"compiler", compiler()},    {"build_type", KOLIZE_BUILD_TYPE},
            {"cpu", cpu_model()},        {"cores", std::thread::hardware_concurrency()}};
}

std::string command_line() {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::string text;
    for (std::string word; std::getline(file, word, '\0');) text += (text.empty() ? "" : " ") + word;
    return text;
}

std::string hex(std::uint64_t bits) {
    constexpr char digits[] = "0123456789abcdef";
    std::string text(16, '0');
    for (std::size_t i = 16; i-- > 0; bits >>= 4) text[i] = digits[bits & 15];
    return text;
}

void write_text(const std::string& text, const std::filesystem::path& destination) {
    if (destination == "-") {
        std::cout << text << std::flush;
        return;
    }
    std::filesystem::path temporary = destination;
    temporary += ".part" + std::to_string(getpid());
    std::ofstream file(temporary, std::ios::binary);
    std::error_code error;
    if (file << text << std::flush) std::filesystem::rename(temporary, destination, error);
    if (file && !error) return;
    std::filesystem::remove(temporary, error);
    throw Error("file '" + destination.string() + "' cannot be written");
}

void write_json(const Json& json, const std::filesystem::path& destination) {
    write_text(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", destination);
}

}  // namespace kolize::cli
