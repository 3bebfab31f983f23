// kolize massprops on surfaces that are not quite solids, and on what is no surface at all.
#include "cli/massprops_runs.h"
#include "framework/pieces.h"

using namespace kolize;
using namespace kolize::test;
using nlohmann::json;

namespace {

TriangleSoup cube() { return box_soup(Vec3(1, 1, 1)); }

// The same triangles, each with three vertices of its own.
TriangleSoup torn(const TriangleSoup& soup) {
    TriangleSoup pieces;
    for (const Triangle& t : soup.triangles) {
        const auto first = static_cast<std::uint32_t>(pieces.vertices.size());
        for (const std::uint32_t v : t) pieces.vertices.push_back(soup.vertices[v]);
        pieces.triangles.push_back({first, first + 1, first + 2});
    }
    return pieces;
}

bool has_remark(const json& result, const std::string& part) {
    for (const json& remark : result["remarks"])
        if (remark.get<std::string>().find(part) != std::string::npos) return true;
    return false;
}

// Exit code 2, one line on stderr that names the program and what is wrong, and nothing on stdout.
void check_refused(const Shell& shell, const std::string& arguments, const std::string& beginning) {
    const Outcome outcome = shell.kolize("massprops " + arguments);
    CAPTURE(arguments, outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("kolize: " + beginning));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK(outcome.err.ends_with("\n"));
}

}  // namespace

TEST_CASE("An open surface gets estimates that include the truth, and a warning", "[cli][massprops]") {
    const Shell shell;
    TriangleSoup open = cube();
    open.triangles.pop_back();
    shell.folder.write("open.obj", as_obj(open));
    const Outcome outcome = shell.kolize("massprops open.obj --json -");
    REQUIRE(outcome.code == 0);
    CHECK(outcome.err == "kolize: open.obj does not bound a volume; the values are estimates\n");
    const json result = json::parse(outcome.out);
    CHECK(result["closed"] == false);
    CHECK(result["method"] == "winding number");
    CHECK_FALSE(result.contains("exact"));
    CHECK(has_remark(result, "3 edges have one triangle only"));

    const json& estimate = result["winding_number"];
    const double volume = estimate["volume"], range = estimate["uncertainty"]["volume"];
    CHECK(std::abs(volume - 8) <= range);
    CHECK(range < 4);
    const Vec3 center = vector_of(estimate["center_of_mass"]);
    CHECK((center.cwiseAbs().array() <= vector_of(estimate["uncertainty"]["center_of_mass"]).array()).all());
    CHECK(std::abs(result["voxel"]["volume"].get<double>() - 8) <=
          result["voxel"]["volume_uncertainty"].get<double>() + 1e-9);
    CHECK(result["odd_rays"] > 0);
    CHECK(result["voxel"]["first_odd_rays"][0]["crossings"] == 1);

    const Outcome text = shell.kolize("massprops open.obj");
    CHECK(text.code == 0);
    CHECK(text.out.find("not closed") != std::string::npos);
    CHECK(text.out.find("+-") != std::string::npos);
    check_refused(shell, "open.obj --method exact", "open.obj: exact integrals need a surface that bounds a volume");
    CHECK(shell.kolize("massprops open.obj --method exact").err.find("edge ") != std::string::npos);
}

TEST_CASE("A surface that is inside out is turned, with a remark", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("inverted.obj", as_obj(inside_out(cube())));
    const json result = measured(shell, "inverted.obj -10");
    CHECK(result["closed"] == true);
    CHECK(result["volume"].get<double>() == Approx(8));
    CHECK(result["exact"]["volume"].get<double>() == Approx(8));
    CHECK(has_remark(result, "its triangles face inward: all are turned"));
}

TEST_CASE("Of several parts those are turned that are inside out, and cavities are left", "[cli][massprops]") {
    const Shell shell;
    const TriangleSoup beside = box_between(Vec3(5, 0, 0), Vec3(6, 1, 1));
    const TriangleSoup within = box_between(Vec3::Constant(-0.5), Vec3::Constant(0.5));
    shell.folder.write("mixed.obj", as_obj(both(cube(), inside_out(beside))));
    shell.folder.write("cavity.obj", as_obj(both(cube(), inside_out(within))));
    shell.folder.write("nested.obj", as_obj(both(cube(), within)));
    const json mixed = measured(shell, "mixed.obj"), cavity = measured(shell, "cavity.obj");
    const json nested = measured(shell, "nested.obj");
    for (const json& result : {mixed, cavity, nested}) CHECK(result["parts"] == 2);
    CHECK(mixed["volume"].get<double>() == Approx(9));
    CHECK(has_remark(mixed, "1 part of 2 faced inward without being a cavity: turned"));
    CHECK(cavity["volume"].get<double>() == Approx(7));
    CHECK(cavity["remarks"].empty());
    CHECK(nested["volume"].get<double>() == Approx(9));
    CHECK(has_remark(nested, "1 part of 2 lie within others without being a cavity: what is inside both counts twice"));
    CHECK(has_remark(nested, "is enclosed more than once, and counts so"));
}

