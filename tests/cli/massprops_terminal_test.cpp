// kolize massprops at a terminal: a pseudo terminal, as a user's window is one.
#include "cli/massprops_runs.h"

#include <pty.h>
#include <unistd.h>

using namespace kolize::test;

namespace {

constexpr char end_of_input = '\x04';  // what Ctrl-D sends
constexpr unsigned longest = 60;       // s; a program that waits for more than it gets is ended

std::string read_until_closed(int terminal) {
    std::string text;
    char buffer[4096];
    for (ssize_t count; (count = read(terminal, buffer, sizeof buffer)) > 0;)
        text.append(buffer, static_cast<std::size_t>(count));
    return text;
}

// What the program prints and what is typed, which a terminal echoes, are one text.
Outcome at_terminal(const Shell& shell, const std::vector<std::string>& arguments, const std::string& typed) {
    const std::string program = KOLIZE_BINARY_DIR "/bin/kolize", folder = shell.folder.path().string();
    std::vector<const char*> words{program.c_str(), "massprops"};
    for (const std::string& argument : arguments) words.push_back(argument.c_str());
    words.push_back(nullptr);
    int terminal = -1;
    const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
    REQUIRE(child >= 0);
    if (child == 0) {
        alarm(longest);
        if (chdir(folder.c_str()) == 0) execv(program.c_str(), const_cast<char* const*>(words.data()));
        _exit(127);
    }
    const std::string input = typed + end_of_input;
    CHECK(write(terminal, input.data(), input.size()) == static_cast<ssize_t>(input.size()));
    Outcome outcome;
    outcome.out = read_until_closed(terminal);
    int status = 0;
    waitpid(child, &status, 0);
    close(terminal);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

}  // namespace

TEST_CASE("Without a model massprops asks for file, step and axes, and again for what it cannot use",
          "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("corner.obj", as_obj(corner_solid()));
    const Outcome outcome = at_terminal(shell, {}, "no.obj\ncorner.obj\nten\n0\n-20\n4\nx\n2\n");
    INFO(outcome.out);
    CHECK(outcome.code == 0);
    CHECK(times(outcome.out, "Model (OBJ, OFF, PLY, STL or WRL file):") == 2);
    CHECK(times(outcome.out, "Step (") == 3);
    CHECK(times(outcome.out, "Axes along which rays go") == 3);
    CHECK(times(outcome.out, "'no.obj' is not a file") == 1);
    CHECK(times(outcome.out, "'ten' is not a number other than 0") == 1);
    CHECK(times(outcome.out, "1, 2 or 3 is wanted") == 2);
    CHECK(outcome.out.find("corner.obj: 4 vertices, 4 triangles, closed") != std::string::npos);
    CHECK(outcome.out.find("by voxel") != std::string::npos);
    CHECK(times(outcome.out, "rays along") == 1);
    CHECK(outcome.out.find("7 x 14 x 20 cells") != std::string::npos);
}

TEST_CASE("An empty step means exact integrals, and then nothing is asked about axes", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("corner.obj", as_obj(corner_solid()));
    const Outcome outcome = at_terminal(shell, {}, "corner.obj\n\n");
    INFO(outcome.out);
    CHECK(outcome.code == 0);
    CHECK(outcome.out.find("by exact") != std::string::npos);
    CHECK(outcome.out.find("Axes along") == std::string::npos);
}

TEST_CASE("massprops says so when the input ends before all is answered", "[cli][massprops]") {
    const Shell shell;
    const Outcome outcome = at_terminal(shell, {}, "");
    INFO(outcome.out);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.find("kolize: the input ended before all was answered") != std::string::npos);
}

TEST_CASE("With a model massprops never asks, and without a terminal neither", "[cli][massprops]") {
    const Shell shell;
    shell.folder.write("corner.obj", as_obj(corner_solid()));
    const Outcome outcome = at_terminal(shell, {"corner.obj"}, "");
    INFO(outcome.out);
    CHECK(outcome.code == 0);
    CHECK(outcome.out.find("by exact") != std::string::npos);
    CHECK(outcome.out.find("Model (") == std::string::npos);

    const Outcome piped = shell.kolize("massprops </dev/null");
    CHECK(piped.code == 2);
    CHECK(piped.out.empty());
    CHECK(piped.err == "kolize: massprops needs a model: kolize massprops MODEL [STEP [AXES]]\n");
}
