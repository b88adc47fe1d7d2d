#include "gl/context_facts.h"

#include <epoxy/gl.h>

namespace livery {

namespace {

std::string text_of(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text ? text : "not said";
}

std::string number_of(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return std::to_string(value);
}

}  // namespace

std::string context_facts() {
    return "Vendor: " + text_of(GL_VENDOR) + "\nRenderer: " + text_of(GL_RENDERER) +
           "\nVersion: " + text_of(GL_VERSION) +
           "\nShading language: " + text_of(GL_SHADING_LANGUAGE_VERSION) +
           "\nExtensions: " + number_of(GL_NUM_EXTENSIONS) +
           "\nLargest texture: " + number_of(GL_MAX_TEXTURE_SIZE) +
           " pixels a side\nTexture units of a fragment shader: " +
           number_of(GL_MAX_TEXTURE_IMAGE_UNITS) +
           "\nLargest storage block: " + number_of(GL_MAX_SHADER_STORAGE_BLOCK_SIZE) + " bytes\n";
}

}  // namespace livery
