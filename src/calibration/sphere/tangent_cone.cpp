#include "calibration/sphere/tangent_cone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"

namespace livery {

TangentCone cone_of(const View& view, const Sphere& sphere) {
    const glm::dvec3 to_centre = sphere.centre_mm - centre_in_world(view);
    TangentCone cone;
    cone.distance_mm = glm::length(to_centre);
    check_argument(
        2.0 * cone.distance_mm > sphere.diameter_mm && sphere.diameter_mm > 0.0,
        fmt::format(
            "a sphere of {} mm at {} mm from the camera", sphere.diameter_mm, cone.distance_mm));
    cone.axis = to_centre / cone.distance_mm;
    const glm::dvec3 rows_down = glm::transpose(view.view_from_world.rotation)[1];
    cone.right = glm::normalize(glm::cross(rows_down, cone.axis));
    cone.down = glm::cross(cone.axis, cone.right);
    cone.angle_rad = std::asin(0.5 * sphere.diameter_mm / cone.distance_mm);
    return cone;
}

Sphere sphere_of(const View& view, const TangentCone& cone) {
    return {centre_in_world(view) + cone.distance_mm * cone.axis,
            2.0 * cone.distance_mm * std::sin(cone.angle_rad)};
}

glm::dvec3 around(const TangentCone& cone, double turn_rad) {
    return std::cos(turn_rad) * cone.right + std::sin(turn_rad) * cone.down;
}

ConeEdge edge_of(const TangentCone& cone, const glm::dvec3& direction) {
    const double x = glm::dot(direction, cone.right), y = glm::dot(direction, cone.down);
    const double turn = std::atan2(y, x);
    return {turn < 0.0 ? turn + 2.0 * std::numbers::pi : turn,
            std::atan2(std::hypot(x, y), glm::dot(direction, cone.axis))};
}

double move_cone(std::span<const ConeEdge> edges, double outlier_rad, TangentCone& cone) {
    glm::dvec3 change(0.0);
    double rms = 0.0;
    for (int round = 0; round < 20; ++round) {
        glm::dmat3 normal(0.0);
        glm::dvec3 right(0.0);
        double squares = 0.0, weights = 0.0;
        for (const ConeEdge& edge : edges) {
            const glm::dvec3 row(std::cos(edge.turn_rad), std::sin(edge.turn_rad), 1.0);
            const double off = edge.angle_rad - cone.angle_rad - glm::dot(row, change);
            const double weight = std::min(1.0, outlier_rad / std::max(std::abs(off), 1e-12));
            normal += weight * glm::outerProduct(row, row);
            right += weight * off * row;
            squares += weight * off * off;
            weights += weight;
        }
        if (!(std::abs(glm::determinant(normal)) > 1e-6)) break;
        change += glm::inverse(normal) * right;
        rms = std::sqrt(squares / weights);
    }
    const double distance = cone.distance_mm;
    const double angle = cone.angle_rad + change.z;
    const glm::dvec3 axis =
        glm::normalize(cone.axis + change.x * cone.right + change.y * cone.down);
    const glm::dvec3 rows_right = glm::normalize(cone.right - glm::dot(cone.right, axis) * axis);
    cone = {axis, rows_right, glm::cross(axis, rows_right), distance, angle};
    return rms;
}

}  // namespace livery
