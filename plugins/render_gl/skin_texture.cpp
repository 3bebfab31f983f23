#include "skin_texture.h"

#include <algorithm>
#include <stdexcept>

namespace kolize::gl {
namespace {

void require_size(const Image& image) {
    GLint longest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &longest);
    if (image.width < 1 || image.height < 1 || image.width > longest || image.height > longest)
        throw std::runtime_error("this OpenGL takes textures of 1 to " + std::to_string(longest) +
                                 " pixels a side; one is of " + std::to_string(image.width) + "x" +
                                 std::to_string(image.height));
}

}  // namespace

SkinTexture::SkinTexture(const Image& image, double repeats) : repeats_(static_cast<float>(std::min(repeats, 1e12))) {
    require_size(image);
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 image.pixels.data());
    glGenerateMipmap(GL_TEXTURE_2D);
    for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, direction, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

}  // namespace kolize::gl
