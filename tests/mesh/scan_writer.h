// Scans in memory, written as PLY and OBJ, to be read back and to be broken.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "mesh/mesh.h"

namespace livery {

struct ScanWriter {
    std::vector<glm::vec3> positions, normals;  ///< no normals, or as many as positions
    std::vector<std::vector<int>> faces;        ///< corners count from 0
    std::string face_element = "face";
    std::string vertex_properties = "property float x\nproperty float y\nproperty float z\n";
    std::string face_properties = "property list uchar int vertex_indices\n";

    std::string header(const char* format) const {
        return fmt::format(
            "ply\nformat {} 1.0\nelement vertex {}\n{}{}element {} {}\n{}end_header\n",
            format,
            positions.size(),
            vertex_properties,
            normals.empty() ? "" : "property float nx\nproperty float ny\nproperty float nz\n",
            face_element,
            faces.size(),
            face_properties);
    }
    std::string ascii_ply() const {
        std::string text = header("ascii");
        for (std::size_t k = 0; k < positions.size(); ++k) {
            text += fmt::format("{} {} {}", positions[k].x, positions[k].y, positions[k].z);
            if (!normals.empty()) {
                text += fmt::format(" {} {} {}", normals[k].x, normals[k].y, normals[k].z);
            }
            text += "\n";
        }
        for (const auto& face : faces) {
            text += std::to_string(face.size());
            for (const int corner : face) text += " " + std::to_string(corner);
            text += "\n";
        }
        return text;
    }
    std::string binary_ply(std::endian order) const {
        const bool little = order == std::endian::little;
        std::string bytes = header(little ? "binary_little_endian" : "binary_big_endian");
        const auto put = [&](auto value) {
            std::array<char, sizeof value> raw;
            std::memcpy(raw.data(), &value, sizeof value);
            if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
            bytes.append(raw.data(), raw.size());
        };
        for (std::size_t k = 0; k < positions.size(); ++k) {
            for (int axis = 0; axis < 3; ++axis) put(positions[k][axis]);
            for (int axis = 0; axis < 3 && !normals.empty(); ++axis) put(normals[k][axis]);
        }
        for (const auto& face : faces) {
            put(static_cast<std::uint8_t>(face.size()));
            for (const int corner : face) put(static_cast<std::int32_t>(corner));
        }
        return bytes;
    }
    std::string obj() const {
        std::string text;
        for (const auto& p : positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
        for (const auto& n : normals) text += fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
        for (const auto& face : faces) {
            text += "f";
            for (const int corner : face) {
                text += fmt::format(" {}", corner + 1);
                if (!normals.empty()) text += fmt::format("//{}", corner + 1);
            }
            text += "\n";
        }
        return text;
    }
};

/// A closed sphere of radius 100 about the origin, whose points are shared, with normals.
inline ScanWriter sphere_scan(int rings) {
    const Mesh sphere = make_sphere({0, 0, 0}, 100.0, rings, "ball");
    ScanWriter scan;
    scan.positions = sphere.positions_mm;
    scan.normals = sphere.normals;
    for (const auto& t : sphere.triangles) {
        scan.faces.push_back({static_cast<int>(t.x), static_cast<int>(t.y), static_cast<int>(t.z)});
    }
    return scan;
}

/// A box of quads from -half to half.
inline ScanWriter box_scan(const glm::vec3& half) {
    ScanWriter scan;
    for (int k = 0; k < 8; ++k) {
        scan.positions.emplace_back((k & 1 ? 1.0f : -1.0f) * half.x,
                                    (k & 2 ? 1.0f : -1.0f) * half.y,
                                    (k & 4 ? 1.0f : -1.0f) * half.z);
    }
    scan.faces = {
        {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    return scan;
}

}  // namespace livery
