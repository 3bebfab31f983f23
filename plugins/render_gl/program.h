// A linked pair of shaders.
#pragma once

#include <epoxy/gl.h>

#include <string>

namespace kolize::gl {

class Program {
public:
    // Throws std::runtime_error with the compiler's log.
    Program(const std::string& vertex, const std::string& fragment);
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    void use() const { glUseProgram(name_); }
    GLint uniform(const char* name) const { return glGetUniformLocation(name_, name); }
    // Binds the uniform block of this name to a binding point.
    void bind_block(const char* name, GLuint point) const;

private:
    GLuint name_;
};

}  // namespace kolize::gl
