// A display that nobody sees (Xvfb), and hands that type and click on it (xdotool).
#pragma once

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace kolize::test {

class VirtualDisplay {
public:
    VirtualDisplay() {
        if (std::system("command -v Xvfb xdotool > /dev/null") != 0)
            throw std::runtime_error("windows are tested with Xvfb and xdotool (Debian: packages xvfb and xdotool)");
        int ends[2];
        if (pipe(ends) != 0) throw std::runtime_error("no pipe");
        server_ = fork();
        if (server_ == 0) serve(ends);
        close(ends[1]);
        for (char digit = 0; read(ends[0], &digit, 1) == 1 && digit != '\n';) name_ += digit;
        close(ends[0]);
        if (name_ == ":") throw std::runtime_error("Xvfb does not start");
    }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;
    ~VirtualDisplay() {
        kill(server_, SIGTERM);
        waitpid(server_, nullptr, 0);
    }

    const std::string& name() const { return name_; }  // ":7"
    // Whether xdotool could do it.
    bool hands(const std::string& what) const {
        return std::system(("DISPLAY=" + name_ + " xdotool " + what + " > /dev/null").c_str()) == 0;
    }
    // At a place of the window, pixels from its upper left corner; slowly enough for a window that draws by software.
    bool click(const std::string& window, int x, int y) const {
        return hands("search --name '" + window + "' mousemove --window %1 " + std::to_string(x) + " " +
                     std::to_string(y) + " sleep 0.3 mousedown 1 sleep 0.3 mouseup 1 sleep 0.3");
    }

private:
    // Xvfb chooses a free display and writes its number into the pipe.
    [[noreturn]] static void serve(const int (&ends)[2]) {
        close(ends[0]);
        const std::string number = std::to_string(ends[1]);
        execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1400x900x24", "-nolisten", "tcp",
               static_cast<char*>(nullptr));
        _exit(127);
    }

    pid_t server_ = -1;
    std::string name_ = ":";
};

// One for the whole process, which GLFW stays connected to.
inline const VirtualDisplay& virtual_display() {
    static const VirtualDisplay display;
    return display;
}

}  // namespace kolize::test
