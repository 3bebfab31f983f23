#include "demos/tunnel_games.h"

#include <catch2/catch.hpp>

#include <numbers>
#include <set>

using namespace kolize;
using namespace kolize::test;

namespace {

// The cells of `middle` stand between two ends at (0 0 0) and `last`.
std::string complaint_about(const std::string& text) {
    return complaint_of([&] { parse_tunnel(text, "t.txt"); });
}

const std::string first = "S (0 0 0)(0 1 0) 1.0 END END\n";
const std::string last = "\nS (0 0 -1)(0 0 1) 0 END END";

std::string text(const Place& place) {
    return std::to_string(place.x()) + " " + std::to_string(place.y()) + " " + std::to_string(place.z());
}

Cell cell_of(CellType type, const Vec3& axis, double angle) {
    Cell cell;
    cell.type = type;
    cell.rotation = Eigen::AngleAxisd(angle * std::numbers::pi, axis.normalized()).toRotationMatrix().array().round();
    return cell;
}

}  // namespace

TEST_CASE("A tunnel file gives cells, statics and dynamics where it says", "[tunnel]") {
    const Tunnel tunnel = parse_tunnel(
        "/* two cubes\n and a half */ S (0 0 0)(0 1 0) 1.0 END END\n"
        "I (0 0 -1)(0 0 1) 0.0 Frustum.obj (0 -0.5 0)(0 0 1) 1.0 END Cube.obj ( 0 0 1e-1 )(0 3 0) 0.5/**/END\n"
        "S (0 0 -2)(0 0 1) 0.0 END\tball (0.25 0 0)(1 0 0) -2.5\r\nball (-0.25 0 0)(1 0 0) 0 END",
        "t.txt");
    REQUIRE(tunnel.cells.size() == 3);
    const Cell& middle = tunnel.cells[1];
    CHECK(middle.type == CellType::straight);
    CHECK(middle.place == Place(0, 0, -1));
    CHECK(middle.where.line == 3);
    CHECK(middle.where.column == 1);
    REQUIRE(middle.statics.size() == 1);
    CHECK(middle.statics[0].file == "Frustum.obj");
    CHECK(middle.statics[0].position == Vec3(0, -0.5, 0));
    CHECK((middle.statics[0].orientation * Vec3(1, 2, 3)).isApprox(Vec3(-1, -2, 3), 1e-15));
    REQUIRE(middle.dynamics.size() == 1);
    CHECK(middle.dynamics[0].position == Vec3(0, 0, 0.1));
    CHECK((middle.dynamics[0].orientation * Vec3::UnitX()).isApprox(-Vec3::UnitZ(), 1e-15));
    CHECK(middle.dynamics[0].where.column == 61);
    REQUIRE(tunnel.cells[2].dynamics.size() == 2);
    CHECK((tunnel.cells[2].dynamics[0].orientation * Vec3::UnitY()).isApprox(-Vec3::UnitZ(), 1e-12));
    CHECK(tunnel.cells[2].statics.empty());
}

TEST_CASE("Cells are flown through in the order of their openings, whatever their order in the file", "[tunnel]") {
    const Tunnel tunnel = parse_tunnel(first +
                                           "L (-1 0 -1)(0 1 0) 0.5 END END  L (0 0 -1)(0 0 1) 0 END END\n"
                                           "S (-1 0 0)(0 1 0) 1 END END",
                                       "t.txt");
    REQUIRE(tunnel.cells.size() == 4);
    CHECK(tunnel.cells[0].back.isZero());
    CHECK(tunnel.cells[0].ahead == Place(0, 0, -1));
    CHECK(tunnel.cells[1].place == Place(0, 0, -1));
    CHECK(tunnel.cells[1].back == Place(0, 0, 1));
    CHECK(tunnel.cells[1].ahead == Place(-1, 0, 0));
    CHECK(tunnel.cells[2].place == Place(-1, 0, -1));
    CHECK(tunnel.cells[2].ahead == Place(0, 0, 1));
    CHECK(tunnel.cells[3].ahead.isZero());
}