TEST_CASE("Triangles that do not share their vertices are joined, with a remark", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("torn.obj", as_obj(torn(cube())));
    const json result = measured(shell, "torn.obj");
    CHECK(result["closed"] == true);
    CHECK(result["method"] == "exact");
    CHECK(result["volume"].get<double>() == Approx(8));
    CHECK(has_remark(result, "closed once vertices at the same place are joined (28 fewer)"));
}

TEST_CASE("Cubes that overlap get a remark, and voxels tell by how much", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("two.obj", as_obj(both(cube(), box_between(Vec3(0.5, -0.5, 0), Vec3(2.5, 1.5, 2)))));
    const json result = measured(shell, "two.obj 0.25");
    CHECK(result["closed"] == true);
    CHECK(result["self_intersections"] > 0);
    CHECK(has_remark(result, "the surface passes through itself"));
    CHECK(result["exact"]["volume"].get<double>() == Approx(16));
    for (const json& pass : result["voxel"]["passes"]) {
        CHECK(pass["covered_twice"].get<double>() == Approx(0.5 * 1.5 * 1));
        CHECK(pass["inside_out"] == 0);
    }
    CHECK(measured(shell, "two.obj")["volume"].get<double>() == Approx(16));
}

TEST_CASE("A triangle flipped or there twice is reported, and no exact number given", "[cli][massprops]") {
    const Shell shell;
    TriangleSoup flipped = cube(), doubled = cube();
    std::swap(flipped.triangles[4][0], flipped.triangles[4][1]);
    doubled.triangles.push_back(doubled.triangles[4]);
    shell.folder.write("flipped.obj", as_obj(flipped));
    shell.folder.write("doubled.obj", as_obj(doubled));
    const json turned = measured(shell, "flipped.obj"), twice = measured(shell, "doubled.obj");
    CHECK(has_remark(turned, "3 edges join triangles of opposite orientation"));
    CHECK(has_remark(twice, "1 triangle repeats another one"));
    for (const json& result : {turned, twice}) {
        CHECK(result["closed"] == false);
        CHECK_FALSE(result.contains("exact"));
    }
}

TEST_CASE("What cannot be read or has no volume is refused in a sentence that says where", "[cli][massprops]") {
    const Shell shell;
    const ScratchFolder& folder = shell.folder;
    std::filesystem::create_directory(folder.path() / "models");
    folder.write("empty.obj", "");
    const std::string stl = as_binary_stl(cube());
    folder.write("cut.stl", stl.substr(0, stl.size() - 30));
    folder.write("junk.wrl", std::string("\x01\x02\x00\xff\xfe junk \x7f\x00\x80", 14));
    folder.write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n");
    folder.write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n");
    folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    check_refused(shell, "no.obj", "no.obj: there is no such file");
    check_refused(shell, "models", "models: this is a folder");
    check_refused(shell, "empty.obj", "empty.obj: the file is empty");
    check_refused(shell, "cut.stl", "cut.stl:");
    check_refused(shell, "junk.wrl", "junk.wrl:");
    check_refused(shell, "index.obj", "index.obj:4:");
    check_refused(shell, "nan.obj", "nan.obj:2:");
    check_refused(shell, "flat.obj", "flat.obj: the surface is closed but encloses no volume");
    check_refused(shell, "points.obj", "points.obj: there are no triangles in the file");
}

TEST_CASE("massprops refuses options that make no sense", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("cube.obj", as_obj(cube()));
    check_refused(shell, "cube.obj 0", "the step must be a length (> 0) or minus a number of divisions, not 0");
    check_refused(shell, "cube.obj nan", "the step must be a length (> 0) or minus a number of divisions, not nan");
    check_refused(shell, "cube.obj -2.5", "a negative step is a number of divisions and must be whole, not 2.5");
    check_refused(shell, "cube.obj 1e-9", "a step of 1e-09 cuts a side of 2 into 2e+09 cells");
    check_refused(shell, "cube.obj -10 --grid-shift 0.5", "the grid shift is a part of the spacing");
    for (const char* arguments :
         {"-10 4", "-10 0", "ten", "--method guess", "--rays none", "-10 --count all", "--scale 0", "--scale -1",
          "--format xml", "--format urdf --mass 0", "--format urdf --mass 1 --density 1", "--threads 0", "--study"})
        check_refused(shell, std::string("cube.obj ") + arguments, "");
    check_refused(shell, "cube.obj --plot a.svg", "--plot shows a --study");
    check_refused(shell, "cube.obj --format urdf --mass 1 --json -", "--format urdf and --json - both want stdout");
    const Outcome unknown = shell.kolize("massprops cube.obj --output cube.xyz");
    CHECK(unknown.code == 2);
    CHECK(unknown.err.starts_with("kolize: cube.xyz: a mesh is written to a file that ends in"));
    CHECK_FALSE(std::filesystem::exists(shell.folder.path() / "cube.xyz"));
}
