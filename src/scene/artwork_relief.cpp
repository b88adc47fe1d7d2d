#include "scene/artwork_relief.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace livery {

ReliefFrame relief_frame(const PartArtwork& relief,
                         const glm::dvec3& normal,
                         const glm::dvec4& tangent) {
    const ArtworkPlane plane = plane_of(relief.artwork.place);
    const bool by_uv = relief.artwork.place.by_uv;
    glm::dvec3 right = by_uv ? glm::dvec3(tangent) : plane.s_axis;
    right -= glm::dot(right, normal) * normal;
    // Where the plane stands on edge its right is the other direction across its up
    if (glm::dot(right, right) < 1e-12) right = glm::cross(plane.t_axis, normal);
    right = glm::normalize(right);
    glm::dvec3 up = glm::cross(normal, right);
    if (by_uv ? tangent.w < 0.0 : glm::dot(up, plane.t_axis) < 0.0) up = -up;
    return {right, up};
}

ReliefTilt tilt_of(const PartArtwork& relief, const glm::dvec4& mean) {
    const double depth = relief.artwork.depth;
    const glm::dvec2 slope(mean);
    return {depth * slope, depth * depth * std::max(mean.z - glm::dot(slope, slope), 0.0)};
}

ReliefTilt tilt_at(const PartArtwork& relief, const ArtworkPoint& point) {
    const glm::dvec2 slope = relief_slope(&point.rgba.x);
    return {relief.artwork.depth * point.cover * slope, 0.0};
}

glm::dvec3 tilted(const glm::dvec3& normal, const ReliefFrame& frame, const glm::dvec2& slope) {
    return glm::normalize(normal + slope.x * frame.right + slope.y * frame.up);
}

}  // namespace livery
