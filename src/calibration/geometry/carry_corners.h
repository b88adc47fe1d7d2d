// Corners of a board in the camera's picture -> where the projector lights them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/image.h"

namespace livery {

/// For each corner (camera pixels, centres at halves) the projector pixel (centres at halves) that
/// a homography around it gives: fitted robustly to what `projector_px` (CameraToProjector: 2
/// channels, NaN where not decoded) holds within `radius_px`. Nothing where fewer than a quarter of
/// the pixels around are decoded and agree with it (half of them lie on dark squares). (D. Moreno,
/// G. Taubin: Simple, accurate, and robust projector-camera calibration, 3DIMPVT 2012.)
std::vector<std::optional<glm::dvec2>> carry_corners(const ImageF& projector_px,
                                                     std::span<const glm::dvec2> corners_px,
                                                     double radius_px);

}  // namespace livery
