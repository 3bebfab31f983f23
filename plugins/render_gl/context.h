// OpenGL 3.3 core contexts: without a display, and of a window.
#pragma once

#include <memory>

namespace kolize::gl {

// Of one thread. Those of different kinds cannot take each other's place by themselves: the old one is let go first.
class Context {
public:
    virtual ~Context() = default;
    void make_current();

protected:
    // To be called by the destructor, before the context is gone.
    void let_go();

private:
    virtual void acquire() = 0;
    virtual void release() = 0;
};

// EGL on Mesa's surfaceless platform; current when it is made. Throws std::runtime_error with one sentence where this
// machine has no such thing.
std::unique_ptr<Context> make_headless_context();

}  // namespace kolize::gl
