// GLSL text from the shipped shaders/ folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace livery {

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

}  // namespace livery
