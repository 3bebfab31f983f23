// What the subcommands of `kolize plugins` share.
#pragma once

#include "common.h"

#include <kolize/conformance.h>

namespace kolize::cli {

// By stage, then by name.
std::vector<const LoadedPlugin*> sorted_plugins(const PluginLibrary& library);

// "sphere", "box", ...
std::vector<std::string> shape_kind_names(std::uint32_t bits);

// Between which ends, or of which choices; empty if neither is declared.
std::string limits(const Parameter& parameter);

// "pass", "fail", "skip"
const char* word(Check::Outcome outcome);

// All checks of the plugin's stage, with allocations counted.
std::vector<Check> hold_to_contract(const PluginLibrary& library, const LoadedPlugin& plugin, std::uint64_t seed = 1);

// --- Certificates: which checks a library has passed, for as long as it is the same file ----------------------------

struct CertificateState {
    enum class Kind { none, of_another_build, valid };
    Kind kind = Kind::none;
    std::size_t passed = 0, skipped = 0;  // checks, if valid
};

// Beside the library: its name with the ending .certificate.json.
std::filesystem::path certificate_path(const std::filesystem::path& library_file);

// Reads the certificate beside the plugin's library; one that cannot be understood is of another build.
CertificateState certificate_of(const LoadedPlugin& plugin);
// "certified: 31 checks"
std::string in_words(const CertificateState& state);
Json to_json(const CertificateState& state);

// Throws Error if the file cannot be written.
void write_certificate(const LoadedPlugin& plugin, const std::vector<Check>& checks, std::uint64_t seed,
                       const std::filesystem::path& file);

// --- Reference pages ------------------------------------------------------------------------------------------------

// A page for each plugin, and README.md with all of them, into a folder that exists. Throws Error.
void write_plugin_pages(const PluginLibrary& library, const std::filesystem::path& folder);

}  // namespace kolize::cli
