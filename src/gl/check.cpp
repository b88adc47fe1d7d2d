#include "gl/check.h"

#include <stdexcept>
#include <string>

#include <epoxy/gl.h>

namespace livery {
namespace {

thread_local bool checks_on = false;

std::string error_name(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        case GL_CONTEXT_LOST:
            return "GL_CONTEXT_LOST";
        default:
            return "error " + std::to_string(error);
    }
}

}  // namespace

void set_gl_checks(bool on) { checks_on = on; }

bool gl_checks() { return checks_on; }

void throw_on_gl_error(std::string_view what) {
    std::string found;
    // A lost context reports for ever: a bound keeps this finite.
    for (int i = 0; i < 8; ++i) {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR) break;
        found += (found.empty() ? "" : ", ") + error_name(error);
    }
    if (!found.empty()) throw std::runtime_error("OpenGL, " + std::string(what) + ": " + found);
}

void check_gl(std::string_view what) {
    if (checks_on) throw_on_gl_error(what);
}

}  // namespace livery
