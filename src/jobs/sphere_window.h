// The part of a photograph that a sphere fills.
#pragma once

#include <filesystem>

#include "calibration/sphere/sphere_outline.h"

namespace livery {

/// The part of a photograph that the sphere fills, with a margin, and how the camera sees it.
struct SphereWindow {
    PictureWindow pixels;
    View view;
};

/// Pixels are averaged in blocks where the sphere is more than `most_across_px` wide. Throws
/// FileError that names `manifest` for a sphere that the camera does not see, or of less than 40
/// pixels.
SphereWindow window_around(const View& camera,
                           const Sphere& sphere,
                           double most_across_px,
                           const std::filesystem::path& manifest);

}  // namespace livery
