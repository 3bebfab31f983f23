#include "trial_load.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>

namespace kolize {

namespace {

constexpr unsigned patience = 10;  // s

// Without the file's name, which the loader puts before its reasons.
std::string loader_message(const std::string& file) {
    const std::string message = dlerror();
    const std::string prefix = file + ": ";
    return "cannot be loaded: " + (message.starts_with(prefix) ? message.substr(prefix.size()) : message);
}

// <dlfcn.h> declares dlopen as never throwing, but static constructors do: a call that the compiler cannot see through
// keeps its handlers.
std::string load(const std::string& file) {
    void* (*volatile const open)(const char*, int) = dlopen;
    try {
        return open(file.c_str(), RTLD_NOW | RTLD_LOCAL) ? "" : loader_message(file);
    } catch (const std::exception& failure) {
        return std::string("a static constructor threw: ") + failure.what();
    } catch (...) {
        return "a static constructor threw something that is not a std::exception";
    }
}

void write_all(int pipe, const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t written = write(pipe, text.data() + done, text.size() - done);
        if (written < 0) return;
        done += static_cast<std::size_t>(written);
    }
}

std::string read_all(int pipe) {
    std::string text;
    char buffer[512];
    for (ssize_t got; (got = read(pipe, buffer, sizeof buffer)) > 0 || (got < 0 && errno == EINTR);)
        if (got > 0) text.append(buffer, static_cast<std::size_t>(got));
    return text;
}

// Answers with one byte that says that loading came back, and what load() said. What the library prints is dropped: it
// will print it again when it is loaded in earnest.
[[noreturn]] void answer(const std::string& file, int pipe) {
    alarm(patience);
    if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0) {
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
    }
    write_all(pipe, "." + load(file));
    _exit(0);
}

std::string death(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFSIGNALED(status)) return "ends the process that loads it";
    if (WTERMSIG(status) == SIGALRM) return "takes more than " + std::to_string(patience) + " s to load";
    return std::string("kills the process that loads it: ") + strsignal(WTERMSIG(status));
}

}  // namespace

std::string trial_load_defect(const std::filesystem::path& file) {
    int pipe_ends[2];
    if (pipe2(pipe_ends, O_CLOEXEC) != 0) return std::string("cannot be tried: ") + std::strerror(errno);
    const pid_t child = fork();
    if (child == 0) answer(file.string(), pipe_ends[1]);
    const std::string failure = child < 0 ? std::strerror(errno) : "";
    close(pipe_ends[1]);
    const std::string text = read_all(pipe_ends[0]);
    close(pipe_ends[0]);
    if (child < 0) return "cannot be tried: " + failure;
    const std::string end = death(child);
    return text.empty() ? end : text.substr(1);
}

}  // namespace kolize
