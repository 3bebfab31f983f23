#include "key_script.h"

#include <kolize/error.h>
#include <kolize/parameters.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

namespace kolize::tunnel {
namespace {

constexpr double press_time = 0.1;  // s

const std::vector<std::pair<std::string, Key>>& named_keys() {
    static const std::vector<std::pair<std::string, Key>> keys = {
        {"space", Key::space},   {"minus", Key::minus},     {"period", Key::period},   {"equal", Key::equal},
        {"escape", Key::escape}, {"enter", Key::enter},     {"tab", Key::tab},         {"backspace", Key::backspace},
        {"left", Key::left},     {"right", Key::right},     {"up", Key::up},           {"down", Key::down},
        {"home", Key::home},     {"end", Key::end},         {"page_up", Key::page_up}, {"page_down", Key::page_down},
        {"shift", Key::shift},   {"control", Key::control}, {"alt", Key::alt},         {"f1", Key::f1},
        {"f2", Key::f2},         {"f3", Key::f3},           {"f4", Key::f4},           {"f5", Key::f5},
        {"f6", Key::f6},         {"f7", Key::f7},           {"f8", Key::f8},           {"f9", Key::f9},
        {"f10", Key::f10},       {"f11", Key::f11},         {"f12", Key::f12}};
    return keys;
}

const std::vector<std::string> buttons = {"left_button", "right_button", "middle_button"};

struct Word {
    std::string text;
    SourceLocation where;
};

std::vector<Word> words_of(const std::string& line, const std::string& file, int number) {
    std::vector<Word> words;
    const std::size_t end = std::min(line.find('#'), line.size());
    for (std::size_t i = 0; i < end;) {
        if (std::isspace(static_cast<unsigned char>(line[i]))) {
            ++i;
            continue;
        }
        Word word{"", {file, number, static_cast<int>(i + 1)}};
        while (i < end && !std::isspace(static_cast<unsigned char>(line[i]))) word.text += line[i++];
        words.push_back(word);
    }
    return words;
}

double number(const Word& word, double max, const std::string& what) {
    double value = 0;
    const char* end = word.text.data() + word.text.size();
    const auto [rest, error] = std::from_chars(word.text.data(), end, value);
    if (error != std::errc() || rest != end || !(value >= 0 && value <= max))
        throw Error(word.where, what + " must be a number, is '" + word.text + "'");
    return value;
}

// The event that pushes it down, without a place.
WindowEvent push_of(const Word& word) {
    WindowEvent event;
    event.kind = WindowEventKind::key_down;
    const unsigned char first = static_cast<unsigned char>(word.text[0]);
    if (word.text.size() == 1 && std::isalnum(first)) {
        event.key = static_cast<Key>(std::toupper(first));
        return event;
    }
    std::vector<std::string> names = buttons;
    for (const auto& [name, key] : named_keys()) {
        names.push_back(name);
        if (name == word.text) event.key = key;
    }
    const auto button = std::find(buttons.begin(), buttons.end(), word.text);
    if (button != buttons.end()) {
        event.kind = WindowEventKind::button_down;
        event.button = static_cast<std::uint32_t>(button - buttons.begin());
    } else if (event.key == Key::unknown) {
        const std::string near = nearest_name(word.text, names);
        throw Error(word.where,
                    "there is no key '" + word.text + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
    return event;
}

WindowEvent release_of(WindowEvent push) {
    push.kind = push.kind == WindowEventKind::key_down ? WindowEventKind::key_up : WindowEventKind::button_up;
    return push;
}

// One line's events; `words` is not empty. Returns its time.
double read_line(const std::vector<Word>& words, std::vector<TimedEvent>& events) {
    constexpr double longest = 1e6;
    const double time = number(words[0], longest, "the time in s, from 0 to 1e6,");
    const std::string verb = words.size() > 1 ? words[1].text : "";
    const bool moves = verb == "move";
    if (!moves && verb != "down" && verb != "up" && verb != "press")
        throw Error(words[words.size() > 1].where,
                    "after the time comes down, up, press or move" + (verb.empty() ? "" : ", not '" + verb + "'"));
    const std::size_t place = moves ? 2 : 3;
    if (words.size() != place + 2 && (moves || words.size() != place))
        throw Error(words.back().where,
                    moves ? "move takes X and Y" : verb + " takes a key, and may have X and Y after it");
    WindowEvent pointer;
    pointer.kind = WindowEventKind::pointer;
    if (words.size() == place + 2) {
        pointer.x = number(words[place], 1, "X, from 0 to 1,");
        pointer.y = number(words[place + 1], 1, "Y, from 0 to 1,");
        events.push_back({time, pointer});
    }
    if (moves) return time;
    WindowEvent push = push_of(words[2]);
    push.x = pointer.x, push.y = pointer.y;
    if (verb != "up") events.push_back({time, push});
    if (verb != "down") events.push_back({time + (verb == "press" ? press_time : 0), release_of(push)});
    return time;
}

}  // namespace

std::vector<TimedEvent> parse_key_script(const std::string& text, const std::string& file) {
    std::vector<TimedEvent> events;
    double latest = 0;
    int line_number = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::vector<Word> words = words_of(text.substr(begin, end - begin), file, ++line_number);
        begin = end + 1;
        if (words.empty()) continue;
        const double time = read_line(words, events);
        if (time < latest)
            throw Error(words[0].where, "the times of a key script never decrease; a line above is of " +
                                            to_string(Value(latest)) + " s");
        latest = time;
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const TimedEvent& a, const TimedEvent& b) { return a.time < b.time; });
    return events;
}

std::vector<TimedEvent> read_key_script(const std::filesystem::path& file) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(file, failure))
        throw Error(SourceLocation{file.string()}, "there is no such key script");
    std::ifstream in(file, std::ios::binary);
    return parse_key_script({std::istreambuf_iterator<char>(in), {}}, file.string());
}

}  // namespace kolize::tunnel
