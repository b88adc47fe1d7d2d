#include "mesh/ply_write.h"

#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace livery {

namespace {

static_assert(std::endian::native == std::endian::little, "the file's numbers are little-endian");

template <typename T>
void append_bytes(std::string& bytes, const T& value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

}  // namespace

std::string ply_bytes(const Mesh& mesh) {
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment millimetres\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions_mm.size(),
        mesh.triangles.size());
    bytes.reserve(bytes.size() + 24 * mesh.positions_mm.size() + 13 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.positions_mm.size(); ++i) {
        append_bytes(bytes, mesh.positions_mm[i]);
        append_bytes(bytes, mesh.normals[i]);
    }
    for (const glm::uvec3& triangle : mesh.triangles) {
        append_bytes(bytes, std::uint8_t{3});
        append_bytes(bytes, triangle);
    }
    return bytes;
}

}  // namespace livery
