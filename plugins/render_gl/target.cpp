#include "target.h"

#include <algorithm>
#include <stdexcept>

namespace kolize::gl {
namespace {

void attach(const Renderbuffer& buffer, GLenum format, int width, int height, int samples, GLenum place) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer.name());
    // One sample is asked for as none: else OpenGL may take more.
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer.name());
}

void require_complete(const std::string& size) {
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("this OpenGL cannot draw on an image of " + size);
}

int limit(GLenum what) {
    GLint value = 0;
    glGetIntegerv(what, &value);
    return value;
}

}  // namespace

Target::Target(int width, int height, int samples) : width_(width), height_(height) {
    const std::string size =
        std::to_string(width) + "x" + std::to_string(height) + " pixels, " + std::to_string(samples) + " samples each";
    const int longest = limit(GL_MAX_RENDERBUFFER_SIZE);
    if (width < 1 || height < 1 || width > longest || height > longest || samples > limit(GL_MAX_SAMPLES))
        throw std::runtime_error("this OpenGL draws on images of 1 to " + std::to_string(longest) +
                                 " pixels a side and at most " + std::to_string(limit(GL_MAX_SAMPLES)) +
                                 " samples a pixel; wanted are " + size);
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    attach(drawn_colour_, GL_SRGB8_ALPHA8, width, height, samples, GL_COLOR_ATTACHMENT0);
    attach(drawn_depth_, GL_DEPTH_COMPONENT24, width, height, samples, GL_DEPTH_ATTACHMENT);
    require_complete(size);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
    attach(resolved_colour_, GL_SRGB8_ALPHA8, width, height, 0, GL_COLOR_ATTACHMENT0);
    require_complete(size);
}

void Target::clear(const float (&colour)[3]) {
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    glViewport(0, 0, width_, height_);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glDepthMask(GL_TRUE);
    glClearColor(colour[0], colour[1], colour[2], 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Target::resolve() {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.name());
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

// The window's bytes are sRGB, too, but OpenGL need not know it: they are copied as they are.
void Target::copy_to_window(int width, int height) {
    resolve();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
}

void Target::read(Image& image) {
    resolve();
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
    const std::size_t row = 3 * static_cast<std::size_t>(width_);
    bottom_up_.resize(row * height_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, bottom_up_.data());
    image.width = width_;
    image.height = height_;
    image.pixels.resize(bottom_up_.size());
    for (int y = 0; y < height_; ++y)
        std::copy_n(bottom_up_.end() - static_cast<std::ptrdiff_t>(row * (y + 1)), row,
                    image.pixels.begin() + static_cast<std::ptrdiff_t>(row * y));
}

}  // namespace kolize::gl
