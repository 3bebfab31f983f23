#include <catch2/catch.hpp>
#include <kolize/broadphase.h>

using namespace kolize;

namespace {

constexpr double most = std::numeric_limits<double>::max();

std::string complaint(const std::vector<Aabb>& bounds) {
    try {
        require_valid_bounds(bounds);
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST_CASE("points, flat boxes and the largest numbers are valid bounds", "[broadphase]") {
    CHECK(complaint({}) == "");
    CHECK(complaint({{{1, 2, 3}, {1, 2, 3}}, {{0, 0, 0}, {1, 0, 1}}}) == "");
    CHECK(complaint({{Vec3::Constant(-most), Vec3::Constant(most)}}) == "");
}

TEST_CASE("the first bad row is named, with its box", "[broadphase]") {
    const Aabb good{{0, 0, 0}, {1, 1, 1}};
    CHECK(complaint({good, {{0, 0.5, 0}, {1, 0.25, 1}}, {{0, 0, 2}, {1, 1, 1}}}) ==
          "the box of row 1 is inverted: min (0, 0.5, 0), max (1, 0.25, 1)");
    CHECK(complaint({good, good, {{0, 0, 0}, {1, infinity, 1}}}) ==
          "the box of row 2 is not finite: min (0, 0, 0), max (1, inf, 1)");
    CHECK(complaint({{{0, 0, std::nan("")}, {1, 1, 1}}}).starts_with("the box of row 0 is not finite"));
    CHECK(complaint({Aabb{}}).starts_with("the box of row 0 is not finite"));  // an empty box
}
