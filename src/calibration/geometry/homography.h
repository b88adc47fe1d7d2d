// Planes seen in pictures, and corners of a board carried from the camera's picture to where the
// projector lights them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "core/image.h"

namespace livery {

/// to ~ H (from, 1) for four points or more, by the normalised direct linear transformation
/// (Hartley and Zisserman 2004, 4.4).
glm::dmat3 homography_of(std::span<const glm::dvec2> from, std::span<const glm::dvec2> to);

inline glm::dvec2 mapped(const glm::dmat3& homography, glm::dvec2 from) {
    const glm::dvec3 to = homography * glm::dvec3(from, 1.0);
    return glm::dvec2(to) / to.z;
}

/// For each corner (camera pixels, centres at halves) the projector pixel (centres at halves) that
/// a homography around it gives: fitted robustly to what `projector_px` (CameraToProjector: 2
/// channels, NaN where not decoded) holds within `radius_px`. Nothing where fewer than a quarter of
/// the pixels around are decoded and agree with it (half of them lie on dark squares). (D. Moreno,
/// G. Taubin: Simple, accurate, and robust projector-camera calibration, 3DIMPVT 2012.)
std::vector<std::optional<glm::dvec2>> carry_corners(const ImageF& projector_px,
                                                     std::span<const glm::dvec2> corners_px,
                                                     double radius_px);

}  // namespace livery
