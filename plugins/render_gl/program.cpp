#include "program.h"

#include <stdexcept>

namespace kolize::gl {
namespace {

void attach(GLuint program, GLenum kind, const std::string& source) {
    const GLuint shader = glCreateShader(kind);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);  // lives on as long as the program
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled) return;
    char log[2000] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("this OpenGL refuses a shader: ") + log);
}

void link(GLuint program) {
    glLinkProgram(program);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked) return;
    char log[2000] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("this OpenGL cannot link its shaders: ") + log);
}

}  // namespace

Program::Program(const std::string& vertex, const std::string& fragment) : name_(glCreateProgram()) {
    try {
        attach(name_, GL_VERTEX_SHADER, vertex);
        attach(name_, GL_FRAGMENT_SHADER, fragment);
        link(name_);
    } catch (...) {
        glDeleteProgram(name_);
        throw;
    }
}

Program::~Program() { glDeleteProgram(name_); }

void Program::bind_block(const char* name, GLuint point) const {
    glUniformBlockBinding(name_, glGetUniformBlockIndex(name_, name), point);
}

}  // namespace kolize::gl
