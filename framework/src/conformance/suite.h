// How the suites of all stages run a check.
#pragma once

#include <kolize/conformance.h>

#include <stdexcept>

namespace kolize {

// Thrown by a check: the plugin broke its contract. The text says what happened and on which input.
class Violation : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Thrown by a check that does not apply, with the reason.
class Inapplicable : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The plugin with its default parameters.
inline StageConfig default_config(const LoadedPlugin& plugin) {
    StageConfig config;
    config.plugin = plugin.descriptor->name;
    return config;
}

// The default, every choice, and the ends of the range.
std::vector<Value> values_to_try(const Parameter& parameter);

class Suite {
public:
    // Runs `check` and notes how it ended. Any exception but Inapplicable is a failure.
    void run(const char* name, const std::function<void()>& check);
    std::vector<Check> take() { return std::move(checks_); }

private:
    std::vector<Check> checks_;
};

}  // namespace kolize
