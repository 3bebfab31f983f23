#include <catch2/catch.hpp>
#include <kolize/plugin.h>

#include <cmath>
#include <cstdlib>
#include <limits>

using namespace kolize;

namespace {

class Tuned final : public Stage {
public:
    static void parameters(Parameters<Tuned>& p) {
        p.add("strict", &Tuned::strict).doc("Be strict.");
        p.add("passes", &Tuned::passes).range(1, 8);
        p.add("count", &Tuned::count);
        p.add("cell_size", &Tuned::cell_size).unit("m").range(0, 1e9).doc("Side of a cell.");
        p.add("offset", &Tuned::offset);
        p.add("precision", &Tuned::precision).choices({"float", "double"});
        p.add("label", &Tuned::label);
    }

    bool strict = true;
    int passes = 2;
    int count = -5;
    double cell_size = 0.5;
    double offset = 0;
    std::string precision = "double";
    std::string label = "none";
};

ParameterList declared() {
    ParameterList list;
    detail::declare<Tuned>(list);
    return list;
}

std::string complaint(const char* name, const Value& value) {
    const ParameterList list = declared();
    return list.find(name)->complaint(value);
}

Value integer(std::int64_t number) { return number; }
Value text(const char* characters) { return std::string(characters); }

}  // namespace

TEST_CASE("one declaration gives name, type, default, unit, range and doc", "[parameters]") {
    const ParameterList list = declared();
    REQUIRE(list.items.size() == 7);
    CHECK(list.items.front().name == "strict");
    CHECK(list.items.back().name == "label");
    const Parameter& cell_size = *list.find("cell_size");
    CHECK(cell_size.type_name() == std::string("number"));
    CHECK(cell_size.default_value == Value(0.5));
    CHECK(cell_size.unit == "m");
    CHECK(cell_size.min == 0);
    CHECK(cell_size.max == 1e9);
    CHECK(cell_size.doc == "Side of a cell.");
    CHECK(list.find("strict")->type_name() == std::string("boolean"));
    CHECK(list.find("passes")->type_name() == std::string("integer"));
    CHECK(list.find("label")->type_name() == std::string("text"));
    CHECK(list.find("cell_siz") == nullptr);
}

TEST_CASE("a parameter is set in the object and read back from it", "[parameters]") {
    const ParameterList list = declared();
    Tuned stage;
    list.find("strict")->set(stage, false);
    list.find("passes")->set(stage, integer(7));
    list.find("cell_size")->set(stage, 2.5);
    list.find("precision")->set(stage, text("float"));
    CHECK_FALSE(stage.strict);
    CHECK(stage.passes == 7);
    CHECK(stage.cell_size == 2.5);
    CHECK(stage.precision == "float");
    CHECK(list.find("passes")->get(stage) == integer(7));
    CHECK(list.find("precision")->get(stage) == text("float"));
}

TEST_CASE("every default is accepted by its own parameter", "[parameters]") {
    for (const Parameter& parameter : declared().items) {
        CAPTURE(parameter.name);
        CHECK(parameter.complaint(parameter.default_value).empty());
    }
}

TEST_CASE("a number parameter takes an integer, an integer parameter takes no fraction", "[parameters]") {
    CHECK(complaint("cell_size", integer(3)).empty());
    CHECK(declared().find("cell_size")->coerce(integer(3)) == Value(3.0));
    CHECK(declared().find("passes")->coerce(integer(3)) == integer(3));
    CHECK(complaint("passes", 2.5) == "must be an integer, is 2.5");
    CHECK(complaint("passes", 2.0) == "must be an integer, is 2.0");
}

TEST_CASE("a value of the wrong type is refused with the type that would be right", "[parameters]") {
    CHECK(complaint("strict", integer(1)) == "must be true or false, is 1");
    CHECK(complaint("strict", text("yes")) == "must be true or false, is \"yes\"");
    CHECK(complaint("passes", true) == "must be an integer, is true");
    CHECK(complaint("cell_size", text("fast")) == "must be a number, is \"fast\"");
    CHECK(complaint("label", integer(3)) == "must be text, is 3");
    CHECK(complaint("precision", integer(3)) == "must be one of \"float\", \"double\", is 3");
}

TEST_CASE("a number out of range is refused with the range and its unit", "[parameters]") {
    CHECK(complaint("cell_size", 0.0).empty());
    CHECK(complaint("cell_size", 1e9).empty());
    CHECK(complaint("cell_size", -1.0) == "must be from 0 to 1e9 m, is -1.0");
    CHECK(complaint("cell_size", integer(-1)) == "must be from 0 to 1e9 m, is -1");
    CHECK(complaint("cell_size", 1.5e9) == "must be from 0 to 1e9 m, is 1.5e9");
    CHECK(complaint("passes", integer(9)) == "must be from 1 to 8, is 9");
    CHECK(complaint("passes", integer(1)).empty());
    CHECK(complaint("passes", integer(8)).empty());

    Parameter half_open = *declared().find("offset");
    half_open.min = 0.25;
    CHECK(half_open.complaint(0.0) == "must be at least 0.25, is 0.0");
    half_open = *declared().find("offset");
    half_open.max = 1e-5;
    CHECK(half_open.complaint(1.0) == "must be at most 1e-5, is 1.0");
}

TEST_CASE("what is no finite number is refused by every number parameter", "[parameters]") {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    CHECK(complaint("cell_size", nan) == "must be from 0 to 1e9 m, is nan");
    CHECK(complaint("offset", nan) == "must be a finite number, is nan");
    CHECK(complaint("offset", infinity) == "must be a finite number, is inf");
    CHECK(complaint("offset", -infinity) == "must be a finite number, is -inf");
    CHECK(complaint("offset", std::numeric_limits<double>::max()).empty());
}

TEST_CASE("an integer that an int does not hold is refused, not cut off", "[parameters]") {
    CHECK(complaint("count", integer(2147483647)).empty());
    CHECK(complaint("count", integer(-2147483648)).empty());
    CHECK(complaint("count", integer(2147483648)) == "must be from -2147483648 to 2147483647, is 2147483648");
    CHECK(complaint("count", integer(-2147483649)) == "must be from -2147483648 to 2147483647, is -2147483649");
}

TEST_CASE("text outside the choices is refused with all of them", "[parameters]") {
    CHECK(complaint("precision", text("float")).empty());
    CHECK(complaint("precision", text("half")) == "must be one of \"float\", \"double\", is \"half\"");
    CHECK(complaint("label", text("anything at all")).empty());
}

TEST_CASE("a value is printed as it would stand in a TOML file", "[parameters]") {
    CHECK(to_string(Value(true)) == "true");
    CHECK(to_string(integer(-7)) == "-7");
    CHECK(to_string(Value(1.0)) == "1.0");
    CHECK(to_string(Value(-0.0)) == "-0.0");
    CHECK(to_string(Value(0.1)) == "0.1");
    CHECK(to_string(Value(1e100)) == "1e100");
    CHECK(to_string(Value(2.5e-7)) == "2.5e-7");
    CHECK(to_string(text("a \"b\" \\ c")) == R"("a \"b\" \\ c")");
    CHECK(to_string(text("a\nb\x7f")) == R"("a\u000Ab\u007F")");
}

TEST_CASE("a printed number reads back as the same bits", "[parameters]") {
    for (const double number : {1.0 / 3, 4.9e-324, 1.7976931348623157e308, 123456789012345680.0, 1e21, 1e-5})
        CHECK(std::strtod(to_string(Value(number)).c_str(), nullptr) == number);
}
