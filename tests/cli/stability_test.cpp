#include "cli/shell.h"
#include "stability/search.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <map>

using namespace kolize::test;
using namespace kolize::cli::stability;
using nlohmann::json;

namespace {

using Answer = kolize::cli::stability::Outcome;

const Axis six_decades{"axis", "m", "made up", 0, 6, 0};
const Axis downward{"axis", "m", "made up", 0, -300, 0};

Answer bad(Failure failure) { return {failure, "made up"}; }

json survey(const Shell& shell, const std::string& arguments) {
    const auto outcome = shell.kolize("stability " + arguments + " --json -");
    INFO(arguments << ": " << outcome.err);
    REQUIRE(outcome.code == 0);
    return json::parse(outcome.out);
}

// Where the plugin's answers end on the axis, decades; infinity where they hold to the end.
double limit(const json& survey, const std::string& plugin, const std::string& axis) {
    for (const json& row : survey["rows"])
        if (row["plugin"] == plugin && row["axis"] == axis) {
            if (row["holds_to_the_end"]) return kolize::infinity;
            return row["holds_to_decades"].is_null() ? -kolize::infinity : row["holds_to_decades"].get<double>();
        }
    FAIL("no row for " << plugin << ", " << axis);
    return 0;
}

// A folder with one library of the tests' own.
std::string with_liar(const Shell& shell, const std::string& stage) {
    std::filesystem::create_directory(shell.folder.path() / "liars");
    const std::string file = "liar_" + stage + ".so";
    std::filesystem::copy_file(std::filesystem::path(KOLIZE_BAD_PLUGIN_DIR) / file,
                               shell.folder.path() / "liars" / file);
    return "--plugin-path liars --stage " + stage + " --set " + stage + ".plugin=liar";
}

}  // namespace

TEST_CASE("The envelope of an answer that holds everywhere has no end", "[stability]") {
    const Envelope envelope = find_envelope(six_decades, [](double) { return Answer{}; });
    CHECK(envelope.to_the_end());
    CHECK(envelope.holds_to == 6.0);
    CHECK_FALSE(envelope.silent);
}

TEST_CASE("The envelope of an answer that holds nowhere is empty", "[stability]") {
    const Envelope envelope = find_envelope(six_decades, [](double) { return bad(Failure::missed); });
    CHECK_FALSE(envelope.holds_to);
    REQUIRE(envelope.beyond);
    CHECK(envelope.beyond->decades == 0);
    CHECK(envelope.beyond->outcome.failure == Failure::missed);
}

TEST_CASE("The end of an envelope is found to a tenth of a decade, whichever way the axis runs", "[stability]") {
    const double end = GENERATE(0.05, 0.51, 1.0, 2.718, 3.99, 5.93);
    const Envelope up =
        find_envelope(six_decades, [&](double decades) { return decades > end ? bad(Failure::wrong) : Answer{}; });
    CAPTURE(end);
    REQUIRE(up.holds_to);
    CHECK(*up.holds_to <= end);
    CHECK(up.beyond->decades > end);
    CHECK(up.beyond->decades - *up.holds_to <= resolution + 1e-12);
    const Envelope down =
        find_envelope(downward, [&](double decades) { return decades < -50 * end ? bad(Failure::wrong) : Answer{}; });
    REQUIRE(down.holds_to);
    CHECK(*down.holds_to >= -50 * end);
    CHECK(down.beyond->decades < -50 * end);
    CHECK(*down.holds_to - down.beyond->decades <= resolution + 1e-12);
}

TEST_CASE("A failure below others that hold is where the envelope ends", "[stability]") {
    // Fails from 2.3 to 2.8 only, between two of the samples that are taken first; and from 5 on.
    const auto probe = [](double decades) {
        if (decades >= 5) return bad(Failure::missed);
        return decades > 2.3 && decades < 2.8 ? bad(Failure::inaccurate) : Answer{};
    };
    const Envelope envelope = find_envelope(six_decades, probe);
    REQUIRE(envelope.holds_to);
    CHECK(*envelope.holds_to == Approx(2.3).margin(resolution));
    CHECK(envelope.beyond->outcome.failure == Failure::inaccurate);
    REQUIRE(envelope.again);
    CHECK(*envelope.again == Approx(5).margin(resolution));
}

