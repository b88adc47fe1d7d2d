#include "mesh/mesh.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/paths.h"
#include "mesh/gltf/gltf_file.h"
#include "mesh/scan_file.h"

namespace livery {

namespace {

/// Where +x goes when +y turns the shortest way into the normal.
glm::vec3 level_tangent(const glm::dvec3& n) {
    // Facing down there is no shortest way; close to it rounding decides.
    if (n.y < -0.999999) {
        return glm::vec3(glm::normalize(glm::dvec3(1.0, 0.0, 0.0) - n.x * n));
    }
    const double k = 1.0 / (1.0 + n.y);
    return glm::vec3(glm::normalize(glm::dvec3(1.0 - n.x * n.x * k, -n.x, -n.x * n.z * k)));
}

/// Edges in double: products of float coordinates overflow and cancel too early.
std::pair<glm::dvec3, glm::dvec3> edges_of(const Mesh& mesh, const glm::uvec3& triangle) {
    const glm::dvec3 a(mesh.positions_mm[triangle.x]);
    return {glm::dvec3(mesh.positions_mm[triangle.y]) - a,
            glm::dvec3(mesh.positions_mm[triangle.z]) - a};
}

}  // namespace

Bounds bounds_of(const Mesh& mesh) {
    if (mesh.positions_mm.empty()) return {};
    Bounds bounds{glm::dvec3(mesh.positions_mm.front()), glm::dvec3(mesh.positions_mm.front())};
    for (const auto& position : mesh.positions_mm) {
        bounds.low = glm::min(bounds.low, glm::dvec3(position));
        bounds.high = glm::max(bounds.high, glm::dvec3(position));
    }
    return bounds;
}

void compute_normals(Mesh& mesh) {
    // The cross product of two edges is twice the area times the normal: weights come for free.
    std::vector<glm::dvec3> sums(mesh.positions_mm.size(), glm::dvec3(0.0));
    std::vector<glm::dvec3> last(mesh.positions_mm.size(), glm::dvec3(0.0, 1.0, 0.0));
    for (const auto& triangle : mesh.triangles) {
        const auto [ab, ac] = edges_of(mesh, triangle);
        const glm::dvec3 weighted = glm::cross(ab, ac);
        const double length = glm::length(weighted);
        if (!(length > 0.0)) continue;
        for (int corner = 0; corner < 3; ++corner) {
            sums[triangle[corner]] += weighted;
            last[triangle[corner]] = weighted / length;
        }
    }
    mesh.normals.resize(mesh.positions_mm.size());
    for (std::size_t v = 0; v < sums.size(); ++v) {
        // Two sheets back to back cancel: one of their normals is as good as the other.
        const double length = glm::length(sums[v]);
        mesh.normals[v] = glm::vec3(length > 0.0 ? sums[v] / length : last[v]);
    }
}

void compute_tangents(Mesh& mesh) {
    const std::size_t count = mesh.positions_mm.size();
    check_argument(mesh.normals.size() == count, "compute_tangents: normals are needed first");
    std::vector<glm::dvec3> along_u(count, glm::dvec3(0.0)), along_v(count, glm::dvec3(0.0));
    if (mesh.uvs.size() == count) {
        for (const auto& triangle : mesh.triangles) {
            const auto [ab, ac] = edges_of(mesh, triangle);
            const glm::dvec2 uv(mesh.uvs[triangle.x]);
            const glm::dvec2 uv_ab = glm::dvec2(mesh.uvs[triangle.y]) - uv;
            const glm::dvec2 uv_ac = glm::dvec2(mesh.uvs[triangle.z]) - uv;
            const double area = uv_ab.x * uv_ac.y - uv_ab.y * uv_ac.x;
            if (area == 0.0 || !std::isfinite(area)) continue;

            // Weighted with the area in UV space: only the sign of `area` is left of the division.
            const double sign = area > 0.0 ? 1.0 : -1.0;
            const glm::dvec3 u = sign * (ab * uv_ac.y - ac * uv_ab.y);
            const glm::dvec3 v = sign * (ac * uv_ab.x - ab * uv_ac.x);
            for (int corner = 0; corner < 3; ++corner) {
                along_u[triangle[corner]] += u;
                along_v[triangle[corner]] += v;
            }
        }
    }
    mesh.tangents.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec3 normal(mesh.normals[k]);
        const glm::dvec3 flat = along_u[k] - normal * glm::dot(normal, along_u[k]);
        const double length = glm::length(flat);
        if (!(length > 1e-12 * glm::length(along_u[k]))) {
            mesh.tangents[k] = glm::vec4(level_tangent(normal), 1.0f);
            continue;
        }
        // v runs down the picture and the bitangent up, as in glTF.
        const glm::dvec3 tangent = flat / length;
        const double up = -glm::dot(glm::cross(normal, tangent), along_v[k]);
        mesh.tangents[k] = glm::vec4(glm::vec3(tangent), up < 0.0 ? -1.0f : 1.0f);
    }
}

