// A program in its window on a display that nobody sees, worked by hand.
#pragma once

#include "cli/shell.h"
#include "render/virtual_display.h"

#include <catch2/catch.hpp>

#include <chrono>
#include <map>
#include <thread>

namespace kolize::test {

// From the first picture until the program ends; it is ended by Escape at the latest.
class Visit {
public:
    // `command` begins with the program's name; the files are in its folder.
    Visit(const std::string& command, const std::string& title, const std::map<std::string, std::string>& files)
        : title_(title) {
        setenv("DISPLAY", virtual_display().name().c_str(), 1);
        for (const auto& [name, text] : files) shell.folder.write(name, text);
        program_ = std::thread([this, command] { outcome_ = shell.run(command); });
        CHECK(virtual_display().hands("search --sync --name '" + title_ + "'"));
        keys("sleep 0.5");
    }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;
    ~Visit() {
        if (program_.joinable()) end();
    }
    void keys(const std::string& what) {
        CHECK(virtual_display().hands("search --name '" + title_ + "' windowfocus %1 " + what));
    }
    void click(int x, int y) { CHECK(virtual_display().click(title_, x, y)); }
    // Whether this is told on the terminal within so many seconds.
    bool tells(const std::string& words, int seconds = 60) const {
        for (int i = 0; i < 10 * seconds; ++i) {
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
    std::string title_;
    std::thread program_;
    Outcome outcome_;
};

}  // namespace kolize::test
