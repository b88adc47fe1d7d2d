// Planes seen in pictures.
#pragma once

#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

namespace livery {

/// to ~ H (from, 1) for four points or more, by the normalised direct linear transformation
/// (Hartley and Zisserman 2004, 4.4).
glm::dmat3 homography_of(std::span<const glm::dvec2> from, std::span<const glm::dvec2> to);

inline glm::dvec2 mapped(const glm::dmat3& homography, glm::dvec2 from) {
    const glm::dvec3 to = homography * glm::dvec3(from, 1.0);
    return glm::dvec2(to) / to.z;
}

}  // namespace livery
