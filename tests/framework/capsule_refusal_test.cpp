#include "framework/capsules.h"

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

std::string refusal(const std::string& text) {
    try {
        read_capsule(text);
    } catch (const Error& error) {
        const std::string what = error.what();
        return what.substr(what.rfind('/') + 1);
    }
    return "";
}

std::string good_capsule() {
    const auto host = make_host(1);
    Simulation simulation(mixed_crowd(), liars(), *host, 4);
    advance(simulation, 3);
    return capsule_text(simulation.capture(), "a test");
}

// The text with the first line that begins so replaced, from the given place on.
std::string with(std::string text, const std::string& begin, const std::string& line, const std::string& after) {
    const std::size_t from = text.find("\n" + begin, text.find(after)) + 1;
    return text.replace(from, text.find('\n', from) - from, line);
}

}  // namespace

TEST_CASE("a capsule with anything wrong is refused in a sentence with its line", "[capsule]") {
    const std::string good = good_capsule();
    REQUIRE(refusal(good).empty());
    struct Case {
        const char *table, *key, *line, *sentence;
    };
    const Case cases[] = {
        {"[capsule]", "step", "step = -1", "step must be from 0 to 1e+15, is -1"},
        {"[capsule]", "step", "stop = 3", "no key 'stop' in [capsule]"},
        {"[[capsule.body]]", "velocity", "velocity = \"0x1p+0 nan 0x0p+0\"", "velocity must be finite, is nan"},
        {"[[capsule.body]]", "velocity", "velocity = \"0x1p+0 0x1p+9999 0x0p+0\"", "velocity must be"},
        {"[[capsule.body]]", "velocity", "velocity = \"0x1p+0 0x1p+0\"", "velocity must have 3 numbers, has 2"},
        {"[[capsule.body]]", "velocity", "velocity = \"fast 0x1p+0 0x1p+0\"",
         "velocity must be made of numbers such as 0x1.8p+1, is fast"},
        {"[[capsule.body]]", "velocity", "velocity = [1, 2, 3]", "velocity must be text, is an array"},
        {"[[capsule.body]]", "velocity", "", "[[capsule.body]] needs velocity"},
        {"[[capsule.body]]", "inverse_mass", "inverse_mass = \"-0x1p+0\"", "inverse_mass must be greater than "},
        {"[[capsule.body]]", "inverse_mass", "inverse_mass = \"0x0p+0\"", "inverse_mass must be greater than "},
        {"[[capsule.body]]", "inverse_inertia", "inverse_inertia = \"0x1p+0 -0x1p+0 0x1p+0\"",
         "inverse_inertia must be greater than "},
        {"[[capsule.body]]", "orientation", "orientation = \"0x1p+0 0x1p+0 0x1p+0 0x1p+0\"",
         "orientation must be a unit quaternion"},
        {"[[capsule.body]]", "shape", "shape = 99", "shape must be a number below "},
        {"[[capsule.body]]", "shape", "shape = -1", "shape must be a number below "},
        {"[[capsule.body]]", "shape", "shape = 3", "shape is a half_space, which only a static body can have"},
        {"[[capsule.body]]", "material", "material = 2", "material must be a number below 2"},
        {"[[capsule.material]]", "restitution", "restitution = \"0x1p+1\"",
         "restitution must be at least 0.0 and at most 1.0"},
        {"[[capsule.shape]]", "kind", "kind = \"cone\"", "there is no kind 'cone'"},
        {"[[capsule.shape]]", "half_extents", "half_extents = \"0x1p+0 0x0p+0 0x1p+0\"",
         "half_extents must be greater than 0.0"},
        {"[[capsule.shape]]", "volume", "volume = \"-0x1p+0\"", "volume must be greater than 0.0"},
        {"triangles = ", "0 ", "0 1 99", "triangles must be made of numbers of vertices, of which there are 16"},
        {"triangles = ", "0 ", "0 1 1.5", "triangles must be made of numbers of vertices, of which there are 16"},
        {"triangles = ", "0 ", "0 1 -2", "triangles must be at least 0.0, is -2"},
        {"triangles = ", "0 ", "", "triangles must be the closed surface of a solid, but "},
        {"vertices = ", "", "0x1p+0 0x1p+0", "vertices must have three numbers for each"},
        {"[[capsule.room]]", "max", "max = \"0x0p+0 -0x1p+9 0x1p+9\"", "max must be greater than min on every axis"},
        {"[broadphase]", "plugin", "plugin = \"grid\"\n[[body]]",
         "a capsule has its world in [capsule], and no table 'body'"},
    };
    for (const Case& wrong : cases) {
        CAPTURE(wrong.table, wrong.key, wrong.line);
        const std::string sentence = refusal(with(good, wrong.key, wrong.line, wrong.table));
        INFO(sentence);
        CHECK(sentence.starts_with("capsule.toml:"));
        CHECK(sentence.find(wrong.sentence) != std::string::npos);
        CHECK(sentence.find('\n') == std::string::npos);
    }
}

TEST_CASE("a wrong number in a long text is found on its own line", "[capsule]") {
    std::string text = good_capsule();
    const std::size_t third = text.find('\n', text.find('\n', text.find("vertices = \"\"\"") + 20) + 1) + 1;
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(third), '\n');
    text.replace(third, 3, "no!");
    CHECK(refusal(text).starts_with("capsule.toml:" + std::to_string(line) + ": vertices must be made of numbers"));
}

// Whatever happens to the file: it is refused by an Error, or it is a scene that a simulation takes or refuses.
TEST_CASE("a damaged capsule does no harm", "[capsule]") {
    const std::string good = good_capsule();
    const unsigned seed = 5;
    CAPTURE(seed);
    std::mt19937 random(seed);
    const auto host = make_host(1);
    int refused = 0;
    for (int i = 0; i < 160; ++i) {
        std::string text = good;
        if (i % 4 == 0) text.resize(random() % text.size());
        for (int change = 0; i % 4 != 0 && change < 3; ++change) {
            const std::size_t at = random() % text.size();
            if (i % 4 == 1) text[at] = "0123456789abcdefpx-+.\" \n[]=_"[random() % 28];
            if (i % 4 == 2) text.erase(at, random() % 20);
            if (i % 4 == 3) text.insert(at, text.substr(random() % text.size(), random() % 20));
        }
        CAPTURE(i);
        try {
            const Scene scene = read_capsule(text);
            Simulation simulation(scene, liars(), *host, 2);
            try {
                advance(simulation, 2);
            } catch (const std::runtime_error&) {  // bodies may be anywhere and as fast as doubles go
            }
        } catch (const Error& error) {
            ++refused;
            CHECK(std::string(error.what()).size() > 10);
        }
    }
    CHECK(refused > 20);
}