TEST_CASE("A silent failure beyond a refusal is reported beside it", "[stability]") {
    const auto probe = [](double decades) {
        return decades > 4 ? bad(Failure::wrong) : decades > 1 ? bad(Failure::refused) : Answer{};
    };
    const Envelope envelope = find_envelope(six_decades, probe);
    CHECK(envelope.beyond->outcome.failure == Failure::refused);
    REQUIRE(envelope.silent);
    CHECK(envelope.silent->decades > 4);
    CHECK(envelope.silent->outcome.failure == Failure::wrong);
}

TEST_CASE("What a probe throws is a refusal with its message", "[stability]") {
    const Study study{
        "stage", "output",
        "asks",  {six_decades},
        {},      [](const Subject&, const Point&) -> Answer {
                          throw std::invalid_argument("body 3 is too far away"); }};
    const auto outcome = ask(study, Subject("plugin"), study.usual());
    CHECK(outcome.failure == Failure::refused);
    CHECK(outcome.sentence == "body 3 is too far away");
}

TEST_CASE("stability finds that brute force holds everywhere", "[cli][stability]") {
    const Shell shell;
    const json result = survey(shell, "--stage broadphase --plugin brute_force");
    REQUIRE(result["rows"].size() == 4);
    for (const json& row : result["rows"]) CHECK(row["holds_to_the_end"] == true);
}

TEST_CASE("stability finds that triangle tests in float end before those in double", "[cli][stability]") {
    const Shell shell;
    const std::string plugin = GENERATE("moller", "guigue_devillers");
    const json result = survey(shell, "--stage narrowphase --vary narrowphase.plugin=" + plugin +
                                          " --vary narrowphase.precision=float,double --axis graze --axis aspect");
    for (const char* axis : {"graze", "aspect"}) {
        CAPTURE(plugin, axis);
        const double in_float = limit(result, plugin + " precision=float", axis);
        CHECK(std::isfinite(in_float));
        CHECK(std::abs(in_float) < std::abs(limit(result, plugin + " precision=double", axis)));
    }
}

TEST_CASE("stability finds which law a response breaks", "[cli][stability]") {
    const Shell shell;
    const json result = survey(
        shell, with_liar(shell, "response") + " --vary response.lie=none,gain,nan_velocity,throw" + " --axis contacts");
    std::map<std::string, std::string> failures;
    for (const json& row : result["rows"])
        if (row["output"] == "energy") {
            const std::string plugin = row["plugin"];
            failures[plugin] = row["beyond"].is_null() ? "" : row["beyond"]["failure"].get<std::string>();
        }
    CHECK(failures["liar lie=none"] == "");
    CHECK(failures["liar lie=gain"] == "wrong");
    CHECK(failures["liar lie=nan_velocity"] == "not finite");
    CHECK(failures["liar lie=throw"] == "refuses");
}

TEST_CASE("stability finds that energy is kept by pdmv4 and not by momentum_euler", "[cli][stability]") {
    const Shell shell;
    const json result = survey(shell, "--stage integrator --axis spin");
    CHECK(limit(result, "pdmv4", "spin") == kolize::infinity);
    CHECK(limit(result, "momentum_euler", "spin") == -kolize::infinity);
}

TEST_CASE("stability finds no impact missed by a plugin that times them", "[cli][stability]") {
    const Shell shell;
    const json result = survey(shell, "--stage continuous --plugin exact --axis speed --axis graze");
    REQUIRE(result["rows"].size() == 3);
    for (const json& row : result["rows"]) CHECK(row["holds_to_the_end"] == true);
}

