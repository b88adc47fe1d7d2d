#include "gl/program.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include <epoxy/gl.h>

#include "core/error.h"
#include "core/mutation.h"
#include "core/paths.h"
#include "gl/timer.h"

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

namespace gl_detail {
void delete_program(unsigned name) { glDeleteProgram(name); }
void delete_shader(unsigned name) { glDeleteShader(name); }
}  // namespace gl_detail

namespace {

using Shader = GlName<gl_detail::delete_shader>;

/// Line numbers in a compiler's log: Mesa and Intel "0:12(5):", NVIDIA "0(12) :", Apple "0:12:".
std::set<int> lines_in_log(const std::string& log) {
    std::set<int> lines;
    std::istringstream stream(log);
    std::string line;
    while (std::getline(stream, line)) {
        const std::size_t zero =
            line.find("0:") != std::string::npos ? line.find("0:") : line.find("0(");
        if (zero != std::string::npos) {
            const int number = std::atoi(line.c_str() + zero + 2);
            if (number > 0) lines.insert(number);
        }
    }
    return lines;
}

std::string numbered_lines(const std::string& text, const std::set<int>& named) {
    std::string out;
    std::istringstream stream(text);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        const auto next = named.lower_bound(number - 1);
        if (next != named.end() && *next <= number + 1) {
            out += (named.contains(number) ? "> " : "  ") + std::to_string(number) + " | " + line +
                   "\n";
        }
    }
    return out;
}

Shader compile(GLenum stage, const ShaderSource& source) {
    Shader shader(glCreateShader(stage));
#if defined(LIVERY_MUTATIONS)
    const std::string mutated = mutated_glsl(source.text);
    const char* text = mutated.c_str();
#else
    const char* text = source.text.c_str();
#endif
    glShaderSource(shader.get(), 1, &text, nullptr);
    glCompileShader(shader.get());
    gl_detail::counted().shader_bytes += source.text.size();
    GLint ok = GL_FALSE;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &ok);
    if (ok != GL_TRUE) {
        GLint length = 0;
        glGetShaderiv(shader.get(), GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
        glGetShaderInfoLog(shader.get(), length, nullptr, log.data());
        log = log.c_str();
        throw std::runtime_error("shader " + source.name + " does not compile:\n" + log + "\n" +
                                 numbered_lines(source.text, lines_in_log(log)));
    }
    return shader;
}

}  // namespace

Program::Program(const ShaderSource& vertex, const ShaderSource& fragment) {
    const Shader a = compile(GL_VERTEX_SHADER, vertex);
    const Shader b = compile(GL_FRAGMENT_SHADER, fragment);
    link({a.get(), b.get()}, vertex.name + " + " + fragment.name);
}

Program::Program(const ShaderSource& compute) {
    const Shader shader = compile(GL_COMPUTE_SHADER, compute);
    link({shader.get()}, compute.name);
}

Program Program::screen_pass(const ShaderSource& fragment) {
    return Program(screen_triangle_shader(), fragment);
}

