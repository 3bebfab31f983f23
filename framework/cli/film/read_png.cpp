#include "read_png.h"

#include <kolize/error.h>

#include <png.h>

namespace kolize::cli {
namespace {

constexpr png_uint_32 longest = 16384;         // pixels a side
constexpr png_uint_32 most_pixels = 1u << 26;  // 192 MiB

// A PNG file that is being read.
class PngFile {
public:
    explicit PngFile(const TextureConfig& texture) : texture_(texture) {
        png_.version = PNG_IMAGE_VERSION;
        if (!png_image_begin_read_from_file(&png_, texture.file.c_str())) refuse(png_.message);
    }
    PngFile(const PngFile&) = delete;
    PngFile& operator=(const PngFile&) = delete;
    ~PngFile() { png_image_free(&png_); }

    Image read() {
        // Before memory is asked for: a file of a few bytes may say any size.
        if (png_.width > longest || png_.height > longest || png_.width * png_.height > most_pixels)
            refuse("it has " + std::to_string(png_.width) + "x" + std::to_string(png_.height) +
                   " pixels, and 16384 a side and 67108864 in all are the most");
        png_.format = PNG_FORMAT_RGB;
        Image image{static_cast<int>(png_.width), static_cast<int>(png_.height), {}};
        image.pixels.resize(PNG_IMAGE_SIZE(png_));
        const png_color black = {0, 0, 0};
        if (!png_image_finish_read(&png_, &black, image.pixels.data(), 0, nullptr)) refuse(png_.message);
        return image;
    }

private:
    [[noreturn]] void refuse(const std::string& reason) const {
        throw Error(texture_.where, "cannot read the PNG file '" + texture_.file.string() + "': " + reason);
    }

    const TextureConfig& texture_;
    png_image png_ = {};
};

}  // namespace

std::vector<Skin> read_skins(const Scene& scene) {
    std::vector<Skin> skins;
    for (const TextureConfig& texture : scene.render.textures)
        skins.push_back({texture.shape, PngFile(texture).read(), texture.side});
    return skins;
}

}  // namespace kolize::cli
