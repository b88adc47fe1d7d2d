// A box as a file's mesh.
#pragma once

#include <bit>

#include "mesh/scan_writer.h"

namespace livery {

/// A box of these sides about `middle`, in a file's numbers.
inline Mesh box(const glm::vec3& sides, const glm::vec3& middle = {}) {
    ScanWriter scan = box_scan(0.5f * sides);
    for (glm::vec3& position : scan.positions) position += middle;
    return read_mesh(
        scan.binary_ply(std::endian::little), "/no folder/box.ply", nullptr, LengthUnit::mm);
}

}  // namespace livery
