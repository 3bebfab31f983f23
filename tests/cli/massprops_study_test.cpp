// kolize massprops --study: how the voxel method converges, in numbers and as a picture.
#include "cli/massprops_runs.h"

using namespace kolize;
using namespace kolize::test;
using nlohmann::json;

namespace {

// Side 2, so that the error of counted cells is (step / 2)^2.
std::string cube() { return as_obj(box_soup(Vec3(1, 1, 1))); }

// Every tag that opens closes, in order, and no text holds a bare '<' or '&'.
bool well_formed(const std::string& xml) {
    std::vector<std::string> open;
    for (std::size_t at = 0; at < xml.size();) {
        if (xml[at] == '&' && !xml.substr(at).starts_with("&amp;") && !xml.substr(at).starts_with("&lt;")) return false;
        if (xml[at++] != '<') continue;
        const std::size_t end = xml.find_first_of("<>", at);
        if (end == std::string::npos || xml[end] == '<') return false;
        const std::string tag = xml.substr(at, end - at), name = tag.substr(0, tag.find_first_of(" /", 1));
        at = end + 1;
        if (std::count(tag.begin(), tag.end(), '"') % 2) return false;
        if (tag.ends_with("/")) continue;
        if (!tag.starts_with("/")) {
            open.push_back(name);
        } else {
            if (open.empty() || "/" + open.back() != tag) return false;
            open.pop_back();
        }
    }
    return open.empty();
}

}  // namespace

TEST_CASE("A study of counted cells in a cube finds second order", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("cube.obj", cube());
    const json study = measured(shell, "cube.obj --study 0.25,0.5,-20,0.05 --count midpoint");
    CHECK(study["reference"] == "exact");
    CHECK(study["tensor_order"].get<double>() == Approx(2).margin(1e-6));
    CHECK(study["volume_order"].is_null());  // cells that fit have the volume exactly
    REQUIRE(study["rows"].size() == 4);
    const std::vector<double> steps{0.5, 0.25, 0.1, 0.05};
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const json& row = study["rows"][i];
        CHECK(row["step"].get<double>() == Approx(steps[i]).epsilon(1e-12));
        CHECK(row["tensor_error"].get<double>() == Approx(steps[i] * steps[i] / 4).epsilon(1e-9));
        CHECK(row["volume"].get<double>() == Approx(8).epsilon(1e-12));
        CHECK(row["odd_rays"] == 0);
        CHECK(row["time_s"].get<double>() > 0);
    }
}

TEST_CASE("A study of the thesis' count finds first order", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("cube.obj", cube());
    const json study = measured(shell, "cube.obj --study -100,-200,-400 --count thesis");
    CHECK(study["tensor_order"].get<double>() == Approx(1).margin(0.01));
    CHECK(study["volume_order"].get<double>() == Approx(1).margin(0.01));
}

TEST_CASE("A study is also a table and a picture", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("a&b.obj", cube());
    const Outcome outcome = shell.kolize("massprops 'a&b.obj' --study 0.5,0.25 --count midpoint --plot errors.svg");
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    CHECK(outcome.out.find("Order of convergence (fit): volume none (errors at rounding), tensor 2\n") !=
          std::string::npos);
    CHECK(outcome.out.find("\nexact ") != std::string::npos);
    const std::string picture = file_bytes(shell.folder.path() / "errors.svg");
    CHECK(picture.starts_with("<svg "));
    CHECK(well_formed(picture));
    CHECK(picture.find("a&amp;b.obj") != std::string::npos);
    CHECK(times(picture, "<polyline") == 2);
    CHECK(times(picture, "nan") + times(picture, "inf") == 0);

    // No error at all: nothing to draw, and still a picture.
    CHECK(shell.kolize("massprops 'a&b.obj' --study 0.5 --plot one.svg").code == 0);
    const std::string empty = file_bytes(shell.folder.path() / "one.svg");
    CHECK(well_formed(empty));
    CHECK(times(empty, "nan") + times(empty, "inf") == 0);
}

TEST_CASE("A study of an open surface is against its finest step", "[cli][massprops]") {
    const Shell shell;
    TriangleSoup open = box_soup(Vec3(1, 1, 1));
    open.triangles.pop_back();
    shell.folder.write("open.obj", as_obj(open));
    const json study = measured(shell, "open.obj --study 0.2,0.1,0.05");
    CHECK(study["reference"] == "finest step");
    CHECK(study["rows"].back()["volume_error"] == 0);
    CHECK(study["rows"][0]["odd_rays"] > 0);
}
