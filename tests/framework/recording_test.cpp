// Recordings: what was put into a run comes out of the file bit for bit.
#include "framework/capsules.h"

#include <kolize/recording.h>

#include <catch2/catch.hpp>

using namespace kolize;
using namespace kolize::test;

namespace {

Recording read(const std::string& text, const SceneOptions& options = {{}, {}, {"grid", "moller", "impulse"}}) {
    const ScratchFolder folder;
    folder.write("run.rec", text);
    return load_recording(folder.path() / "run.rec", options, liars());
}

// Now and then something of every kind is put in.
class Hand {
public:
    explicit Hand(unsigned seed) : random_(seed) {}

    std::optional<Input> before_step(const Simulation& simulation) {
        const std::uint32_t body = dynamic_body(simulation.world());
        switch (std::uniform_int_distribution(0, 40)(random_)) {
        case 0: return ForcesInput{{vector(9), vector(1), std::abs(vector(0.1).x())}};
        case 1: return LoadInput{body, vector(3), vector(1)};
        case 2: return PlaceInput{body, {vector(5), Quat(vector(1).x(), 1, 0.2, 0).normalized(), vector(2), vector(3)}};
        case 3: return RemoveInput{body};
        case 4: {
            PipelineConfig pipeline = simulation.pipeline();
            pipeline.broadphase = stage(simulation.step_number() % 2 ? "bsp" : "brute_force");
            pipeline.step.mode = simulation.step_number() % 3 ? "discrete" : "rollback";
            return PipelineInput{pipeline};
        }
        default: return std::nullopt;
        }
    }

private:
    Vec3 vector(double size) {
        std::uniform_real_distribution<double> number(-size, size);
        const double x = number(random_), y = number(random_);
        return {x, y, number(random_)};
    }
    std::uint32_t dynamic_body(const World& world) {
        std::uint32_t body = 0;
        do body = static_cast<std::uint32_t>(random_() % world.size());
        while (world.is_static[body]);
        return body;
    }
    std::mt19937 random_;
};

Recording recorded(const Scene& scene, int steps, unsigned seed) {
    const auto host = make_host(1);
    Simulation simulation(scene, liars(), *host, 1000);
    Recording recording;
    recording.start = scene;
    recording.start.pipeline = simulation.pipeline();
    Hand hand(seed);
    for (int i = 0; i < steps; ++i) {
        while (const auto input = hand.before_step(simulation)) {
            simulation.apply(*input);
            recording.inputs.push_back({simulation.step_number(), *input});
        }
        simulation.step();
        recording.hashes.push_back(simulation.state_hash());
    }
    return recording;
}

std::vector<std::uint64_t> played(const Recording& recording, int threads) {
    const auto host = make_host(threads);
    Simulation simulation(recording.start, liars(), *host, 1000);
    std::vector<std::uint64_t> hashes;
    auto next = recording.inputs.begin();
    for (std::size_t i = 0; i < recording.hashes.size(); ++i) {
        for (; next != recording.inputs.end() && next->step == simulation.step_number(); ++next)
            simulation.apply(next->input);
        simulation.step();
        hashes.push_back(simulation.state_hash());
    }
    return hashes;
}

// A recording of a single body, small enough to be spoilt by hand.
std::string small_text() {
    Scene scene = empty_scene();
    BodyDescription body;
    give(body, add_shape(scene, make_sphere("ball", 0.5)), Vec3::Zero(), Vec3::UnitX());
    scene.world.add(body);
    Recording recording{scene, {{0, LoadInput{0, Vec3::UnitX(), Vec3::Zero()}}}, {0x0123456789abcdef}};
    return recording_text(recording);
}

std::string refusal(const std::string& from, const std::string& to) {
    std::string text = small_text();
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return "there is no " + from;
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    try {
        read(text.replace(at, from.size(), to));
        return "";
    } catch (const Error& error) {
        const std::string what = error.what(), place = "run.rec:" + std::to_string(line);
        return what.find(place) == std::string::npos ? "not at " + place + ": " + what : what.substr(what.find(": ") + 2);
    }
}

}  // namespace

