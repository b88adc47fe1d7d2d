// mesh_of: a scan's triangles, welded, turned, and given normals, as the mesh that the rest of the
// program expects.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "mesh/because.h"
#include "mesh/number_table.h"
#include "mesh/scan_file.h"
#include "mesh/surface.h"

namespace livery {

namespace {

/// Where the file has no normals, edges sharper than this stay edges.
constexpr double kCrease_deg = 50.0;
/// A normal this far beyond its triangle's plane (cosine: 105 degrees from the triangle's own)
/// points against the surface; smoothing alone does not do that.
constexpr float kAgainst = -0.25f;
/// How far from 1 the length of a unit normal may be: what six printed digits lose, and more.
constexpr float kUnitTolerance = 0.01f;

using Notes = std::vector<std::string>;

std::vector<glm::vec3> scaled(const ScanFile& scan,
                              const std::filesystem::path& file,
                              double mm_per_unit) {
    std::vector<glm::vec3> positions;
    positions.reserve(scan.positions.size());
    for (const glm::dvec3& position : scan.positions) {
        const glm::dvec3 position_mm = mm_per_unit * position;
        if (!(glm::length(position_mm) < kFarthestMm)) {
            throw FileError(file,
                            fmt::format("vertex {}", positions.size()),
                            fmt::format("a vertex {:g} mm away", glm::length(position_mm)),
                            fmt::format("positions within {:g} mm", kFarthestMm));
        }
        positions.emplace_back(position_mm);
    }
    return positions;
}

double longest_side(const std::vector<glm::dvec3>& positions) {
    glm::dvec3 low(positions.empty() ? glm::dvec3(0.0) : positions[0]), high(low);
    for (const glm::dvec3& position : positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    const glm::dvec3 size = high - low;
    return std::max({size.x, size.y, size.z});
}

/// Keeps the triangles of `scan` for which `keep` says so.
template <typename Keep>
std::size_t drop_triangles(ScanFile& scan, Surface& surface, const Keep& keep) {
    std::size_t kept = 0;
    const std::size_t before = scan.triangles.size();
    for (std::size_t t = 0; t < before; ++t) {
        if (!keep(t)) continue;
        scan.triangles[kept] = scan.triangles[t];
        scan.triangle_part[kept] = scan.triangle_part[t];
        surface.triangles[kept] = surface.triangles[t];
        ++kept;
    }
    scan.triangles.resize(kept);
    scan.triangle_part.resize(kept);
    surface.triangles.resize(kept);
    return before - kept;
}

/// Drops what has no area, and what was there before.
void drop_useless(ScanFile& scan, Surface& surface) {
    const std::size_t flat = drop_triangles(scan, surface, [&](std::size_t t) {
        const glm::uvec3& c = surface.triangles[t];
        return has_area(glm::dvec3(surface.points[c.x]),
                        glm::dvec3(surface.points[c.y]),
                        glm::dvec3(surface.points[c.z]));
    });
    if (flat > 0) {
        scan.notes.push_back(
            fmt::format("{} without area dropped", counted(flat, "triangle", "triangles")));
    }
    // Found before any is dropped: dropping moves them.
    const std::vector<bool> repeats = repeated_triangles(surface);
    const std::size_t repeated =
        drop_triangles(scan, surface, [&](std::size_t t) { return !repeats[t]; });
    if (repeated > 0) {
        scan.notes.push_back(
            fmt::format("{} on top of others dropped", counted(repeated, "triangle", "triangles")));
    }
}

/// Returns which triangles are of open surfaces.
std::vector<bool> turn_right(ScanFile& scan, Surface& surface) {
    // A triangle's normals as the file has them, to tell sides by.
    std::vector<glm::vec3> said(scan.triangles.size(), glm::vec3(0.0f));
    for (std::size_t t = 0; t < said.size(); ++t) {
        for (const ScanCorner& corner : scan.triangles[t]) {
            if (corner.normal == ScanCorner::none) continue;
            const glm::vec3& normal = scan.normals[corner.normal];
            const float length = glm::length(normal);
            if (length > 0.0f && std::isfinite(length)) said[t] += normal / length;
        }
    }
    const Orientation orientation = orient(surface, said);
    for (std::size_t t = 0; t < said.size(); ++t) {
        if (orientation.turned[t]) std::swap(scan.triangles[t][1], scan.triangles[t][2]);
    }
    note_orientation(orientation, scan.notes);
    return orientation.open;
}

/// What became of a normal of the file's at any corner; numbers are bits.
enum Repair : unsigned char { none = 0, empty = 1, not_unit = 2, against = 4 };

using CornerNormalList = std::vector<std::array<glm::vec3, 3>>;

/// The file's normals where they are good, else computed ones.
CornerNormalList corner_normals(ScanFile& scan, const Surface& surface) {
    CornerNormalList normals(scan.triangles.size());
    std::vector<unsigned char> repairs(scan.normals.size(), Repair::none);
    std::size_t missing = 0;
    bool any_bad = false;
    for (std::size_t t = 0; t < normals.size(); ++t) {
        const glm::vec3 flat(glm::normalize(area_vector(surface, t)));
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t at = scan.triangles[t][k].normal;
            glm::vec3& normal = normals[t][k];
            normal = glm::vec3(0.0f);
            if (at == ScanCorner::none) {
                ++missing;
                continue;
            }
            const glm::dvec3 said(scan.normals[at]);
            const double length = glm::length(said);
            if (!(length > 0.0) || !std::isfinite(length)) {
                repairs[at] |= Repair::empty;
                any_bad = true;
                continue;
            }
            if (std::abs(length - 1.0) > static_cast<double>(kUnitTolerance)) {
                repairs[at] |= Repair::not_unit;
            }
            normal = glm::vec3(said / length);
            if (glm::dot(normal, flat) >= kAgainst) continue;
            repairs[at] |= Repair::against;
            any_bad = true;
        }
    }
    if (missing > 0 || any_bad) {
        const CornerNormals computed =
            compute_corner_normals(surface, kCrease_deg * std::numbers::pi / 180.0);
        for (std::size_t t = 0; t < normals.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::vec3& smooth = computed.normal_of_group[computed.group[t][k]];
                glm::vec3& normal = normals[t][k];
                const std::uint32_t at = scan.triangles[t][k].normal;
                if (at == ScanCorner::none || (repairs[at] & Repair::empty) != 0) {
                    normal = smooth;
                } else if ((repairs[at] & Repair::against) != 0) {
                    // Turned round it may well be right: then the whole file has them inside out.
                    normal = glm::dot(-normal, smooth) > 0.5f ? -normal : smooth;
                }
            }
        }
    }
    const auto count_of = [&](Repair repair) {
        return static_cast<std::size_t>(
            std::count_if(repairs.begin(), repairs.end(), [&](unsigned char one) {
                return (one & repair) != 0;
            }));
    };
    const auto note = [&](Repair repair, const char* what) {
        if (const std::size_t count = count_of(repair); count > 0) {
            scan.notes.push_back(fmt::format("{} {}", counted(count, "normal", "normals"), what));
        }
    };
    if (missing > 0) {
        const std::string which =
            missing == 3 * normals.size()
                ? "no normals"
                : counted(missing, "corner without normal", "corners without normals");
        scan.notes.push_back(fmt::format(
            "{}; computed, with edges sharper than {:.0f} degrees kept sharp", which, kCrease_deg));
    }
    note(Repair::empty, "of no length or not a number computed anew");
    note(Repair::not_unit, "not of unit length; made so");
    note(Repair::against, "pointing into the surface turned out of it");
    return normals;
}

/// Vertices that differ in anything stand apart, equal ones once.
Mesh vertices_of(const ScanFile& scan, const Surface& surface, const CornerNormalList& normals) {
    Mesh mesh;
    mesh.triangles.reserve(scan.triangles.size());
    std::vector<std::pair<std::uint32_t, std::uint16_t>> keys;  // point and part
    NumberTable table(3 * scan.triangles.size());
    for (std::size_t t = 0; t < scan.triangles.size(); ++t) {
        glm::uvec3 triangle(0);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t point = surface.triangles[t][static_cast<int>(k)];
            const std::uint16_t part = scan.triangle_part[t];
            const std::uint32_t at = scan.triangles[t][k].uv;
            const glm::vec3& normal = normals[t][k];
            const glm::vec2 uv = at == ScanCorner::none ? glm::vec2(0.0f) : scan.uvs[at];
            // Variants of one point are few, and follow one another.
            const std::uint64_t hash =
                std::uint64_t{point} * 0x9e3779b97f4a7c15ull ^
                std::bit_cast<std::uint32_t>(normal.x) ^
                (std::uint64_t{std::bit_cast<std::uint32_t>(normal.y)} << 7u) ^
                (std::uint64_t{std::bit_cast<std::uint32_t>(uv.x)} << 20u) ^
                (std::uint64_t{std::bit_cast<std::uint32_t>(uv.y)} << 31u);
            const auto next = static_cast<std::uint32_t>(keys.size());
            const std::uint32_t vertex = table.find_or_add(hash, next, [&](std::uint32_t other) {
                return keys[other] == std::pair(point, part) && mesh.normals[other] == normal &&
                       mesh.uvs[other] == uv;
            });
            triangle[static_cast<int>(k)] = vertex;
            if (vertex != next) continue;
            keys.emplace_back(point, part);
            mesh.positions_mm.push_back(surface.points[point]);
            mesh.normals.push_back(normal);
            mesh.uvs.push_back(uv);
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

void repair_uvs(ScanFile& scan) {
    std::size_t repaired = 0;
    for (glm::vec2& uv : scan.uvs) {
        if (std::isfinite(uv.x) && std::isfinite(uv.y)) continue;
        uv = glm::vec2(0.0f);
        ++repaired;
    }
    if (repaired > 0) {
        scan.notes.push_back(
            fmt::format("{} not a number; taken as 0",
                        counted(repaired, "texture coordinate", "texture coordinates")));
    }
}

/// Parts that lost all their triangles go.
void drop_empty_parts(ScanFile& scan) {
    std::vector<std::size_t> sizes(scan.parts.size(), 0);
    for (const std::uint16_t part : scan.triangle_part) ++sizes[part];
    std::vector<std::uint16_t> renamed(scan.parts.size(), 0);
    std::vector<Part> kept;
    for (std::size_t part = 0; part < sizes.size(); ++part) {
        renamed[part] = static_cast<std::uint16_t>(kept.size());
        if (sizes[part] > 0) {
            kept.push_back(scan.parts[part]);
        } else {
            scan.notes.push_back(
                fmt::format("part \"{}\": nothing to show; dropped", scan.parts[part].name));
        }
    }
    for (std::uint16_t& part : scan.triangle_part) part = renamed[part];
    scan.parts = std::move(kept);
}

}  // namespace

bool add_polygon(ScanFile& scan, const std::vector<ScanCorner>& polygon, std::uint16_t part) {
    if (polygon.size() < 3) return true;
    if (polygon.size() == 3) {
        scan.triangles.push_back({polygon[0], polygon[1], polygon[2]});
        scan.triangle_part.push_back(part);
        return true;
    }
    std::vector<glm::dvec3> corners;
    corners.reserve(polygon.size());
    for (const ScanCorner& corner : polygon) corners.push_back(scan.positions[corner.position]);
    for (const glm::uvec3& t : triangulate(corners, scan.cutting_steps)) {
        scan.triangles.push_back({polygon[t.x], polygon[t.y], polygon[t.z]});
        scan.triangle_part.push_back(part);
    }
    return scan.cutting_steps <= kMaxCuttingSteps;
}

void refuse_polygons(const std::filesystem::path& file) {
    throw FileError(file,
                    "faces",
                    "polygons whose many inward corners take too long to cut",
                    "triangles (export them triangulated)");
}

Mesh mesh_of(ScanFile& scan, const std::filesystem::path& file, std::optional<LengthUnit> unit) {
    if (scan.triangles.empty()) {
        if (scan.positions.empty()) {
            throw FileError(file, "", "no triangles" + because(scan.notes), "at least one");
        }
        throw FileError(
            file,
            "",
            fmt::format("a point cloud: {} without faces",
                        counted(scan.positions.size(), "vertex", "vertices")),
            "a surface of triangles (the scanner's program, or MeshLab, makes one of points)");
    }
    if (!unit) {
        const UnitGuess guess = guess_unit(longest_side(scan.positions));
        unit = guess.unit;
        scan.notes.push_back(guess.why);
    }
    Surface surface;
    const auto place = weld(scaled(scan, file, mm_per(*unit)), surface.points);
    surface.triangles.reserve(scan.triangles.size());
    for (const auto& t : scan.triangles) {
        surface.triangles.emplace_back(
            place[t[0].position], place[t[1].position], place[t[2].position]);
    }
    if (const std::size_t welded = place.size() - surface.points.size(); welded > 0) {
        scan.notes.push_back(
            fmt::format("{} welded", counted(welded, "duplicate vertex", "duplicate vertices")));
    }
    drop_useless(scan, surface);
    if (scan.triangles.empty()) {
        throw FileError(
            file, "", "no triangle that has an area" + because(scan.notes), "at least one");
    }
    find_neighbours(surface);
    std::vector<bool> open = turn_right(scan, surface);
    repair_uvs(scan);
    drop_empty_parts(scan);
    Mesh mesh = vertices_of(scan, surface, corner_normals(scan, surface));
    mesh.triangle_part = std::move(scan.triangle_part);
    mesh.parts = std::move(scan.parts);
    mesh.two_sided = std::move(open);
    compute_tangents(mesh);
    return mesh;
}

}  // namespace livery
