// What a scan's file holds, before it is made a mesh: read_ply and read_obj fill it, mesh_of builds
// on it. Internal to mesh/.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "mesh/length_unit.h"
#include "mesh/mesh.h"

namespace livery {

/// Indices into a ScanFile's lists.
struct ScanCorner {
    static constexpr std::uint32_t none = 0xffffffffu;
    std::uint32_t position = none, normal = none, uv = none;
};

struct ScanFile {
    std::vector<glm::dvec3> positions;                 ///< finite, in the file's own unit
    std::vector<glm::vec3> normals;                    ///< as they stand there: of any length, NaN
    std::vector<glm::vec2> uvs;                        ///< v runs down the picture
    std::vector<std::array<ScanCorner, 3>> triangles;  ///< indices in range, but for `none`
    std::vector<std::uint16_t> triangle_part;
    std::vector<Part> parts;
    std::vector<std::string> notes;  ///< what was dropped or not understood
    std::size_t cutting_steps = 0;   ///< that polygons took so far; kMaxCuttingSteps is the end
};

/// Vertices, and corners of faces, that one file may have: about 2 GB while it is read.
inline constexpr std::size_t kMaxScanElements = 1u << 25u;

/// The whole file's bytes as what its kind says. `file` names it in messages, and beside it lie the
/// files that it names. Throw FileError with the line or the element.
ScanFile read_ply(std::string_view bytes, const std::filesystem::path& file);
ScanFile read_obj(std::string_view text, const std::filesystem::path& file);

/// Welds, turns, drops and computes until the mesh is one that Mesh promises; `scan.notes` grows by
/// what was done. Without a unit it is told from the size. Throws FileError.
Mesh mesh_of(ScanFile& scan, const std::filesystem::path& file, std::optional<LengthUnit> unit);

/// Adds a polygon's triangles; nothing of one with fewer than three corners. Past
/// kMaxCuttingSteps it stops: false.
bool add_polygon(ScanFile& scan, const std::vector<ScanCorner>& polygon, std::uint16_t part);
[[noreturn]] void refuse_polygons(const std::filesystem::path& file);

/// Corners above which a polygon is refused by whoever reads it.
inline constexpr std::size_t kMaxPolygonCorners = 4096;
/// Steps, seconds of them, above which a whole file is: cutting ears looks at every corner that
/// turns inward for each that is cut.
inline constexpr std::size_t kMaxCuttingSteps = 2'000'000'000;

/// Cuts a simple polygon, flat or nearly so, concave or convex, into corner count - 2 triangles of
/// indices into it, wound as it is. One that crosses itself gives as many, some of them
/// overlapping. `steps` grows by what it took.
std::vector<glm::uvec3> triangulate(const std::vector<glm::dvec3>& polygon, std::size_t& steps);

}  // namespace livery
