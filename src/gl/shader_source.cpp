#include "gl/shader_source.h"

#include <set>
#include <sstream>

#include "core/error.h"
#include "core/paths.h"

namespace livery {
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
