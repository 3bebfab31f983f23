// Parameters of a plugin, each declared once, by member pointer:
//
//     static void parameters(Parameters<Grid>& p) {
//         p.add("cell_size", &Grid::cell_size_).unit("m").range(0, 1e9).doc("Side of a cell; 0 chooses it.");
//     }
//
// The default is the default-constructed value. Validation, error text, `kolize plugins show`, the docs and the echoed
// configuration all come from that line.
#pragma once

#include <kolize/stage.h>

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace kolize {

using Value = std::variant<bool, std::int64_t, double, std::string>;

// As it would stand in a TOML file.
KOLIZE_API std::string to_string(const Value& value);

struct Parameter {
    std::string name;
    std::string unit;  // "" for a pure number or a choice
    std::string doc;
    Value default_value;                   // its alternative is the parameter's type
    double min = -1.7976931348623157e308;  // inclusive; numbers only
    double max = 1.7976931348623157e308;
    std::vector<std::string> choices;  // strings only; empty: anything
    std::function<void(Stage&, const Value&)> set;
    std::function<Value(const Stage&)> get;

    // Converts an integer to a real parameter's type; otherwise the value as it is.
    KOLIZE_API Value coerce(const Value& value) const;
    // Why the value cannot be taken ("must be a number, is \"fast\"", "must be from 0 to 1 m, is 3"), or "".
    KOLIZE_API std::string complaint(const Value& value) const;
    // "boolean", "integer", "number", "text".
    KOLIZE_API const char* type_name() const;
};

// All parameters of one plugin, in the order of their declaration.
struct ParameterList {
    std::vector<Parameter> items;

    KOLIZE_API const Parameter* find(const std::string& name) const;
};

class ParameterBuilder {
public:
    explicit ParameterBuilder(Parameter& parameter) : parameter_(parameter) {}
    ParameterBuilder& unit(std::string text) {
        parameter_.unit = std::move(text);
        return *this;
    }
    ParameterBuilder& range(double min, double max) {
        parameter_.min = min;
        parameter_.max = max;
        return *this;
    }
    ParameterBuilder& choices(std::vector<std::string> names) {
        parameter_.choices = std::move(names);
        return *this;
    }
    ParameterBuilder& doc(std::string text) {
        parameter_.doc = std::move(text);
        return *this;
    }

private:
    Parameter& parameter_;
};

template <class T>
class Parameters {
public:
    Parameters(ParameterList& list, const T& defaults) : list_(list), defaults_(defaults) {}

    // M: bool, int, double or std::string. The builder is used up in the same statement.
    template <class C, class M>
    ParameterBuilder add(std::string name, M C::*member) {
        using Stored = std::conditional_t<std::is_same_v<M, int>, std::int64_t, M>;
        Parameter& parameter = list_.items.emplace_back();
        parameter.name = std::move(name);
        parameter.default_value = Stored(defaults_.*member);
        parameter.set = [member](Stage& stage, const Value& value) {
            static_cast<T&>(stage).*member = static_cast<M>(std::get<Stored>(value));
        };
        parameter.get = [member](const Stage& stage) { return Value(Stored(static_cast<const T&>(stage).*member)); };
        return ParameterBuilder(parameter);
    }

private:
    ParameterList& list_;
    const T& defaults_;
};

}  // namespace kolize