void Program::link(const std::vector<unsigned>& shaders, const std::string& what) {
    name_ = GlName<gl_detail::delete_program>(glCreateProgram());
    for (const unsigned shader : shaders) glAttachShader(name_.get(), shader);
    glLinkProgram(name_.get());
    ++gl_detail::counted().programs;
    for (const unsigned shader : shaders) glDetachShader(name_.get(), shader);
    GLint ok = GL_FALSE;
    glGetProgramiv(name_.get(), GL_LINK_STATUS, &ok);
    if (ok != GL_TRUE) {
        GLint length = 0;
        glGetProgramiv(name_.get(), GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
        glGetProgramInfoLog(name_.get(), length, nullptr, log.data());
        throw std::runtime_error("program " + what + " does not link:\n" + log.c_str());
    }
    throw_on_gl_error("linking " + what);
}

void Program::use() const { glUseProgram(name_.get()); }

int Program::location(std::string_view uniform) {
    const auto found = locations_.find(std::string(uniform));
    if (found != locations_.end()) return found->second;
    const int where = glGetUniformLocation(name_.get(), std::string(uniform).c_str());
    locations_.emplace(uniform, where);
    return where;
}

bool Program::set(std::string_view uniform, int value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniform1i(name_.get(), where, value);
    return where >= 0;
}

bool Program::set(std::string_view uniform, unsigned value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniform1ui(name_.get(), where, value);
    return where >= 0;
}

bool Program::set(std::string_view uniform, float value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniform1f(name_.get(), where, value);
    return where >= 0;
}

bool Program::set(std::string_view uniform, const glm::vec2& value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniform2fv(name_.get(), where, 1, &value.x);
    return where >= 0;
}

bool Program::set(std::string_view uniform, const glm::vec3& value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniform3fv(name_.get(), where, 1, &value.x);
    return where >= 0;
}

bool Program::set(std::string_view uniform, const glm::vec4& value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniform4fv(name_.get(), where, 1, &value.x);
    return where >= 0;
}

bool Program::set(std::string_view uniform, const glm::ivec2& value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniform2iv(name_.get(), where, 1, &value.x);
    return where >= 0;
}

bool Program::set(std::string_view uniform, const glm::uvec2& value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniform2uiv(name_.get(), where, 1, &value.x);
    return where >= 0;
}

bool Program::set(std::string_view uniform, const glm::mat3& value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniformMatrix3fv(name_.get(), where, 1, GL_FALSE, &value[0].x);
    return where >= 0;
}

bool Program::set(std::string_view uniform, const glm::mat4& value) {
    const int where = location(uniform);
    if (where >= 0) glProgramUniformMatrix4fv(name_.get(), where, 1, GL_FALSE, &value[0].x);
    return where >= 0;
}

bool Program::set(std::string_view uniform, std::span<const int> array) {
    const int where = location(uniform);
    if (where >= 0) {
        glProgramUniform1iv(name_.get(), where, static_cast<GLsizei>(array.size()), array.data());
    }
    return where >= 0;
}

bool Program::set(std::string_view uniform, std::span<const float> array) {
    const int where = location(uniform);
    if (where >= 0) {
        glProgramUniform1fv(name_.get(), where, static_cast<GLsizei>(array.size()), array.data());
    }
    return where >= 0;
}

bool Program::set(std::string_view uniform, std::span<const glm::vec3> array) {
    const int where = location(uniform);
    if (where >= 0 && !array.empty()) {
        glProgramUniform3fv(name_.get(), where, static_cast<GLsizei>(array.size()), &array[0].x);
    }
    return where >= 0;
}

bool Program::set(std::string_view uniform, std::span<const glm::vec4> array) {
    const int where = location(uniform);
    if (where >= 0 && !array.empty()) {
        glProgramUniform4fv(name_.get(), where, static_cast<GLsizei>(array.size()), &array[0].x);
    }
    return where >= 0;
}

void dispatch(const Program& compute, unsigned groups_x, unsigned groups_y, unsigned groups_z) {
    compute.use();
    ++gl_detail::counted().dispatches;
    glDispatchCompute(groups_x, groups_y, groups_z);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    check_gl("running a compute program");
}

namespace {

std::string first_word(const std::string& line, std::string* rest) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos) return {};
    const std::size_t end = line.find_first_of(" \t", begin);
    if (end == std::string::npos) return line.substr(begin);
    *rest = line.substr(end);
    return line.substr(begin, end - begin);
}

void expand(const std::filesystem::path& relative, std::set<std::string>* seen, std::string* out) {
    if (!seen->insert(relative.lexically_normal().generic_string()).second) return;
    const std::filesystem::path file = shipped_path("shaders" / relative);
    std::istringstream lines(read_text_file(file));
    std::string line, rest;
    while (std::getline(lines, line)) {
        if (first_word(line, &rest) != "#include") {
            *out += line + "\n";
            continue;
        }
        const std::size_t open = rest.find('"');
        const std::size_t close = rest.rfind('"');
        if (open == std::string::npos || close <= open) {
            throw FileError(file, "#include", rest, "a file in double quotes");
        }
        expand(rest.substr(open + 1, close - open - 1), seen, out);
    }
}

}  // namespace

ShaderSource load_shader(const std::filesystem::path& file,
                         const std::vector<std::string>& defines) {
    std::set<std::string> seen;
    std::string text;
    expand(file, &seen, &text);
    const std::size_t version = text.find("#version");
    if (version == std::string::npos) {
        throw FileError(shipped_path("shaders" / file), "#version", "none", "#version 450 core");
    }
    std::string block;
    for (const std::string& define : defines) block += "#define " + define + "\n";
    text.insert(text.find('\n', version) + 1, block);
    return {file.generic_string(), text};
}

ShaderSource screen_triangle_shader() {
    return {"screen triangle", R"(#version 450 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)"};
}

}  // namespace livery
