#include "part_mesh.h"

#include <array>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

namespace livery::assets {

namespace {

glm::dvec3 any_orthogonal(const glm::dvec3& normal) {
    const glm::dvec3 axis = std::abs(normal.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    return glm::normalize(axis - normal * glm::dot(axis, normal));
}

}  // namespace

std::uint32_t PartMesh::add_vertex(const glm::dvec3& position_mm,
                                   const glm::dvec3& normal,
                                   const glm::dvec2& uv) {
    positions_mm.push_back(position_mm);
    normals.push_back(normal);
    uvs.push_back(uv);
    return static_cast<std::uint32_t>(positions_mm.size() - 1);
}

void PartMesh::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) triangles.emplace_back(a, b, c);
}

void PartMesh::add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const double ac = glm::distance(positions_mm[a], positions_mm[c]);
    const double bd = glm::distance(positions_mm[b], positions_mm[d]);
    // A margin keeps the choice the same on both sides of a symmetric part.
    if (ac <= bd * (1.0 + 1e-6)) {
        add_triangle(a, b, c);
        add_triangle(a, c, d);
    } else {
        add_triangle(a, b, d);
        add_triangle(b, c, d);
    }
}

void append(PartMesh& target, const PartMesh& source, const glm::dvec3& offset_mm) {
    const auto base = static_cast<std::uint32_t>(target.positions_mm.size());
    for (std::size_t k = 0; k < source.positions_mm.size(); ++k) {
        target.add_vertex(source.positions_mm[k] + offset_mm, source.normals[k], source.uvs[k]);
    }
    for (const auto& t : source.triangles) target.triangles.push_back(t + base);
}

void append_mirrored(PartMesh& target, const PartMesh& source) {
    const auto base = static_cast<std::uint32_t>(target.positions_mm.size());
    const glm::dvec3 mirror(1, 1, -1);
    for (std::size_t k = 0; k < source.positions_mm.size(); ++k) {
        target.add_vertex(source.positions_mm[k] * mirror,
                          source.normals[k] * mirror,
                          {source.uvs[k].x, 1.0 - source.uvs[k].y});
    }
    for (const auto& t : source.triangles) {
        target.triangles.emplace_back(base + t.x, base + t.z, base + t.y);
    }
}

void compute_smooth_normals(PartMesh& mesh) {
    constexpr double kPlacesPerMm = 1e6;
    std::map<std::array<long long, 3>, glm::dvec3> at_place;
    const auto place = [&](std::uint32_t vertex) {
        const auto& p = mesh.positions_mm[vertex];
        return std::array<long long, 3>{std::llround(p.x * kPlacesPerMm),
                                        std::llround(p.y * kPlacesPerMm),
                                        std::llround(p.z * kPlacesPerMm)};
    };
    for (const auto& t : mesh.triangles) {
        const auto& a = mesh.positions_mm[t.x];
        const auto n = glm::cross(mesh.positions_mm[t.y] - a, mesh.positions_mm[t.z] - a);
        for (int k = 0; k < 3; ++k) at_place[place(t[k])] += n;
    }
    for (std::uint32_t k = 0; k < mesh.normals.size(); ++k) {
        const auto found = at_place.find(place(k));
        const double length = found == at_place.end() ? 0.0 : glm::length(found->second);
        mesh.normals[k] = length > 0.0 ? found->second / length : glm::dvec3(0, 1, 0);
    }
}

void compute_tangents(PartMesh& mesh) {
    std::vector<glm::dvec3> along_u(mesh.positions_mm.size(), glm::dvec3(0.0));
    std::vector<glm::dvec3> along_v(mesh.positions_mm.size(), glm::dvec3(0.0));
    for (const auto& t : mesh.triangles) {
        const auto e1 = mesh.positions_mm[t.y] - mesh.positions_mm[t.x];
        const auto e2 = mesh.positions_mm[t.z] - mesh.positions_mm[t.x];
        const auto d1 = mesh.uvs[t.y] - mesh.uvs[t.x];
        const auto d2 = mesh.uvs[t.z] - mesh.uvs[t.x];
        const double determinant = d1.x * d2.y - d1.y * d2.x;
        if (std::abs(determinant) < 1e-12) continue;
        const double area = glm::length(glm::cross(e1, e2));
        const auto u = (e1 * d2.y - e2 * d1.y) / determinant;
        const auto v = (e2 * d1.x - e1 * d2.x) / determinant;
        for (int k = 0; k < 3; ++k) {
            along_u[t[k]] += u * area;
            along_v[t[k]] += v * area;
        }
    }
    mesh.tangents.resize(mesh.positions_mm.size());
    for (std::size_t k = 0; k < mesh.tangents.size(); ++k) {
        const auto& n = mesh.normals[k];
        auto tangent = along_u[k] - n * glm::dot(n, along_u[k]);
        const double length = glm::length(tangent);
        tangent = length > 1e-6 * glm::length(along_u[k]) && length > 0.0 ? tangent / length
                                                                          : any_orthogonal(n);
        const double sign = glm::dot(glm::cross(n, tangent), along_v[k]) < 0.0 ? -1.0 : 1.0;
        mesh.tangents[k] = glm::dvec4(tangent, sign);
    }
}

std::vector<PartMesh> mirrored_parts(std::span<const PartStyle> styles,
                                     std::span<const PartMesh> halves) {
    std::vector<PartMesh> parts(styles.size());
    for (std::size_t k = 0; k < parts.size(); ++k) {
        parts[k].name = styles[k].name;
        parts[k].base_colour_rec709 = styles[k].base_colour_rec709;
        parts[k].roughness = styles[k].roughness;
        append(parts[k], halves[k], glm::dvec3(0.0));
        append_mirrored(parts[k], halves[k]);
        compute_tangents(parts[k]);
    }
    return parts;
}

}  // namespace livery::assets