TEST_CASE("What is no tunnel is refused where it goes wrong", "[tunnel]") {
    const std::vector<std::pair<std::string, std::string>> table = {
        {"", "t.txt: this tunnel has no cell; it takes at least two, S and S"},
        {"  /* nothing */ ", "t.txt: this tunnel has no cell; it takes at least two, S and S"},
        {first, "t.txt:1:1: a tunnel ends with another cell of type S"},
        {"X (0 0 0)", "t.txt:1:1: a cell begins with its type, S, I, L or R, not with 'X'"},
        {"S\n /* (0 0 0)", "t.txt:2:2: this comment has no end; it takes a */"},
        {"S 0 0 0", "t.txt:1:3: a '(' is wanted here, not '0'"},
        {"S (0 0)", "t.txt:1:7: a number is wanted here, not ')'"},
        {"S (0 0 0 0)", "t.txt:1:10: a ')' is wanted here, not '0'"},
        {"S (0 0 0", "t.txt:1:9: a ')' is wanted here, not the end of the file"},
        {"S (0 0 zero)", "t.txt:1:8: a number is wanted here, not 'zero'"},
        {"S (0 0 1x)", "t.txt:1:8: a number is wanted here, not '1x'"},
        {"S (0 0 nan)", "t.txt:1:8: a number must be finite, not 'nan'"},
        {"S (0 -inf 0)", "t.txt:1:6: a number must be finite, not '-inf'"},
        {"S (1e999 0 0)", "t.txt:1:4: a number must be finite, not '1e999'"},
        {"S (0 0.5 0)", "t.txt:1:6: a cell stands at a whole number of cubes, not at 0.5"},
        {"S (0 10001 0)", "t.txt:1:6: a cell stands at most 10000 cubes from the origin"},
        {"S (0 0 0)(0 0 0) 1", "t.txt:1:10: the axis of a rotation must have a length above 0"},
        {"S (0 0 0)(0 0 1) 0.25",
         "t.txt:1:10: the rotation of a cell must map the cube to itself: 0.5 or 1.0 about an edge of it, say"},
        {"S (0 0 0)(1 1 0) 0.5",
         "t.txt:1:10: the rotation of a cell must map the cube to itself: 0.5 or 1.0 about an edge of it, say"},
        {"S (0 0 0)(0 1 0) 1.0", "t.txt:1:21: the statics of this cell have no END before the end of the file"},
        {"S (0 0 0)(0 1 0) 1.0 END", "t.txt:1:25: the dynamics of this cell have no END before the end of the file"},
        {"S (0 0 0)(0 1 0) 1.0 END\nI (0 0 -1)", "t.txt:2:1: the dynamics of this cell have no END before 'I'"},
        {"S (0 0 0)(0 1 0) 1.0 (", "t.txt:1:22: a mesh file, 'ball' or END is wanted here, not '('"},
        {"S (0 0 0)(0 1 0) 1.0 a.obj END", "t.txt:1:28: a '(' is wanted here, not 'END'"},
        {"S (0 0 0)(0 1 0) 1.0 a.obj (0 0 0)(0 0 0) 1",
         "t.txt:1:35: the axis of a rotation must have a length above 0"},
        {"I (0 0 0)(0 1 0) 1.0 END END" + last, "t.txt:1:1: a tunnel begins with a cell of type S"},
        {first + "I (0 0 -1)(0 0 1) 0 END END", "t.txt:2:1: a tunnel ends with another cell of type S"},
        {first + "I (0 0 0)(0 0 1) 0 END END" + last, "t.txt:2:1: there is a cell at (0 0 0) already, in line 1"},
        {first + "S (0 0 -2)(0 0 1) 0 END END",
         "t.txt:1:1: this cell is open towards (0 0 -1), where there is no cell"},
        {first + "S (0 0 -1)(0 1 0) 1 END END",
         "t.txt:1:1: this cell is open towards (0 0 -1), where the cell of line 2 has a wall"},
        {first + "I (5 0 0)(0 0 1) 0 END END" + last,
         "t.txt:2:1: this cell is not on the way from the first cell to the end of the tunnel"}};
    for (const auto& [tunnel, complaint] : table) {
        CAPTURE(tunnel);
        CHECK(complaint_about(tunnel) == complaint);
    }
    CHECK(complaint_about(first + last).empty());
}

TEST_CASE("Every beginning of a tunnel file is refused in one sentence or is a tunnel", "[tunnel]") {
    for (const std::string& name : tunnel_names) {
        const std::string whole = file_bytes(tunnel_folder / "tunnels" / (name + ".txt"));
        REQUIRE(complaint_about(whole).empty());
        const std::size_t last_end = whole.rfind("END") + 3;
        for (std::size_t length = 0; length < last_end; length += 3) {
            const std::string complaint = complaint_about(whole.substr(0, length));
            CAPTURE(name, length);
            CHECK(complaint.starts_with("t.txt"));
            CHECK(complaint.find('\n') == std::string::npos);
        }
    }
}

