// An OpenGL 3.3 core context that needs no display: EGL on Mesa's surfaceless platform.
#pragma once

#include <epoxy/egl.h>

namespace kolize::gl {

// The EGL display is shared by the whole process and stays open: closing it would end the other contexts too.
class Context {
public:
    // Makes the new context current. Throws std::runtime_error with one sentence where this machine has no such thing.
    Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    ~Context();

    void make_current();

private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace kolize::gl
