// settle_sides: of triangles as a file has them, one winding for each surface, and its outside out.
#include "mesh/mesh_sides.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "mesh/surface.h"

namespace livery {

namespace {

using Notes = std::vector<std::string>;

template <typename T>
void keep(std::vector<T>& values, const std::vector<bool>& kept) {
    std::size_t next = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (kept[k]) values[next++] = values[k];
    }
    values.resize(next);
}

void keep_triangles(
    Mesh& mesh, Surface& surface, const std::vector<bool>& kept, const char* why, Notes& notes) {
    const std::size_t before = mesh.triangles.size();
    keep(surface.triangles, kept);
    keep(mesh.triangles, kept);
    keep(mesh.triangle_part, kept);
    if (const std::size_t dropped = before - mesh.triangles.size(); dropped > 0) {
        notes.push_back(
            fmt::format("{} {} dropped", counted(dropped, "triangle", "triangles"), why));
    }
}

/// Drops what float coordinates leave no area of, and what was there before.
void drop_useless(Mesh& mesh, Surface& surface, Notes& notes) {
    std::vector<bool> kept;
    for (const glm::uvec3& c : surface.triangles) {
        kept.push_back(has_area(glm::dvec3(surface.points[c.x]),
                                glm::dvec3(surface.points[c.y]),
                                glm::dvec3(surface.points[c.z])));
    }
    keep_triangles(mesh, surface, kept, "without area", notes);
    kept = repeated_triangles(surface);
    kept.flip();
    keep_triangles(mesh, surface, kept, "on top of others", notes);
}

/// Vertices that no triangle is left of go.
void drop_unused_vertices(Mesh& mesh, std::vector<bool>& said) {
    std::vector<bool> used(mesh.positions_mm.size(), false);
    for (const glm::uvec3& t : mesh.triangles) used[t.x] = used[t.y] = used[t.z] = true;
    std::vector<std::uint32_t> renamed(used.size(), 0);
    std::uint32_t next = 0;
    for (std::size_t v = 0; v < used.size(); ++v) {
        if (used[v]) renamed[v] = next++;
    }
    for (glm::uvec3& t : mesh.triangles) t = {renamed[t.x], renamed[t.y], renamed[t.z]};
    keep(mesh.positions_mm, used);
    keep(mesh.normals, used);
    keep(mesh.tangents, used);
    keep(mesh.uvs, used);
    keep(said, used);
}

/// Parts that no triangle is left of go.
void drop_empty_parts(Mesh& mesh, Notes& notes) {
    std::vector<bool> used(mesh.parts.size(), false);
    for (const std::uint16_t part : mesh.triangle_part) used[part] = true;
    std::vector<std::uint16_t> renamed(used.size(), 0);
    std::uint16_t next = 0;
    for (std::size_t part = 0; part < used.size(); ++part) {
        if (used[part]) {
            renamed[part] = next++;
        } else {
            notes.push_back(
                fmt::format("part \"{}\": nothing to show; dropped", mesh.parts[part].name));
        }
    }
    for (std::uint16_t& part : mesh.triangle_part) part = renamed[part];
    keep(mesh.parts, used);
    for (MeshVariant& variant : mesh.variants) {
        std::map<std::size_t, Part> parts;
        for (auto& [index, part] : variant.parts) {
            if (used[index]) parts.emplace(renamed[index], std::move(part));
        }
        variant.parts = std::move(parts);
    }
}

/// Normals of vertices whose triangles face the other way are turned round.
void turn_normals(Mesh& mesh, const Surface& surface, const std::vector<bool>& said, Notes& notes) {
    std::vector<double> agrees(mesh.normals.size(), 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::dvec3 outward = area_vector(surface, t);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[t][k];
            agrees[vertex] += glm::dot(outward, glm::dvec3(mesh.normals[vertex]));
        }
    }
    std::size_t turned = 0;
    for (std::size_t v = 0; v < agrees.size(); ++v) {
        if (!(agrees[v] < 0.0)) continue;
        mesh.normals[v] = -mesh.normals[v];
        mesh.tangents[v].w = -mesh.tangents[v].w;
        if (said[v]) ++turned;
    }
    if (turned > 0) {
        notes.push_back(fmt::format("{} pointing into the surface turned out of it",
                                    counted(turned, "normal", "normals")));
    }
}

}  // namespace

void settle_sides(Mesh& mesh, std::vector<bool> said, Notes& notes) {
    Surface surface;
    const std::vector<std::uint32_t> place = weld(mesh.positions_mm, surface.points);
    surface.triangles.reserve(mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles) {
        surface.triangles.emplace_back(place[t.x], place[t.y], place[t.z]);
    }
    const std::size_t before = mesh.triangles.size();
    drop_useless(mesh, surface, notes);
    if (mesh.triangles.size() < before) {
        drop_unused_vertices(mesh, said);
        drop_empty_parts(mesh, notes);
    }
    find_neighbours(surface);

    std::vector<glm::vec3> normals(mesh.triangles.size(), glm::vec3(0.0f));
    for (std::size_t t = 0; t < normals.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[t][k];
            if (said[vertex]) normals[t] += mesh.normals[vertex];
        }
    }
    Orientation orientation = orient(surface, normals);
    for (std::size_t t = 0; t < normals.size(); ++t) {
        if (orientation.turned[t]) std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    }
    note_orientation(orientation, notes);
    turn_normals(mesh, surface, said, notes);
    mesh.two_sided = std::move(orientation.open);
}

}  // namespace livery