TEST_CASE("stability finds that discrete stepping lets fast bodies escape before continuous stepping fails",
          "[cli][stability]") {
    const Shell shell;
    const json result = survey(shell, "--stage pipeline --plugin discrete --plugin continuous --axis speed");
    CHECK(limit(result, "discrete", "speed") < limit(result, "continuous", "speed"));
    CHECK(result["rows"][0]["beyond"]["failure"] == "escaped");
}

TEST_CASE("stability asks whole pipelines, and refuses one that cannot be read", "[cli][stability]") {
    const Shell shell;
    shell.folder.write("fine.toml", "[step]\nmode = \"continuous\"\n");
    shell.folder.write("broken.toml", "[step]\nmoode = \"continuous\"\n");
    const json result = survey(shell, "--stage pipeline --pipeline fine.toml --axis distance");
    REQUIRE(result["rows"].size() == 1);
    CHECK(result["rows"][0]["plugin"] == "fine.toml");
    const auto broken = shell.kolize("stability --stage pipeline --pipeline broken.toml");
    CHECK(broken.code == 2);
    CHECK(broken.err.find("moode") != std::string::npos);
}

TEST_CASE("A map of two axes has an outcome for every cell", "[cli][stability]") {
    const Shell shell;
    const json result = survey(shell, "--stage response --plugin impulse --map mass_ratio,contacts");
    REQUIRE(result["maps"].size() == 3);
    for (const json& map : result["maps"]) {
        CHECK(map["cells"].size() == map["across"]["decades"].size() * map["up"]["decades"].size());
        CHECK(map["across"]["axis"] == "mass_ratio");
    }
    const auto none = shell.kolize("stability --stage response --map mass_ratio,mass_ratio");
    CHECK(none.code == 2);
}

TEST_CASE("stability finds a plugin that answers wrongly", "[cli][stability]") {
    const Shell shell;
    const std::string stage = GENERATE("broadphase", "narrowphase");
    const json result = survey(shell, with_liar(shell, stage));
    REQUIRE(!result["rows"].empty());
    const bool found = std::any_of(result["rows"].begin(), result["rows"].end(),
                                   [](const json& row) { return !row["silent"].is_null(); });
    CHECK(found);
}

TEST_CASE("stability gives the same answer for the same seed", "[cli][stability]") {
    const Shell shell;
    const std::string arguments = "stability --stage narrowphase --plugin guigue_devillers --axis graze --seed 7";
    const auto first = shell.kolize(arguments), second = shell.kolize(arguments);
    CHECK(first.out == second.out);
    CHECK(first.out.find("seed 7") != std::string::npos);
}

TEST_CASE("stability refuses what it cannot ask in one sentence", "[cli][stability]") {
    const Shell shell;
    const auto axis = shell.kolize("stability --axis distanse");
    CHECK(axis.code == 2);
    CHECK(axis.err.find("did you mean 'distance'?") != std::string::npos);
    const auto plugin = shell.kolize("stability --plugin nobody");
    CHECK(plugin.code == 2);
    CHECK(plugin.err.find("'nobody'") != std::string::npos);
    const auto setting = shell.kolize("stability --set narowphase.plugin=exact");
    CHECK(setting.code == 2);
    CHECK(setting.err.find("'narowphase.plugin=exact'") != std::string::npos);
}

TEST_CASE("stability writes its report into a folder", "[cli][stability]") {
    const Shell shell;
    const auto outcome = shell.kolize("stability --stage narrowphase --plugin sat --axis depth --report out");
    REQUIRE(outcome.code == 0);
    for (const char* file : {"stability.txt", "stability.csv", "stability.json"})
        CHECK(std::filesystem::exists(shell.folder.path() / "out" / file));
    const std::string page = file_bytes(shell.folder.path() / "out" / "stability.html");
    CHECK(page.find("<td>sat</td>") != std::string::npos);
    CHECK(page.find("http") == std::string::npos);  // it needs nothing else
}
