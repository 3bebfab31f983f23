// kolize run --frames and --video as a user meets them.
#include "cli/shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>

using namespace kolize::test;
using nlohmann::json;

namespace {

// A missile that meets a wall after half a second, in steps of a tenth.
const std::string flight = R"([step]
dt = 0.1
time = 1
[[shape]]
name = "ball"
kind = "sphere"
radius = 0.5
[[body]]
name = "missile"
shape = "ball"
kind = "missile"
mass = 1
velocity = [4, 0, 0]
[[room]]
min = [-2.5, -2.5, -2.5]
max = [2.5, 2.5, 2.5]
[[response]]
plugin = "explode"
when = { kind = "missile" }
)";

std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files[entry.path().filename().string()] = file_bytes(entry.path());
    return files;
}

std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes.at(at + i));
    return number;
}

// The header of a PNG file, bytes 12 to 28, and the checksum of it that follows (ISO 15948, annex D).
void set_width(std::string& png, std::uint32_t width) {
    const auto store = [&](std::size_t at, std::uint32_t number) {
        for (std::size_t i = 0; i < 4; ++i) png.at(at + i) = static_cast<char>(number >> (24 - 8 * i));
    };
    store(16, width);
    std::uint32_t sum = ~0u;
    for (std::size_t i = 12; i < 29; ++i) {
        sum ^= static_cast<unsigned char>(png[i]);
        for (int bit = 0; bit < 8; ++bit) sum = sum & 1 ? 0xedb88320u ^ sum >> 1 : sum >> 1;
    }
    store(29, ~sum);
}

// Sets a variable of the environment as long as it lives.
class Variable {
public:
    Variable(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old;
        setenv(name, value, 1);
    }
    ~Variable() { old_.empty() ? unsetenv(name_) : setenv(name_, old_.c_str(), 1); }

private:
    const char* name_;
    std::string old_;
};

}  // namespace

TEST_CASE("run --frames draws the state of the last step at each picture's time, the same bytes every time",
          "[render][cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", flight);
    const std::string options = "run scene.toml --time 0.4 --fps 20 --size 160x90 ";
    const Outcome first = shell.kolize(options + "--frames a");
    INFO(first.err);
    REQUIRE(first.code == 0);
    REQUIRE(shell.kolize(options + "--frames deep/b").code == 0);
    const auto frames = files_in(shell.folder.path() / "a");
    CHECK(frames == files_in(shell.folder.path() / "deep/b"));

    REQUIRE(frames.size() == 9);  // at 0, 0.05, ... 0.4 s
    const std::string& png = frames.at("frame_000000.png");
    CHECK(png.substr(1, 3) == "PNG");
    CHECK(big_endian(png, 16) == 160);
    CHECK(big_endian(png, 20) == 90);
    const auto frame = [&](int i) { return frames.at("frame_00000" + std::to_string(i) + ".png"); };
    for (int i = 0; i < 8; ++i) {
        CAPTURE(i);
        CHECK((frame(i) == frame(i + 1)) == (i % 2 == 0));  // two pictures a step
    }
}

TEST_CASE("A run ends in the same state with pictures and without", "[render][cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", flight);
    REQUIRE(shell.kolize("run scene.toml --json plain.json").code == 0);
    REQUIRE(shell.kolize("run scene.toml --json drawn.json --frames f --size 64x48 --fps 7").code == 0);
    const auto hash = [&](const char* name) {
        return json::parse(file_bytes(shell.folder.path() / name))["state_hash"];
    };
    CHECK(hash("plain.json") == hash("drawn.json"));
}

TEST_CASE("A missile is seen to fly, to explode and to be gone", "[render][cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", flight + "[render]\nexplosion_fps = 200\n");  // 0.16 s
    REQUIRE(shell.kolize("run scene.toml --frames f --size 96x64 --fps 10").code == 0);
    const auto frames = files_in(shell.folder.path() / "f");
    REQUIRE(frames.size() == 11);
    const auto frame = [&](int i) {
        return frames.at((i < 10 ? "frame_00000" : "frame_0000") + std::to_string(i) + ".png");
    };
    CHECK(frame(3) != frame(4));
    CHECK(frame(6) != frame(7));
    CHECK(frame(8) == frame(9));  // an empty room
    CHECK(frame(9) == frame(10));
    CHECK(frame(9) != frame(0));
}

TEST_CASE("Without pictures OpenGL is not even loaded", "[render][cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", flight);
    // The loader of programs writes which libraries it opened into loaded.PROCESS.
    const Variable tell("LD_DEBUG", "files"), there("LD_DEBUG_OUTPUT", (shell.folder.path() / "loaded").c_str());
    const auto loads_egl = [&](const std::string& options) {
        shell.kolize("run scene.toml " + options);
        bool found = false;
        for (const auto& entry : std::filesystem::directory_iterator(shell.folder.path()))
            if (entry.is_regular_file()) found = found || file_bytes(entry).find("libEGL.so") != std::string::npos;
        return found;
    };
    CHECK_FALSE(loads_egl(""));
    CHECK(loads_egl("--frames f --size 32x32 --fps 1"));
}

