// kolize view in a window, worked by hand.
#include "cli/shell.h"
#include "render/virtual_display.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <thread>

using namespace kolize::test;

namespace {

const std::string crowd = R"([step]
dt = 0.01
[[shape]]
name = "brick"
kind = "box"
half_extents = [0.2, 0.5, 0.9]
[[body]]
shape = "brick"
mass = 1
position = [-1.2, 0, 0]
velocity = [3, 2, 1]
angular_velocity = [1, 2, 3]
[[body]]
shape = "brick"
mass = 1
position = [1.2, 0, 0]
velocity = [-3, 1, 1]
[[room]]
min = [-2, -2, -2]
max = [2, 2, 2]
)";

// The program in its window, until it ends.
class Visit {
public:
    explicit Visit(const std::string& arguments) {
        shell.folder.write("scene.toml", crowd);
        program_ = std::thread([this, arguments] { outcome_ = shell.kolize("view " + arguments); });
        CHECK(virtual_display().hands("search --sync --name 'kolize: scene.toml'"));
        keys("sleep 0.5");  // the first picture
    }
    ~Visit() {
        if (program_.joinable()) end();
    }
    void keys(const std::string& what) {
        CHECK(virtual_display().hands("search --name 'kolize: scene.toml' windowfocus %1 " + what));
    }
    void click(int x, int y) { CHECK(virtual_display().click("kolize: scene.toml", x, y)); }
    // Whether this is told on the terminal within some seconds.
    bool tells(const std::string& words) const {
        for (int i = 0; i < 100; ++i) {
            if (file_bytes(shell.folder.path() / "out.txt").find(words) != std::string::npos) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return false;
    }
    const Outcome& end() {
        keys("key --window %1 Escape");
        return wait();
    }
    const Outcome& wait() {
        program_.join();
        return outcome_;
    }

    Shell shell;

private:
    std::thread program_;
    Outcome outcome_;
};

struct Display {
    Display() { setenv("DISPLAY", virtual_display().name().c_str(), 1); }
};

}  // namespace

TEST_CASE("The panel switches the broadphase while the scene runs, and the recording of it has the same bits",
          "[viewer][window]") {
    const Display display;
    Visit visit("scene.toml --size 900x700 --record hand.rec");
    visit.keys("key --window %1 t sleep 0.3 keydown --window %1 g key --window %1 Down keyup --window %1 g");
    CHECK(visit.tells("drag 0.05 1/s"));
    CHECK(visit.tells("gravity 9.81 m/s^2"));
    visit.click(100, 60);  // the plugins of the broadphase: the first list of the panel
    visit.click(60, 96);   // another one
    CHECK(visit.tells("broadphase.plugin = "));
    visit.keys("sleep 0.5");
    const Outcome outcome = visit.end();
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    CHECK(outcome.out.find("refused") == std::string::npos);

    const std::string recording = file_bytes(visit.shell.folder.path() / "hand.rec");
    CHECK(recording.find(" pipeline 0\n") != std::string::npos);
    CHECK(recording.find(" forces ") != std::string::npos);
    const Outcome replay = visit.shell.kolize("run --replay hand.rec --json r.json");
    CHECK(replay.code == 0);
    CHECK(replay.out.find("replay: the same bits in all") != std::string::npos);
    const auto json = nlohmann::json::parse(file_bytes(visit.shell.folder.path() / "r.json"));
    CHECK(json["pipeline"]["broadphase"]["plugin"] != "grid");
    CHECK(outcome.out.find(json["state_hash"].get<std::string>()) != std::string::npos);
    // With one broadphase all along it comes to the same.
    CHECK(visit.shell.kolize("run --replay hand.rec --set broadphase.plugin=brute_force")
              .out.find("replay: the same bits in all") != std::string::npos);
}

TEST_CASE("view steps, takes a picture, and closes when its time is over", "[viewer][window]") {
    const Display display;
    Visit visit("scene.toml --size 640x480 --paused --steps 3");
    visit.keys("key --window %1 n sleep 0.3 key --window %1 F12");
    CHECK(visit.tells("kolize_1.png"));
    visit.keys("key --window %1 n sleep 0.3 key --window %1 n");
    CHECK(visit.wait().out.find("3 steps, state hash") != std::string::npos);
    const std::string picture = file_bytes(visit.shell.folder.path() / "kolize_1.png");
    CHECK(picture.substr(1, 3) == "PNG");
}

TEST_CASE("view without a display says what to do", "[viewer][window]") {
    const Shell shell;
    shell.folder.write("scene.toml", crowd);
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    const Outcome outcome = shell.kolize("view scene.toml");
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("kolize: renderer 'gl': no window: "));
    CHECK(outcome.err.find("--video") != std::string::npos);
}
