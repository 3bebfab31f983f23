#include "config.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <span>
#include <sstream>

namespace kolize::config {
namespace {

const std::string setting_prefix = "--set ";
const std::vector<std::string> pipeline_tables = {"step",  "broadphase", "narrowphase", "response",
                                                  "model", "ledger",     "render"};

SourceLocation location(const toml::source_region& source) {
    const std::string file = source.path ? *source.path : "";
    if (file.starts_with(setting_prefix)) return {file};
    return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

std::string read_text(const std::filesystem::path& file, const std::string& what) {
    if (!std::filesystem::exists(file)) throw Error(what + " file '" + file.string() + "' does not exist");
    std::ifstream stream(file, std::ios::binary);
    if (std::filesystem::is_directory(file) || !stream)
        throw Error(what + " file '" + file.string() + "' cannot be read");
    return {std::istreambuf_iterator<char>(stream), {}};
}

// Moves a parsed value into a table: unlike a copy, a moved node keeps the place where it was written.
void move_into(toml::table& table, const toml::key& key, toml::node& node) {
    node.visit([&](auto& concrete) { table.insert_or_assign(key, std::move(concrete)); });
}

// table[key] = what the TOML text says, with `place` as its source. Throws toml::parse_error, or Error if the text is
// more than one value.
toml::node& insert_parsed(toml::table& table, const std::string& key, const std::string& text,
                          const std::string& place) {
    toml::table parsed = toml::parse("v = " + text, place);
    if (parsed.size() != 1) throw Error(SourceLocation{place}, "one value is wanted");
    move_into(table, toml::key(key, parsed.source()), *parsed.get("v"));
    return *table.get(key);
}

void insert_value(toml::table& table, const std::string& key, const std::string& text, const std::string& place) {
    try {
        insert_parsed(table, key, text, place);
    } catch (const toml::parse_error&) {
        std::ostringstream quoted;
        quoted << toml::value<std::string>(text);
        insert_parsed(table, key, quoted.str(), place);
    }
}

std::vector<std::string> split_key(const std::string& dotted) {
    std::vector<std::string> words;
    std::istringstream stream(dotted + ".");
    for (std::string word; std::getline(stream, word, '.');) words.push_back(word);
    return words;
}

bool parse_index(const std::string& word, std::size_t& index) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    return error == std::errc() && end == word.data() + word.size();
}

// Element of an array of tables: the one that the next word numbers, else the only one.
toml::node& open_element(toml::array& array, std::span<const std::string> words, std::size_t& at,
                         const SourceLocation& where) {
    std::size_t index = 0;
    const bool numbered = at + 1 < words.size() && parse_index(words[at + 1], index);
    const std::string& name = words[at];
    if (!numbered && array.size() != 1)
        throw Error(where, "there are " + std::to_string(array.size()) + " [[" + name + "]] tables; say which: " +
                               name + ".0 to " + name + "." + std::to_string(array.size() - 1));
    if (index >= array.size())
        throw Error(where, "there is no [[" + name + "]] table number " + std::to_string(index) + "; there are " +
                               std::to_string(array.size()) + ", counted from 0");
    at += numbered;
    return *array.get(index);
}

// The table that the words lead to; what is not there yet is made on the way.
toml::table& open_table(toml::table& root, std::span<const std::string> words, const SourceLocation& where) {
    toml::table* table = &root;
    for (std::size_t at = 0; at < words.size(); ++at) {
        const std::string& name = words[at];
        toml::node* node = table->get(name);
        if (!node) node = &insert_parsed(*table, name, name == "response" ? "[{}]" : "{}", where.file);
        if (toml::array* array = node->as_array()) node = &open_element(*array, words, at, where);
        table = node->as_table();
        if (!table) throw Error(where, "'" + name + "' is a value, not a table");
    }
    return *table;
}

void apply_setting(toml::table& config, const std::string& key, const std::string& value) {
    const SourceLocation where{setting_prefix + key};
    const std::vector<std::string> words = split_key(key);
    if (words.size() < 2 || std::find(words.begin(), words.end(), "") != words.end())
        throw Error(where, "a dotted key such as broadphase.cell_size is wanted");
    toml::table& table = open_table(config, std::span(words).first(words.size() - 1), where);
    insert_value(table, words.back(), value, where.file);
}

struct StageTable {
    StageKind stage;
    toml::table* table;
    std::string plugin;  // the name in it, or the default
};

void collect(std::vector<StageTable>& stages, StageKind stage, toml::node* node, const std::string& default_plugin) {
    toml::table* table = node ? node->as_table() : nullptr;
    if (table) stages.push_back({stage, table, (*table)["plugin"].value_or(default_plugin)});
}

std::vector<StageTable> stage_tables(toml::table& config, const PluginDefaults& defaults) {
    std::vector<StageTable> stages;
    collect(stages, StageKind::broadphase, config.get("broadphase"), defaults.broadphase);
    collect(stages, StageKind::narrowphase, config.get("narrowphase"), defaults.narrowphase);
    collect(stages, StageKind::render, config.get("render"), defaults.render);
    if (toml::array* rules = config["response"].as_array())
        for (toml::node& rule : *rules) collect(stages, StageKind::response, &rule, defaults.response);
    return stages;
}

bool belongs_to_framework(StageKind stage, std::string_view key) {
    return key == "plugin" || (stage == StageKind::narrowphase && (key == "walls" || key == "cull")) ||
           (stage == StageKind::response && key == "when") ||
           (stage == StageKind::render && (key == "camera" || key == "light" || key == "texture"));
}

void drop_foreign_keys(const StageTable& stage, const LoadedPlugin& plugin) {
    for (auto entry = stage.table->begin(); entry != stage.table->end();) {
        const auto& [key, node] = *entry;
        const bool keep = is_setting(node) || belongs_to_framework(stage.stage, key.str()) ||
                          plugin.parameters.find(std::string(key.str()));
        entry = keep ? std::next(entry) : stage.table->erase(entry);
    }
}

}  // namespace

SourceLocation location(const toml::node& node) { return location(node.source()); }

SourceLocation location(const toml::key& key, const toml::node& value) {
    return is_setting(value) ? location(value) : location(key.source());
}

bool is_setting(const toml::node& node) {
    return node.source().path && node.source().path->starts_with(setting_prefix);
}

std::filesystem::path folder_of(const toml::node& node) {
    if (is_setting(node) || !node.source().path) return {};
    return std::filesystem::path(*node.source().path).parent_path();
}

toml::table parse_file(const std::filesystem::path& file, const std::string& what) {
    const std::string text = read_text(file, what);
    try {
        return toml::parse(text, file.string());
    } catch (const toml::parse_error& error) {
        throw Error(location(error.source()), std::string(error.description()));
    }
}

void merge_pipeline(toml::table& scene, toml::table&& pipeline) {
    for (auto&& [key, node] : pipeline) {
        const std::string name(key.str());
        if (name == "schema") continue;
        if (std::find(pipeline_tables.begin(), pipeline_tables.end(), name) == pipeline_tables.end()) {
            const std::string near = nearest_name(name, pipeline_tables);
            throw Error(
                location(key, node),
                "a pipeline file has no table '" + name + "'; " +
                    (near.empty()
                         ? "it may hold [step], [broadphase], [narrowphase], [[response]], [ledger] and [render]"
                         : "did you mean '" + near + "'?"));
        }
        move_into(scene, key, node);
    }
}

void apply_settings(toml::table& config, const Settings& settings) {
    for (const auto& [key, value] : settings) apply_setting(config, key, value);
}

void apply_settings(toml::table& config, const Settings& settings, const PluginDefaults& defaults,
                    const PluginLibrary& plugins) {
    const std::vector<StageTable> before = stage_tables(config, defaults);
    apply_settings(config, settings);
    for (const StageTable& now : stage_tables(config, defaults))
        for (const StageTable& old : before)
            if (old.table == now.table && old.plugin != now.plugin)
                if (const LoadedPlugin* plugin = plugins.find(now.stage, now.plugin)) drop_foreign_keys(now, *plugin);
}

}  // namespace kolize::config