TEST_CASE("A tunnel file has its limits", "[tunnel]") {
    std::string cells, bodies;
    for (std::size_t i = 0; i <= max_cells; ++i) cells += "I (0 0 -" + std::to_string(i) + ")(0 0 1) 0 END END\n";
    CHECK(complaint_about(cells) == "t.txt:1001:1: a tunnel has at most 1000 cells");
    for (std::size_t i = 0; i <= max_bodies; ++i) bodies += "\nball (0 0 0)(0 0 1) 0";
    CHECK(complaint_about("S (0 0 0)(0 1 0) 1" + bodies) == "t.txt:5002:1: a tunnel has at most 5000 bodies");
    CHECK(complaint_of([] { read_tunnel("no/such.txt"); }) == "no/such.txt: there is no such tunnel file");
}

TEST_CASE("Cells that are turned have their openings where a hand-made table has them", "[tunnel]") {
    struct Row {
        CellType type;
        Vec3 axis;
        double angle;
        std::string entry, exit;
    };
    const CellType S = CellType::end, I = CellType::straight, L = CellType::left, R = CellType::right;
    const std::vector<Row> table = {{S, {0, 0, 1}, 0, "0 0 1", ""},           {S, {0, 1, 0}, 1, "0 0 -1", ""},
                                    {S, {0, 1, 0}, 0.5, "1 0 0", ""},         {S, {1, 0, 0}, 0.5, "0 -1 0", ""},
                                    {I, {0, 0, 1}, 0, "0 0 1", "0 0 -1"},     {I, {0, 1, 0}, 0.5, "1 0 0", "-1 0 0"},
                                    {I, {0, 1, 0}, -0.5, "-1 0 0", "1 0 0"},  {I, {1, 0, 0}, 0.5, "0 -1 0", "0 1 0"},
                                    {I, {1, 0, 0}, -0.5, "0 1 0", "0 -1 0"},  {I, {0, 0, 1}, 0.5, "0 0 1", "0 0 -1"},
                                    {L, {0, 0, 1}, 0, "0 0 1", "-1 0 0"},     {R, {0, 0, 1}, 0, "0 0 1", "1 0 0"},
                                    {L, {0, 1, 0}, 0.5, "1 0 0", "0 0 1"},    {R, {0, 1, 0}, 0.5, "1 0 0", "0 0 -1"},
                                    {L, {0, 1, 0}, 1, "0 0 -1", "1 0 0"},     {R, {0, 1, 0}, 1, "0 0 -1", "-1 0 0"},
                                    {L, {0, 1, 0}, -0.5, "-1 0 0", "0 0 -1"}, {R, {0, 1, 0}, -0.5, "-1 0 0", "0 0 1"},
                                    {L, {0, 0, 1}, -0.5, "0 0 1", "0 1 0"},   {R, {0, 0, 1}, -0.5, "0 0 1", "0 -1 0"},
                                    {L, {0, 0, 1}, 0.5, "0 0 1", "0 -1 0"},   {L, {0, 0, 1}, 1, "0 0 1", "1 0 0"},
                                    {R, {1, 0, 0}, 0.5, "0 -1 0", "1 0 0"},   {L, {1, 0, 0}, -0.5, "0 1 0", "-1 0 0"}};
    for (const Row& row : table) {
        const std::vector<Place> open = openings(cell_of(row.type, row.axis, row.angle));
        CAPTURE(static_cast<int>(row.type), row.axis.transpose(), row.angle);
        REQUIRE(open.size() == (row.exit.empty() ? 1 : 2));
        CHECK(text(open[0]) == row.entry);
        if (!row.exit.empty()) CHECK(text(open[1]) == row.exit);
    }
}

TEST_CASE("A turn can be turned in 24 ways, all different, and each to a neighbour at a right angle", "[tunnel]") {
    std::set<std::string> ways;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const int ones = std::abs(x) + std::abs(y) + std::abs(z);
                const std::vector<std::string> angles = ones == 1   ? std::vector<std::string>{"0", "0.5", "1"}
                                                        : ones == 2 ? std::vector<std::string>{"1"}
                                                                    : std::vector<std::string>{"0.66666667"};
                for (const std::string& angle : angles) {
                    if (ones == 0) continue;
                    const std::string axis = text(Place(x, y, z));
                    // Nothing leads to this cell, but it is read before that is seen.
                    CAPTURE(axis, angle);
                    CHECK(complaint_about(first + "L (0 5 0)(" + axis + ") " + angle + " END END" + last) ==
                          "t.txt:2:1: this cell is not on the way from the first cell to the end of the tunnel");
                    const std::vector<Place> open = openings(cell_of(CellType::left, Vec3(x, y, z), std::stod(angle)));
                    CHECK(open[0].dot(open[1]) == 0);
                    ways.insert(text(open[0]) + ", " + text(open[1]));
                }
            }
    CHECK(ways.size() == 24);
}
