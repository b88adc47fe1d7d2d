// Linked GLSL programs and their uniforms, and errors that OpenGL keeps to itself until asked.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "gl/handles.h"

namespace livery {

/// Turns the check after every draw, bind and update on or off for this thread (tests: on;
/// a running show: off, since asking stalls a hardware driver). Creation is always checked.
void set_gl_checks(bool on);
bool gl_checks();

/// Throws std::runtime_error that names `what` and every pending error ("GL_INVALID_VALUE").
void throw_on_gl_error(std::string_view what);

/// The same where checks are on.
void check_gl(std::string_view what);

/// GLSL and the name by which errors call it.
struct ShaderSource {
    std::string name;
    std::string text;
};

/// shaders/<file> with every `#include "bsdf/ggx.glsl"` line replaced by that file (relative to
/// shaders/, each file once), and `#define` lines ("LOBES 3") put in after #version. Throws
/// FileError on a missing file or one without #version.
ShaderSource load_shader(const std::filesystem::path& file,
                         const std::vector<std::string>& defines = {});

/// Covers the viewport with one triangle from gl_VertexID alone; no vertex inputs.
ShaderSource screen_triangle_shader();

namespace gl_detail {
void delete_program(unsigned name);
}

/// Uniforms are the program's state: use one from one thread only.
class Program {
  public:
    Program() = default;
    /// Throws std::runtime_error with the compiler's log and the numbered source lines it names.
    Program(const ShaderSource& vertex, const ShaderSource& fragment);
    explicit Program(const ShaderSource& compute);
    /// A pass over every pixel: the vertex stage is screen_triangle_shader().
    static Program screen_pass(const ShaderSource& fragment);

    void use() const;

    /// False where the program has no such uniform (the compiler removes what is not read).
    bool set(std::string_view uniform, int value);
    bool set(std::string_view uniform, unsigned value);
    bool set(std::string_view uniform, float value);
    bool set(std::string_view uniform, const glm::vec2& value);
    bool set(std::string_view uniform, const glm::vec3& value);
    bool set(std::string_view uniform, const glm::vec4& value);
    bool set(std::string_view uniform, const glm::ivec2& value);
    bool set(std::string_view uniform, const glm::uvec2& value);
    bool set(std::string_view uniform, const glm::mat3& value);
    bool set(std::string_view uniform, const glm::mat4& value);
    bool set(std::string_view uniform, std::span<const int> array);
    bool set(std::string_view uniform, std::span<const float> array);
    bool set(std::string_view uniform, std::span<const glm::vec3> array);
    bool set(std::string_view uniform, std::span<const glm::vec4> array);

    unsigned name() const { return name_.get(); }
    explicit operator bool() const { return name_.get() != 0u; }

  private:
    void link(const std::vector<unsigned>& shaders, const std::string& what);
    int location(std::string_view uniform);

    GlName<gl_detail::delete_program> name_;
    std::unordered_map<std::string, int> locations_;
};

/// Runs a compute program over groups and waits for what it wrote to be visible to later passes.
void dispatch(const Program& compute, unsigned groups_x, unsigned groups_y, unsigned groups_z = 1);

}  // namespace livery
