// Recorded calls of narrowphase and responses: the input of each, in the state that the world was in, bit for bit.
//
// A workload is a folder. world.capsule.toml is the world as the run began, and the pipeline; calls.txt what came then,
// a line each; broadphase.N.npy the boxes of one generation. docs/workloads.md has the formats.
#pragma once

#include <kolize/response.h>
#include <kolize/narrowphase.h>
#include <kolize/scene.h>

#include <filesystem>
#include <variant>

namespace kolize::cli {

struct BodyChange {
    std::uint32_t body = 0;
    bool removed = false, asleep = false;
    BodyState state;
};

struct RuleMemory {
    std::size_t rule = 0;
    std::vector<std::uint64_t> words;  // see Response::save
};

struct NarrowphaseCall {
    std::vector<Pair> pairs;
    std::vector<Detail> detail;
    std::uint64_t found = 0;  // rows
    std::uint64_t hash = 0;   // of them
};

struct ResponseCall {
    std::size_t rule = 0;
    double dt = 0, settle = 0;  // s
    std::vector<Contact> contacts;
    std::vector<std::uint8_t> hit;
    std::uint64_t hash = 0;  // of what it did
};

struct Call {
    std::uint64_t step = 0;
    std::vector<RuleMemory> memory;   // as it is from here on; nothing where it follows from the calls before
    std::vector<BodyChange> changes;  // since the call before
    std::variant<NarrowphaseCall, ResponseCall> what;
};

struct CallWorkload {
    Scene scene;
    std::vector<Call> calls;
};

inline constexpr const char* world_file = "world.capsule.toml";
inline constexpr const char* calls_file = "calls.txt";

// Throws Error with file and line for whatever cannot be read or makes no sense.
CallWorkload read_calls(const std::filesystem::path& folder, const PluginLibrary& plugins);

void apply(const BodyChange& change, World& world);

// Of all that a narrowphase says in its rows.
std::uint64_t hash_of(std::span<const Contact> rows);
// Of the bodies' states and of the impulses: all that a response may change.
std::uint64_t hash_of(const World& world, std::span<const Contact> rows);

// A number with all its bits: a C99 hex float without its 0x.
std::string exact_text(double value);

}  // namespace kolize::cli
