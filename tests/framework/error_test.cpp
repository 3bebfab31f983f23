#include <catch2/catch.hpp>
#include <kolize/error.h>

#include <random>
#include <string>
#include <vector>

using namespace kolize;

namespace {

// The definition itself: the cheapest of the three edits at the first character, and so on.
int plain_distance(const std::string& a, const std::string& b) {
    if (a.empty() || b.empty()) return static_cast<int>(a.size() + b.size());
    const int replaced = plain_distance(a.substr(1), b.substr(1)) + (a[0] != b[0]);
    return std::min({replaced, plain_distance(a.substr(1), b) + 1, plain_distance(a, b.substr(1)) + 1});
}

std::string random_word(std::mt19937& random) {
    std::string word(random() % 6, ' ');
    for (char& c : word) c = static_cast<char>('a' + random() % 3);
    return word;
}

}  // namespace

TEST_CASE("a place is printed as far as it is known", "[error]") {
    CHECK(to_string(SourceLocation{"scene.toml", 7, 3}) == "scene.toml:7:3");
    CHECK(to_string(SourceLocation{"scene.toml", 7, 0}) == "scene.toml:7");
    CHECK(to_string(SourceLocation{"--set step.dt", 0, 0}) == "--set step.dt");
    CHECK(to_string(SourceLocation{"scene.toml", 0, 3}) == "scene.toml");
}

TEST_CASE("an error begins with its place", "[error]") {
    CHECK(Error({"scene.toml", 7, 3}, "no such key").what() == std::string("scene.toml:7:3: no such key"));
    CHECK(Error(SourceLocation{}, "no such key").what() == std::string("no such key"));
    CHECK(Error("no such key").what() == std::string("no such key"));
}

TEST_CASE("the edit distance is the least number of edits", "[error]") {
    const unsigned seed = 20261122;
    CAPTURE(seed);
    std::mt19937 random(seed);
    for (int i = 0; i < 300; ++i) {
        const std::string a = random_word(random), b = random_word(random);
        CAPTURE(a, b);
        CHECK(edit_distance(a, b) == plain_distance(a, b));
    }
}

TEST_CASE("a slip of the pen is answered with the nearest name, nonsense with none", "[error]") {
    const std::vector<std::string> names = {"grid", "bsp", "brute_force", "sphere_hierarchy"};
    CHECK(nearest_name("gird", names) == "grid");
    CHECK(nearest_name("brute-force", names) == "brute_force");
    CHECK(nearest_name("sphere_hirarchy", names) == "sphere_hierarchy");
    CHECK(nearest_name("octree", names).empty());
    CHECK(nearest_name("", names).empty());
    CHECK(nearest_name("grid", std::vector<std::string>{}).empty());
    CHECK(nearest_name("cell_siz", std::vector<std::string>{"cell_sizes", "cell_size"}) == "cell_size");
}