TEST_CASE("Pictures that cannot be had are refused in one sentence, and nothing is left", "[render][cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", flight);
    shell.folder.write("broken.toml", "[[body]]\nshape = \"none\"\n");
    shell.folder.write("file", "");
    std::filesystem::create_directory(shell.folder.path() / "full");
    shell.folder.write("full/something", "");
    const std::vector<std::pair<std::string, std::string>> wrong = {
        {"broken.toml --frames f", "there is no shape 'none'"},
        {"scene.toml --frames f --size 640", "--size 640: WIDTHxHEIGHT is wanted"},
        {"scene.toml --frames f --size 640x", "WIDTHxHEIGHT is wanted"},
        {"scene.toml --frames f --size 8x8", "from 16 to 16384"},
        {"scene.toml --frames f --fps 0", "--fps"},
        {"scene.toml --fps 10", "goes with --frames or --video"},
        {"scene.toml --frames f --video v.mp4", "excludes"},
        {"scene.toml --frames full", "not empty"},
        {"scene.toml --frames file", "no folder"},
        {"scene.toml --video film.avi", "must end in .mp4"},
        {"scene.toml --video film.mp4 --size 33x32", "even number"},
        {"scene.toml --frames f --set render.plugin=vulkan", "no render 'vulkan'"},
        {"scene.toml --frames f --set render.sample=1", "did you mean 'samples'?"},
        {"scene.toml --frames f --set render.samples=0", "must be from 1 to 16"}};
    shell.kolize("run scene.toml --frames nothing --size 0x0");  // makes out.txt and err.txt
    const std::size_t before = shell.files();
    for (const auto& [arguments, sentence] : wrong) {
        const Outcome outcome = shell.kolize("run " + arguments);
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find(sentence) != std::string::npos);
        CHECK(outcome.err.starts_with("kolize: "));
        CHECK(shell.files() == before);
    }
}

TEST_CASE("A texture is read from a PNG file beside the scene and seen on the body", "[render][cli]") {
    const Shell shell;
    shell.folder.write("plain.toml", flight);
    shell.folder.write("scene.toml", flight + "[[render.texture]]\nshape = \"ball\"\nfile = \"paint.png\"\n");
    const std::string options = " --time 0.1 --fps 1 --size 96x64 --frames ";
    REQUIRE(shell.kolize("run plain.toml" + options + "plain").code == 0);
    const std::string plain = files_in(shell.folder.path() / "plain").at("frame_000000.png");
    shell.folder.write("paint.png", plain);  // a picture like any other
    const Outcome outcome = shell.kolize("run scene.toml" + options + "painted");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(files_in(shell.folder.path() / "painted").at("frame_000000.png") != plain);

    std::string wide = plain;
    set_width(wide, 20000);
    const std::vector<std::pair<std::string, std::string>> wrong = {
        {"no picture", ""}, {plain.substr(0, plain.size() / 2), ""}, {wide, "it has 20000x64 pixels"}};
    for (const auto& [bytes, reason] : wrong) {
        CAPTURE(reason);
        shell.folder.write("paint.png", bytes);
        const Outcome refused = shell.kolize("run scene.toml" + options + "none");
        CAPTURE(refused.err);
        CHECK(refused.code == 2);
        CHECK(refused.err.find("scene.toml:22:8: cannot read the PNG file 'paint.png': " + reason) !=
              std::string::npos);
        CHECK(lines(refused.err) == 1);
        CHECK_FALSE(std::filesystem::exists(shell.folder.path() / "none"));
    }
}

TEST_CASE("A machine without EGL is told so in one sentence", "[render][cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", flight);
    const Variable no_driver("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent");
    const Outcome outcome = shell.kolize("run scene.toml --frames f");
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("renderer 'gl': no OpenGL without a display on this machine") != std::string::npos);
    CHECK(lines(outcome.err) == 1);
    CHECK_FALSE(std::filesystem::exists(shell.folder.path() / "f"));
}

TEST_CASE("run --video writes a film and nothing beside it", "[render][cli]") {
    const Shell shell;
    shell.folder.write("scene.toml", flight);
    const std::string film = "run scene.toml --video film.mp4 --size 64x48 --fps 10";
    const Outcome outcome = shell.kolize(film);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(file_bytes(shell.folder.path() / "film.mp4").substr(4, 4) == "ftyp");
    CHECK(shell.files() == 4);  // the scene, the film, out.txt and err.txt

    const Outcome nowhere = shell.kolize("run scene.toml --video no/such/folder/film.mp4 --size 64x48");
    CHECK(nowhere.code == 2);
    CHECK(nowhere.err.find("kolize: ffmpeg") == 0);
    CHECK(shell.files() == 4);

    std::filesystem::remove(shell.folder.path() / "film.mp4");
    const Variable no_programs("PATH", "/nonexistent");
    const Outcome without = shell.kolize(film);
    CHECK(without.code == 2);
    CHECK(without.err == "kolize: --video needs the program ffmpeg, which is not installed; --frames does without\n");
    CHECK(shell.files() == 3);
}
