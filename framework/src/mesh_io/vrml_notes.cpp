#include "mesh_io/vrml_notes.h"

#include "mesh_io/formats.h"

#include <algorithm>

namespace kolize::mesh_io::vrml {

namespace {

constexpr std::size_t most_kinds = 100;  // so that a file of odd names is no longer told than it is itself

bool says_nothing_of_the_surface(std::string_view type) {
    constexpr std::string_view types[] = {"Viewpoint",        "NavigationInfo", "Background", "Fog",  "Sound",
                                          "DirectionalLight", "PointLight",     "SpotLight",  "Color"};
    return std::find(std::begin(types), std::end(types), type) != std::end(types);
}

// Types that differ only in what they sense or interpolate are one kind.
std::string kind_of(std::string_view type) {
    if (type.ends_with("Interpolator")) return "interpolators";
    if (type.ends_with("Sensor")) return "sensors";
    return printable(type) + " nodes";
}

}  // namespace

void Notes::pass_over_node(std::string_view type, int line) {
    if (says_nothing_of_the_surface(type)) return;
    const std::string kind = kind_of(type);
    count(kind, {printable(type) + " is not used", kind + " are not used", line});
}

void Notes::pass_over_statement(std::string_view keyword, int line) {
    const std::string name(keyword);
    count(name, {name + " is not used", name + " statements are not used", line});
}

void Notes::add(const std::string& sentence, int line) { count(sentence, {sentence, "", line}); }

void Notes::count(const std::string& key, const Kind& kind) {
    const bool full = kinds_.size() >= most_kinds && !kinds_.contains(key);
    const Kind other{"something else is not used", "other things are not used", kind.line};
    Kind& counted = kinds_.try_emplace(full ? "other" : key, full ? other : kind).first->second;
    ++counted.count;
}

std::vector<std::string> Notes::sentences(const std::string& file) const {
    std::vector<const Kind*> by_line;
    for (const auto& [key, kind] : kinds_) by_line.push_back(&kind);
    std::stable_sort(by_line.begin(), by_line.end(), [](const Kind* a, const Kind* b) { return a->line < b->line; });
    std::vector<std::string> sentences;
    for (const Kind* kind : by_line) {
        const bool plural = kind->count > 1 && !kind->many.empty();
        sentences.push_back(to_string(SourceLocation{file, kind->line}) + ": " +
                            (plural ? std::to_string(kind->count) + " " + kind->many : kind->one));
    }
    return sentences;
}

}  // namespace kolize::mesh_io::vrml
