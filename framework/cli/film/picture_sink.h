// Where the pictures of a film go.
#pragma once

#include <kolize/renderer.h>

#include <filesystem>
#include <memory>

namespace kolize::cli {

// Errors are kolize::Error. A sink that goes without finish() leaves no half-written file behind.
class PictureSink {
public:
    virtual ~PictureSink() = default;
    virtual void take(const Image& image) = 0;
    virtual void finish() = 0;  // after the last picture
};

// Throws Error; the file is whole or not there.
void write_png(const Image& image, const std::filesystem::path& file);

// frame_000000.png and so on in a folder, which is made with the first picture. Throws Error for a folder that holds
// something already.
std::unique_ptr<PictureSink> make_png_folder(const std::filesystem::path& folder);

// One film (H.264 in MP4), by the program ffmpeg, which is looked for in the PATH. Throws Error where there is none.
std::unique_ptr<PictureSink> make_video(const std::filesystem::path& file, int width, int height, double fps);

}  // namespace kolize::cli
