#include "picture_sink.h"

#include <kolize/error.h>

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace kolize::cli {
namespace {

namespace fs = std::filesystem;

// The program, with its standard input in our hands. A socket, so that its early end is an error and no signal.
class Encoder {
public:
    explicit Encoder(std::vector<std::string> arguments) : log_(std::tmpfile(), &std::fclose) {
        int ends[2];
        if (!log_ || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
            throw Error(std::string("cannot start ffmpeg: ") + std::strerror(errno));
        input_ = ends[0];
        const int failure = spawn(arguments, ends[1]);
        ::close(ends[1]);
        if (failure == 0) return;
        close();
        throw Error(failure == ENOENT
                        ? "--video needs the program ffmpeg, which is not installed; --frames does without"
                        : std::string("cannot start ffmpeg: ") + std::strerror(failure));
    }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    ~Encoder() { close(); }

    void write(const std::vector<std::uint8_t>& bytes) {
        for (std::size_t done = 0; done < bytes.size();) {
            const ssize_t sent = send(input_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
            if (sent < 0 && errno == EINTR) continue;
            if (sent < 0) throw Error("ffmpeg gave up: " + complaint());
            done += static_cast<std::size_t>(sent);
        }
    }

    // Ends its input and waits. Throws Error if it failed.
    void finish() {
        if (close() != 0) throw Error("ffmpeg failed: " + complaint());
    }

private:
    int spawn(std::vector<std::string>& arguments, int its_input) {
        std::vector<char*> words;
        for (std::string& argument : arguments) words.push_back(argument.data());
        words.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, its_input, STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, fileno(log_.get()), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, fileno(log_.get()), STDERR_FILENO);
        const int failure = posix_spawnp(&process_, words[0], &actions, nullptr, words.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (failure != 0) process_ = 0;
        return failure;
    }

    // Its exit status; 0 once it has been waited for.
    int close() {
        int status = 0;
        if (input_ >= 0) ::close(std::exchange(input_, -1));
        if (process_) waitpid(std::exchange(process_, 0), &status, 0);
        return status;
    }

    // The first line that it wrote.
    std::string complaint() {
        close();
        char line[400] = "";
        std::rewind(log_.get());
        if (!std::fgets(line, sizeof line, log_.get())) return "it does not say why";
        line[std::strcspn(line, "\n")] = 0;
        return line;
    }

    std::unique_ptr<std::FILE, int (*)(std::FILE*)> log_;
    int input_ = -1;
    pid_t process_ = 0;
};

std::vector<std::string> arguments(const fs::path& file, int width, int height, double fps) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    return {"ffmpeg",
            "-loglevel",
            "error",
            "-f",
            "rawvideo",
            "-pix_fmt",
            "rgb24",
            "-video_size",
            size,
            "-framerate",
            std::to_string(fps),
            "-i",
            "pipe:0",
            "-c:v",
            "libx264",
            "-pix_fmt",
            "yuv420p",
            "-crf",
            "20",
            "-movflags",
            "+faststart",
            "-y",
            "file:" + file.string()};
}

class Video final : public PictureSink {
public:
    Video(const fs::path& file, int width, int height, double fps)
        : file_(file),
          part_(file.string() + ".part.mp4"),
          encoder_(std::in_place, arguments(part_, width, height, fps)) {}

    // The program ends before its file goes.
    ~Video() override {
        encoder_.reset();
        std::error_code ignored;
        if (!finished_) fs::remove(part_, ignored);
    }

    void take(const Image& image) override { encoder_->write(image.pixels); }

    void finish() override {
        encoder_->finish();
        std::error_code error;
        fs::rename(part_, file_, error);
        if (error) throw Error("cannot write '" + file_.string() + "': " + error.message());
        finished_ = true;
    }

private:
    fs::path file_, part_;
    bool finished_ = false;
    std::optional<Encoder> encoder_;
};

}  // namespace

std::unique_ptr<PictureSink> make_video(const fs::path& file, int width, int height, double fps) {
    if (file.extension() != ".mp4") throw Error("--video " + file.string() + ": the name must end in .mp4");
    if (width % 2 || height % 2)
        throw Error("--size: a video has an even number of pixels a side, is " + std::to_string(width) + "x" +
                    std::to_string(height));
    return std::make_unique<Video>(file, width, height, fps);
}

}  // namespace kolize::cli
