// Owners of OpenGL objects. An object is made and destroyed while the context that it belongs to is current.
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace kolize::gl {

// `Calls` has make(GLuint*) and destroy(const GLuint*).
template <class Calls>
class Object {
public:
    Object() { Calls::make(&name_); }
    Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~Object() {
        if (name_) Calls::destroy(&name_);
    }
    GLuint name() const { return name_; }

private:
    GLuint name_ = 0;
};

struct BufferCalls {
    static void make(GLuint* name) { glGenBuffers(1, name); }
    static void destroy(const GLuint* name) { glDeleteBuffers(1, name); }
};
struct VertexArrayCalls {
    static void make(GLuint* name) { glGenVertexArrays(1, name); }
    static void destroy(const GLuint* name) { glDeleteVertexArrays(1, name); }
};
struct TextureCalls {
    static void make(GLuint* name) { glGenTextures(1, name); }
    static void destroy(const GLuint* name) { glDeleteTextures(1, name); }
};
struct RenderbufferCalls {
    static void make(GLuint* name) { glGenRenderbuffers(1, name); }
    static void destroy(const GLuint* name) { glDeleteRenderbuffers(1, name); }
};
struct FramebufferCalls {
    static void make(GLuint* name) { glGenFramebuffers(1, name); }
    static void destroy(const GLuint* name) { glDeleteFramebuffers(1, name); }
};

using Buffer = Object<BufferCalls>;
using VertexArray = Object<VertexArrayCalls>;
using Texture = Object<TextureCalls>;
using Renderbuffer = Object<RenderbufferCalls>;
using Framebuffer = Object<FramebufferCalls>;

}  // namespace kolize::gl
