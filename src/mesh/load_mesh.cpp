// load_mesh: which reader a mesh file is for.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "core/error.h"
#include "core/paths.h"
#include "mesh/gltf/gltf_file.h"
#include "mesh/mesh.h"
#include "mesh/scan_file.h"

namespace livery {

namespace {

constexpr std::size_t kMaxFileBytes = 1u << 30u;
/// From here on reading may take more than a gigabyte, which the notes say.
constexpr std::size_t kLargeFileBytes = 1u << 28u;

std::string suffix_of(const std::filesystem::path& file) {
    std::string suffix = file.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return suffix;
}

bool is_ply(std::string_view bytes) {
    return bytes.starts_with("ply\n") || bytes.starts_with("ply\r") || bytes.starts_with("ply ");
}

/// glTF states its unit: metres. Whoever asks for another says that the file is wrong.
void change_unit(Mesh& mesh, LengthUnit unit, std::vector<std::string>& notes) {
    if (unit == LengthUnit::m) return;
    const double factor = mm_per(unit) / mm_per(LengthUnit::m);
    for (auto& position : mesh.positions_mm) {
        position = glm::vec3(factor * glm::dvec3(position));
    }
    notes.push_back(
        fmt::format("its numbers are taken as {}, as asked; glTF says m", to_string(unit)));
}

}  // namespace

Mesh read_mesh(const std::string& bytes,
               const std::filesystem::path& file,
               std::vector<std::string>* notes_or_null,
               std::optional<LengthUnit> unit) {
    std::vector<std::string> notes;
    Mesh mesh;
    const std::string suffix = suffix_of(file);
    if (bytes.empty()) throw FileError(file, "", "an empty file", "a mesh: glTF, PLY or OBJ");
    if (is_ply(bytes) || suffix == ".ply") {
        if (!is_ply(bytes))
            throw FileError(file, "header", "no \"ply\" at the start", "a PLY file");
        ScanFile scan = read_ply(bytes, file);
        mesh = mesh_of(scan, file, unit);
        notes = std::move(scan.notes);
    } else if (suffix == ".obj") {
        ScanFile scan = read_obj(bytes, file);
        mesh = mesh_of(scan, file, unit);
        notes = std::move(scan.notes);
    } else {
        mesh = read_gltf(bytes, file, notes);
        if (unit) change_unit(mesh, *unit, notes);
    }
    if (notes_or_null) {
        notes_or_null->insert(notes_or_null->end(), notes.begin(), notes.end());
    }
    return mesh;
}

Mesh load_mesh(const std::filesystem::path& file,
               std::vector<std::string>* notes,
               std::optional<LengthUnit> unit) {
    const std::string bytes = read_text_file(file, kMaxFileBytes);
    if (notes && bytes.size() > kLargeFileBytes) {
        notes->push_back(fmt::format("{} MB: to read it takes several times as much memory",
                                     bytes.size() >> 20u));
    }
    return read_mesh(bytes, file, notes, unit);
}

}  // namespace livery
