#include "plugins.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace kolize::cli {
namespace {

// FNV-1a: tells builds apart, and is no protection against forgery.
std::string hash_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    if (!stream && !stream.eof()) throw Error("'" + file.string() + "' cannot be read");
    std::uint64_t hash = 14695981039346656037ull;
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ull;
    return hex(hash);
}

std::size_t count(const std::vector<Check>& checks, Check::Outcome outcome) {
    return static_cast<std::size_t>(
        std::count_if(checks.begin(), checks.end(), [&](const Check& check) { return check.outcome == outcome; }));
}

// Throws what nlohmann::json throws.
CertificateState understand(const Json& certificate, const LoadedPlugin& plugin) {
    CertificateState state{CertificateState::Kind::of_another_build};
    if (certificate.at("library").at("fnv1a64") != hash_of(plugin.file) || certificate.at("plugin_api") != plugin_api)
        return state;
    state.kind = CertificateState::Kind::valid;
    state.passed = certificate.at("totals").at("pass").get<std::size_t>();
    state.skipped = certificate.at("totals").at("skip").get<std::size_t>();
    return state;
}

}  // namespace

std::filesystem::path certificate_path(const std::filesystem::path& library_file) {
    return std::filesystem::path(library_file).replace_extension(".certificate.json");
}

CertificateState certificate_of(const LoadedPlugin& plugin) {
    std::ifstream file(certificate_path(plugin.file));
    if (!file) return {};
    try {
        return understand(Json::parse(file), plugin);
    } catch (const Json::exception&) {
        return {CertificateState::Kind::of_another_build};
    }
}

std::string in_words(const CertificateState& state) {
    switch (state.kind) {
    case CertificateState::Kind::none: return "not certified";
    case CertificateState::Kind::of_another_build: return "certificate is of another build";
    case CertificateState::Kind::valid: return "certified: " + std::to_string(state.passed) + " checks";
    }
    return "";
}

Json to_json(const CertificateState& state) {
    if (state.kind != CertificateState::Kind::valid)
        return {{"state", state.kind == CertificateState::Kind::none ? "none" : "of another build"}};
    return {{"state", "valid"}, {"pass", state.passed}, {"skip", state.skipped}};
}

void write_certificate(const LoadedPlugin& plugin, const std::vector<Check>& checks, std::uint64_t seed,
                       const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::equivalent(file, plugin.file, error))
        throw Error("'" + file.string() + "' is the plugin itself: its certificate goes elsewhere");
    const Json host = host_block();
    Json rows = Json::array();
    for (const Check& check : checks)
        rows.push_back({{"name", check.name}, {"outcome", word(check.outcome)}, {"detail", check.detail}});
    write_json({{"plugin", plugin.descriptor->name},
                {"stage", to_string(plugin.descriptor->stage)},
                {"version", host.at("version")},
                {"plugin_api", plugin_api},
                {"compiler", host.at("compiler")},
                {"build_type", host.at("build_type")},
                {"library", {{"file", plugin.file.filename().string()}, {"fnv1a64", hash_of(plugin.file)}}},
                {"seed", seed},
                {"totals",
                 {{"pass", count(checks, Check::Outcome::pass)},
                  {"fail", count(checks, Check::Outcome::fail)},
                  {"skip", count(checks, Check::Outcome::skip)}}},
                {"checks", rows}},
               file);
}

}  // namespace kolize::cli
