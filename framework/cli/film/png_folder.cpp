#include "picture_sink.h"

#include <kolize/error.h>

#include <png.h>

#include <cstdio>

namespace kolize::cli {
namespace {

namespace fs = std::filesystem;

class PngFolder final : public PictureSink {
public:
    explicit PngFolder(const fs::path& folder) : folder_(folder) {
        std::error_code error;
        if (!fs::exists(folder, error)) return;
        if (!fs::is_directory(folder, error)) throw Error("--frames " + folder.string() + ": this is no folder");
        if (!fs::is_empty(folder, error))
            throw Error("--frames " + folder.string() + ": this folder is not empty; name a new one");
    }

    void take(const Image& image) override {
        const bool made = make_folder();
        char name[32];
        std::snprintf(name, sizeof name, "frame_%06d.png", count_++);
        try {
            write_png(image, folder_ / name);
        } catch (const Error&) {
            std::error_code error;
            if (made) fs::remove(folder_, error);
            throw;
        }
    }

    void finish() override {}

private:
    // Whether it was not there yet.
    bool make_folder() const {
        std::error_code error;
        const bool made = fs::create_directories(folder_, error);
        if (error) throw Error("cannot make the folder '" + folder_.string() + "': " + error.message());
        return made;
    }

    fs::path folder_;
    int count_ = 0;
};

}  // namespace

void write_png(const Image& image, const fs::path& file) {
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    png.flags = PNG_IMAGE_FLAG_FAST;  // a third of the time, files a tenth larger
    const fs::path part = file.string() + ".part";
    const bool written = png_image_write_to_file(&png, part.c_str(), 0, image.pixels.data(), 0, nullptr);
    std::error_code error;
    if (written) fs::rename(part, file, error);
    if (written && !error) return;
    const std::string complaint = written ? error.message() : png.message;
    fs::remove(part, error);
    throw Error("cannot write '" + file.string() + "': " + complaint);
}

std::unique_ptr<PictureSink> make_png_folder(const fs::path& folder) { return std::make_unique<PngFolder>(folder); }

}  // namespace kolize::cli
