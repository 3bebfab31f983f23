#include "context.h"

#include <epoxy/egl.h>
#include <stdexcept>
#include <string>

namespace kolize::gl {

namespace {

Context* current = nullptr;

}  // namespace

void Context::make_current() {
    if (current && current != this) current->release();
    current = nullptr;
    acquire();
    current = this;
}

void Context::let_go() {
    if (current != this) return;
    release();
    current = nullptr;
}

namespace {

[[noreturn]] void refuse(const char* reason) {
    throw std::runtime_error(std::string("no OpenGL without a display on this machine: ") + reason +
                             " (Debian: packages libegl1 and libegl-mesa0)");
}

EGLDisplay open_display() {
    if (!epoxy_has_egl()) refuse("the EGL library is missing");
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless") ||
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base"))
        refuse("its EGL has no surfaceless platform");
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) refuse("EGL cannot be initialised");
    return display;
}

EGLContext make_context(EGLDisplay display) {
    constexpr EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    eglBindAPI(EGL_OPENGL_API);
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) refuse("EGL gives no context of OpenGL 3.3 core");
    return context;
}

// The EGL display is shared by the whole process and stays open: closing it would end the other contexts too.
class HeadlessContext final : public Context {
public:
    HeadlessContext() : display_(open_display()), context_(make_context(display_)) { make_current(); }
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;
    ~HeadlessContext() override {
        let_go();
        eglDestroyContext(display_, context_);
    }

private:
    void acquire() override {
        if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            refuse("EGL cannot make its context current");
    }
    void release() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

    EGLDisplay display_;
    EGLContext context_;
};

}  // namespace

std::unique_ptr<Context> make_headless_context() { return std::make_unique<HeadlessContext>(); }

}  // namespace kolize::gl