void append(Mesh& mesh, const Mesh& other, const std::string& prefix) {
    const std::size_t part_count = mesh.parts.size() + other.parts.size();
    const std::size_t vertex_count = mesh.positions_mm.size() + other.positions_mm.size();
    check_argument(part_count <= std::numeric_limits<std::uint16_t>::max(),
                   "append: " + std::to_string(part_count) + " parts, at most 65535 fit");
    check_argument(vertex_count <= std::numeric_limits<std::uint32_t>::max(),
                   "append: " + std::to_string(vertex_count) + " vertices, at most 2^32-1 fit");
    const auto first_vertex = static_cast<std::uint32_t>(mesh.positions_mm.size());
    const auto first_part = mesh.parts.size();

    const auto extend = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    if (!mesh.two_sided.empty() || !other.two_sided.empty()) {
        mesh.two_sided.resize(mesh.triangles.size(), false);
        extend(mesh.two_sided, other.two_sided);
        mesh.two_sided.resize(mesh.triangles.size() + other.triangles.size(), false);
    }
    extend(mesh.positions_mm, other.positions_mm);
    extend(mesh.normals, other.normals);
    extend(mesh.tangents, other.tangents);
    extend(mesh.uvs, other.uvs);
    for (const auto& triangle : other.triangles) mesh.triangles.push_back(triangle + first_vertex);
    for (const auto part : other.triangle_part) {
        mesh.triangle_part.push_back(static_cast<std::uint16_t>(first_part + part));
    }
    for (auto part : other.parts) {
        part.name = prefix + part.name;
        mesh.parts.push_back(std::move(part));
    }
}

Mesh make_sphere(glm::dvec3 centre_mm, double radius_mm, int rings, const std::string& part_name) {
    check_argument(radius_mm > 0.0 && rings >= 2 && rings <= 4096,
                   "make_sphere: radius " + std::to_string(radius_mm) + ", rings " +
                       std::to_string(rings) +
                       "; a positive radius and 2 to 4096 rings are needed");
    constexpr double pi = std::numbers::pi;
    const int segments = 2 * rings;
    Mesh mesh;
    for (int ring = 0; ring <= rings; ++ring) {
        // sin(pi) is not 0 in floating point; the poles must be points.
        const double theta = pi * ring / rings;
        const double sine = ring == 0 || ring == rings ? 0.0 : std::sin(theta);
        for (int segment = 0; segment <= segments; ++segment) {
            const double phi = 2.0 * pi * (segment % segments) / segments;
            const glm::dvec3 outward(sine * std::cos(phi), std::cos(theta), -sine * std::sin(phi));
            mesh.positions_mm.emplace_back(centre_mm + radius_mm * outward);
            mesh.normals.emplace_back(outward);
            mesh.tangents.emplace_back(-std::sin(phi), 0.0, -std::cos(phi), 1.0);
            mesh.uvs.emplace_back(static_cast<double>(segment) / segments,
                                  static_cast<double>(ring) / rings);
        }
    }
    const auto row = static_cast<std::uint32_t>(segments + 1);
    for (std::uint32_t ring = 0; ring < static_cast<std::uint32_t>(rings); ++ring) {
        for (std::uint32_t segment = 0; segment < static_cast<std::uint32_t>(segments); ++segment) {
            const std::uint32_t top = ring * row + segment, below = top + row;
            if (ring + 1 < static_cast<std::uint32_t>(rings)) {
                mesh.triangles.emplace_back(top, below, below + 1);
            }
            if (ring > 0) mesh.triangles.emplace_back(top, below + 1, top + 1);
        }
    }
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    mesh.parts.push_back({part_name, "", glm::dvec3(0.5)});
    return mesh;
}

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
