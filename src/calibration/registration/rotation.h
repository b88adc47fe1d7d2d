// Rotations as axis times angle.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace livery {

/// The rotation about an axis by the vector's length, radians (Rodrigues).
inline glm::dmat3 rotation_of(const glm::dvec3& axis_angle) {
    const double angle = glm::length(axis_angle);
    const glm::dmat3 cross(0.0,
                           axis_angle.z,
                           -axis_angle.y,
                           -axis_angle.z,
                           0.0,
                           axis_angle.x,
                           axis_angle.y,
                           -axis_angle.x,
                           0.0);
    const double sine = angle < 1e-8 ? 1.0 : std::sin(angle) / angle;
    const double versine = angle < 1e-8 ? 0.5 : 2.0 * std::pow(std::sin(0.5 * angle) / angle, 2.0);
    return glm::dmat3(1.0) + sine * cross + versine * (cross * cross);
}

/// The axis of a rotation times twice the sine of its angle.
inline glm::dvec3 axis_times_sine(const glm::dmat3& rotation) {
    return {rotation[1][2] - rotation[2][1],
            rotation[2][0] - rotation[0][2],
            rotation[0][1] - rotation[1][0]};
}

/// Angle of a rotation, 0 to pi.
inline double angle_of(const glm::dmat3& rotation) {
    const double twice_sine = glm::length(axis_times_sine(rotation));
    return std::atan2(twice_sine, rotation[0][0] + rotation[1][1] + rotation[2][2] - 1.0);
}

/// Unit axis about which a rotation turns by angle_of(); y where it turns nothing.
inline glm::dvec3 axis_of(const glm::dmat3& rotation) {
    // The columns of R + R^T + (1 - trace R) I are along the axis, also at half a turn.
    const double trace = rotation[0][0] + rotation[1][1] + rotation[2][2];
    const glm::dmat3 along = rotation + glm::transpose(rotation) + (1.0 - trace) * glm::dmat3(1.0);
    int longest = 0;
    for (int k = 1; k < 3; ++k)
        if (glm::length(along[k]) > glm::length(along[longest])) longest = k;
    const double length = glm::length(along[longest]);
    if (length < 1e-12) return {0.0, 1.0, 0.0};
    const double sign = glm::dot(along[longest], axis_times_sine(rotation)) < 0.0 ? -1.0 : 1.0;
    return along[longest] * (sign / length);
}

/// The rotation that takes one unit vector into another the shortest way.
inline glm::dmat3 rotation_between(const glm::dvec3& from, const glm::dvec3& to) {
    const double cosine = std::clamp(glm::dot(from, to), -1.0, 1.0);
    glm::dvec3 axis = glm::cross(from, to);
    if (glm::length(axis) < 1e-9) {
        if (cosine > 0.0) return glm::dmat3(1.0);
        axis = glm::cross(from, std::abs(from.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
    }
    return rotation_of(glm::normalize(axis) * std::acos(cosine));
}

}  // namespace livery
