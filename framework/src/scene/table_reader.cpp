#include "table_reader.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace kolize::config {
namespace {

std::string print(double value) {
    std::ostringstream text;
    text.precision(10);
    text << value;
    return text.str();
}

}  // namespace

std::string describe(const toml::node& node) {
    if (const auto* text = node.as_string()) return "the text \"" + text->get() + "\"";
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    if (node.is_number()) return print(*node.value<double>());
    if (node.is_array()) return "an array";
    return node.is_table() ? "a table" : "a date or time";
}

std::string join(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
    return list;
}

std::string hint(const std::string& word, const std::vector<std::string>& candidates) {
    if (candidates.empty()) return "; there is none";
    const std::string near = nearest_name(word, candidates);
    if (!near.empty()) return "; did you mean '" + near + "'?";
    return (candidates.size() == 1 ? "; there is only " : "; there are ") + join(candidates);
}

Quat unit_quaternion(double w, double x, double y, double z) {
    const Quat q(w, x, y, z);
    const double length = q.norm();
    if (length == 0) throw std::invalid_argument("is the zero quaternion; no turn at all is [1, 0, 0, 0]");
    if (!(std::abs(length - 1) <= 1e-3))
        throw std::invalid_argument("must be a unit quaternion [w, x, y, z], has length " + print(length));
    return q.normalized();
}

const toml::node* TableReader::find(const std::string& key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
    return table_.get(key);
}

const toml::node& TableReader::require(const std::string& key) {
    if (const toml::node* node = find(key)) return *node;
    for (const auto& [other, node] : table_)
        if (const std::string slip(other.str()); std::find(known_.begin(), known_.end(), slip) == known_.end())
            if (!nearest_name(slip, std::vector{key}).empty()) refuse_unknown(other, node, {key});
    throw Error(location(table_), title_ + " needs " + key);
}

void TableReader::check_range(const std::string& key, double value, const Range& range) const {
    if (!std::isfinite(value)) refuse(key, "must be finite, is " + print(value));
    const bool low = range.above_min ? value <= range.min : value < range.min;
    if (!low && value <= range.max) return;
    const std::string least = (range.above_min ? "greater than " : "at least ") + print(range.min);
    const std::string span = range.max == infinity ? least
                             : range.above_min     ? least + " and at most " + print(range.max)
                                                   : "from " + print(range.min) + " to " + print(range.max);
    refuse(key, "must be " + span + ", is " + print(value));
}

double TableReader::number(const std::string& key, double fallback, const Range& range) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    if (!node->is_number()) refuse_type(key, "a number", *node);
    const double value = *node->value<double>();
    check_range(key, value, range);
    return value;
}

std::int64_t TableReader::integer(const std::string& key, std::int64_t fallback, const Range& range) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    if (!node->is_integer()) refuse_type(key, "an integer", *node);
    const std::int64_t value = node->as_integer()->get();
    check_range(key, static_cast<double>(value), range);
    return value;
}

bool TableReader::boolean(const std::string& key, bool fallback) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    if (!node->is_boolean()) refuse_type(key, "true or false", *node);
    return node->as_boolean()->get();
}

std::string TableReader::text(const std::string& key, const std::string& fallback) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    if (!node->is_string()) refuse_type(key, "text", *node);
    if (node->as_string()->get().empty()) refuse(key, "must not be empty");
    return node->as_string()->get();
}

std::string TableReader::choice(const std::string& key, const std::string& fallback,
                                const std::vector<std::string>& choices) {
    const std::string value = text(key, fallback);
    if (std::find(choices.begin(), choices.end(), value) == choices.end())
        throw Error(where(key), "there is no " + key + " '" + value + "'" + hint(value, choices));
    return value;
}

std::vector<std::string> TableReader::texts(const std::string& key) {
    std::vector<std::string> result;
    const toml::node* node = find(key);
    if (!node) return result;
    if (!node->is_array()) refuse_type(key, "a list of texts", *node);
    for (const toml::node& entry : *node->as_array()) {
        if (!entry.is_string()) refuse_type(key, "a list of texts", entry);
        result.push_back(entry.as_string()->get());
    }
    return result;
}

std::vector<double> TableReader::numbers(const std::string& key, const toml::node& node, std::size_t count,
                                         const char* wanted) const {
    const toml::array* array = node.as_array();
    if (!array) refuse_type(key, wanted, node);
    if (array->size() != count)
        refuse(key, std::string("must be ") + wanted + ", has " + std::to_string(array->size()) + " entries");
    std::vector<double> values;
    for (const toml::node& entry : *array) {
        if (!entry.is_number()) refuse_type(key, wanted, entry);
        values.push_back(*entry.value<double>());
        check_range(key, values.back(), {});
    }
    return values;
}

Vec3 TableReader::vector(const std::string& key, const Vec3& fallback) {
    const toml::node* node = find(key);
    if (!node) return fallback;
    const std::vector<double> v = numbers(key, *node, 3, "three numbers [x, y, z]");
    return {v[0], v[1], v[2]};
}

Quat TableReader::orientation(const std::string& key) {
    const toml::node* node = find(key);
    if (!node) return Quat::Identity();
    const std::vector<double> q = numbers(key, *node, 4, "four numbers [w, x, y, z]");
    try {
        return unit_quaternion(q[0], q[1], q[2], q[3]);
    } catch (const std::invalid_argument& error) {
        refuse(key, error.what());
    }
}

std::filesystem::path TableReader::path(const std::string& key) {
    const toml::node& node = require(key);
    const std::filesystem::path file = folder_of(node) / text(key, "");
    if (!std::filesystem::exists(file)) throw Error(location(node), "file '" + file.string() + "' does not exist");
    return file;
}

SourceLocation TableReader::where(const std::string& key) const {
    const toml::node* node = table_.get(key);
    return node ? location(*node) : location(table_);
}

void TableReader::refuse(const std::string& key, const std::string& message) const {
    throw Error(where(key), key + " " + message);
}

void TableReader::refuse_type(const std::string& key, const char* wanted, const toml::node& is) const {
    throw Error(location(is), key + " must be " + wanted + ", is " + describe(is));
}

void TableReader::refuse_unknown(const toml::key& key, const toml::node& node,
                                 const std::vector<std::string>& candidates) const {
    const std::string name(key.str());
    throw Error(location(key, node), "no key '" + name + "' in " + title_ + hint(name, candidates));
}

void TableReader::finish() const {
    for (const auto& [key, node] : table_)
        if (std::find(known_.begin(), known_.end(), key.str()) == known_.end()) refuse_unknown(key, node, known_);
}

std::vector<const toml::table*> tables(const toml::table& config, const std::string& name) {
    std::vector<const toml::table*> result;
    const toml::node* node = config.get(name);
    if (!node) return result;
    const toml::array* array = node->as_array();
    const auto refuse = [&](const toml::node& at) {
        throw Error(location(at), name + " must be a list of tables, each under [[" + name + "]]");
    };
    if (!array) refuse(*node);
    for (const toml::node& entry : *array) {
        if (!entry.is_table()) refuse(entry);
        result.push_back(entry.as_table());
    }
    return result;
}

const toml::table& table(const toml::table& config, const std::string& name) {
    static const toml::table none;
    const toml::node* node = config.get(name);
    if (!node) return none;
    if (!node->is_table()) throw Error(location(*node), name + " must be a table, under [" + name + "]");
    return *node->as_table();
}

}  // namespace kolize::config
