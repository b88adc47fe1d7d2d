// A calibration whose mock-up was moved by hand where it stood a little off its lines.
#pragma once

#include <filesystem>
#include <string>

#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

/// Writes the calibration in the folder `from` for this view of its projector to the folder `to`,
/// which is replaced whole or not: a version of its own that says by how much it was moved. Colours
/// stay with their projector pixels, the camera with the projector. `mockup`: bounds of its mesh.
/// Returns its id. Throws FileError, std::invalid_argument for another lens or size than the
/// calibration's.
std::string write_nudged(const std::filesystem::path& from,
                         const std::filesystem::path& to,
                         const View& projector,
                         const Bounds& mockup);

}  // namespace livery
