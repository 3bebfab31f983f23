#include <kolize/parameters.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>

namespace kolize {

namespace {

// The shortest decimal that reads back as the same double, with the exponent as people write it: 1e9, not 1e+09.
std::string shortest(double number) {
    char buffer[32];
    std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr);
    if (const auto e = text.find('e'); e != std::string::npos) {
        if (text[e + 1] == '+') text.erase(e + 1, 1);
        const auto digits = text.find_first_of("0123456789", e + 1);
        text.erase(digits, text.find_first_not_of('0', digits) - digits);
    }
    return text;
}

std::string toml_number(double number) {
    if (std::isnan(number)) return "nan";
    std::string text = shortest(number);
    const bool reads_as_integer = text.find_first_not_of("-0123456789") == std::string::npos;
    return reads_as_integer ? text + ".0" : text;
}

std::string toml_string(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            quoted += '\\';
            quoted += c;
        } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04X", static_cast<unsigned>(c));
            quoted += escape;
        } else {
            quoted += c;
        }
    }
    return quoted + '"';
}

struct Range {
    double min, max;
    bool holds(double x) const { return x >= min && x <= max; }  // false for NaN
};

// An integer parameter is stored in an int, whatever wider range was declared.
Range range_of(const Parameter& parameter) {
    if (!std::holds_alternative<std::int64_t>(parameter.default_value)) return {parameter.min, parameter.max};
    using Limits = std::numeric_limits<int>;
    return {std::max<double>(parameter.min, Limits::min()), std::min<double>(parameter.max, Limits::max())};
}

std::string range_phrase(const Range& range, const std::string& unit) {
    constexpr double largest = std::numeric_limits<double>::max();
    const std::string suffix = unit.empty() ? "" : " " + unit;
    if (range.min > -largest && range.max < largest)
        return "from " + shortest(range.min) + " to " + shortest(range.max) + suffix;
    if (range.min > -largest) return "at least " + shortest(range.min) + suffix;
    if (range.max < largest) return "at most " + shortest(range.max) + suffix;
    return "a finite number";
}

std::string choice_phrase(const std::vector<std::string>& choices) {
    std::string phrase = "one of ";
    for (const std::string& choice : choices) {
        if (&choice != &choices.front()) phrase += ", ";
        phrase += toml_string(choice);
    }
    return phrase;
}

const char* type_phrase(const Parameter& parameter) {
    constexpr const char* phrases[] = {"true or false", "an integer", "a number", "text"};
    return phrases[parameter.default_value.index()];
}

}  // namespace

std::string to_string(const Value& value) {
    struct {
        std::string operator()(bool flag) const { return flag ? "true" : "false"; }
        std::string operator()(std::int64_t number) const { return std::to_string(number); }
        std::string operator()(double number) const { return toml_number(number); }
        std::string operator()(const std::string& text) const { return toml_string(text); }
    } const as_toml;
    return std::visit(as_toml, value);
}

Value Parameter::coerce(const Value& value) const {
    const auto* integer = std::get_if<std::int64_t>(&value);
    if (integer && std::holds_alternative<double>(default_value)) return static_cast<double>(*integer);
    return value;
}

std::string Parameter::complaint(const Value& value) const {
    const Value coerced = coerce(value);
    const std::string given = ", is " + to_string(value);
    if (coerced.index() != default_value.index()) {
        const std::string wanted = choices.empty() ? type_phrase(*this) : choice_phrase(choices);
        return "must be " + wanted + given;
    }
    if (const auto* text = std::get_if<std::string>(&coerced)) {
        const bool taken = choices.empty() || std::find(choices.begin(), choices.end(), *text) != choices.end();
        return taken ? "" : "must be " + choice_phrase(choices) + given;
    }
    if (std::holds_alternative<bool>(coerced)) return "";
    const auto* integer = std::get_if<std::int64_t>(&coerced);
    const double number = integer ? static_cast<double>(*integer) : std::get<double>(coerced);
    const Range range = range_of(*this);
    return range.holds(number) ? "" : "must be " + range_phrase(range, unit) + given;
}

const char* Parameter::type_name() const {
    constexpr const char* names[] = {"boolean", "integer", "number", "text"};
    return names[default_value.index()];
}

const Parameter* ParameterList::find(const std::string& name) const {
    const auto found = std::find_if(items.begin(), items.end(), [&](const Parameter& p) { return p.name == name; });
    return found == items.end() ? nullptr : &*found;
}

}  // namespace kolize