TEST_CASE("A recording is played to the same bits from its file, for any number of threads", "[framework][record]") {
    const unsigned seed = GENERATE(1u, 2u, 3u);
    CAPTURE(seed);
    const Recording recording = recorded(mixed_crowd(), 200, seed);
    REQUIRE(recording.inputs.size() > 10);
    const std::string text = recording_text(recording);
    const Recording again = read(text);
    CHECK(again.hashes == recording.hashes);
    CHECK(again.inputs.size() == recording.inputs.size());
    CHECK(played(again, 1) == recording.hashes);
    CHECK(played(again, 2) == recording.hashes);
}

TEST_CASE("A recording of a capsule begins at the capsule's step", "[framework][record]") {
    const auto host = make_host(1);
    Simulation simulation(mixed_crowd(), liars(), *host, 100);
    advance(simulation, 25);
    const Recording recording = recorded(simulation.capture(), 60, 4);
    CHECK(recording.inputs.front().step >= 25);
    CHECK(played(read(recording_text(recording)), 1) == recording.hashes);
}

TEST_CASE("A recording keeps how the scene is shown", "[framework][record]") {
    Scene scene = mixed_crowd();
    scene.render.stage.plugin = "gl";
    scene.render.camera = CameraConfig{{1, 2, 3}, {0.1, 0, 0}, Vec3::UnitZ(), 0.75};
    scene.render.lights.push_back({LightKind::spot, {1, 1, 1}, {0, 0, -1}, {1, 0.5, 0.25}, 12, 0.4, {}});
    const Recording recording{scene, {}, {}};
    const RenderConfig render = read(recording_text(recording)).start.render;
    REQUIRE(render.camera);
    CHECK(render.camera->eye == Vec3(1, 2, 3));
    CHECK(render.camera->field_of_view == Approx(0.75).epsilon(1e-14));
    REQUIRE(render.lights.size() == 1);
    CHECK(render.lights[0].kind == LightKind::spot);
    CHECK(render.lights[0].colour == Vec3(1, 0.5, 0.25));
    CHECK(render.lights[0].cone == Approx(0.4).epsilon(1e-14));
}

TEST_CASE("A setting takes the place of what was recorded", "[framework][record]") {
    const SceneOptions options{{}, {{"broadphase.plugin", "bsp"}}, {"grid", "moller", "impulse"}};
    CHECK(read(small_text(), options).start.pipeline.broadphase.plugin == "bsp");
}

TEST_CASE("A recording that is wrong is refused at its line", "[framework][record]") {
    CHECK(refusal("0 load", "0 push") == "forces, load, place, remove or pipeline is wanted where there is 'push'");
    CHECK(refusal("0 load 0", "x load 0") == "the number of a step is wanted where there is 'x'");
    CHECK(refusal("0 load 0", "0 load 4") == "the number of a dynamic body is wanted where there is 4");
    CHECK(refusal("0 load 0 0x1p+0", "0 load 0 nan") ==
          "a finite number such as 0x1.8p+1 is wanted where there is 'nan'");
    CHECK(refusal("0 load 0 0x1p+0", "0 load 0") == "a number such as 0x1.8p+1 is wanted where the line ends");
    CHECK(refusal("0 load 0", "0 pipeline 3\n0 load 0") ==
          "one of the 0 [[recording.pipeline]], counted from 0, is wanted where there is 3");
    CHECK(refusal("0123456789abcdef", "0123456789abcde") ==
          "16 hexadecimal digits are wanted where there is '0123456789abcde'");
    CHECK(refusal("0 load 0", "5 remove 0\n0 load 0").find("a step from 5 is wanted where there is 0") !=
          std::string::npos);
}
