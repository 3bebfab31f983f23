// Typed reading of one TOML table: every key is asked for, and what nobody asked for is refused.
#pragma once

#include "config.h"

namespace kolize::config {

struct Range {
    double min = -infinity;
    double max = infinity;
    bool above_min = false;  // min itself is not allowed
};
inline constexpr Range positive{0, infinity, true};
inline constexpr Range non_negative{0, infinity};

// "the text "fast"", "a table", "3": a value as messages quote it.
std::string describe(const toml::node& node);
std::string join(const std::vector<std::string>& words);

// "; did you mean 'radius'?", or "; there are a, b, c".
std::string hint(const std::string& word, const std::vector<std::string>& candidates);

// The only rules about orientations: length within 1e-3 of 1, made exactly 1. Throws std::invalid_argument.
Quat unit_quaternion(double w, double x, double y, double z);

// All members throw Error with the place of the value (or of the table, for a missing key).
class TableReader {
public:
    // `title` names the table in messages: "[step]".
    TableReader(const toml::table& table, std::string title) : table_(table), title_(std::move(title)) {}

    bool has(const std::string& key) { return find(key) != nullptr; }
    const toml::node& require(const std::string& key);

    double number(const std::string& key, double fallback, const Range& range = {});
    std::int64_t integer(const std::string& key, std::int64_t fallback, const Range& range = {});
    bool boolean(const std::string& key, bool fallback);
    std::string text(const std::string& key, const std::string& fallback);
    std::string choice(const std::string& key, const std::string& fallback, const std::vector<std::string>& choices);
    std::vector<std::string> texts(const std::string& key);
    Vec3 vector(const std::string& key, const Vec3& fallback);
    Quat orientation(const std::string& key);
    std::filesystem::path path(const std::string& key);  // required, made relative to the working directory

    SourceLocation where(const std::string& key) const;
    void set_title(std::string title) { title_ = std::move(title); }
    [[noreturn]] void refuse(const std::string& key, const std::string& message) const;

    // Refuses keys that nobody asked for.
    void finish() const;

private:
    const toml::node* find(const std::string& key);
    [[noreturn]] void refuse_type(const std::string& key, const char* wanted, const toml::node& is) const;
    [[noreturn]] void refuse_unknown(const toml::key& key, const toml::node& node,
                                     const std::vector<std::string>& candidates) const;
    std::vector<double> numbers(const std::string& key, const toml::node& node, std::size_t count,
                                const char* wanted) const;
    void check_range(const std::string& key, double value, const Range& range) const;

    const toml::table& table_;
    std::string title_;
    std::vector<std::string> known_;
};

// The tables of [[name]]; none where the scene has none. Throws Error where `name` is something else.
std::vector<const toml::table*> tables(const toml::table& config, const std::string& name);
// The table [name], or an empty one.
const toml::table& table(const toml::table& config, const std::string& name);

}  // namespace kolize::config
