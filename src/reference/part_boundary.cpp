#include "reference/part_boundary.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace livery {

namespace {

/// d normal = result * d position over a triangle.
glm::dmat3 normal_change(const Mesh& mesh, std::uint32_t triangle, double length) {
    const glm::uvec3 c = mesh.triangles[triangle];
    const auto p = [&](unsigned k) { return glm::dvec3(mesh.positions_mm[k]); };
    const auto n = [&](unsigned k) { return glm::dvec3(mesh.normals[k]); };
    const glm::dvec3 e = p(c.y) - p(c.x), f = p(c.z) - p(c.x);
    const double ee = glm::dot(e, e), ef = glm::dot(e, f), ff = glm::dot(f, f);
    const double all = (ee * ff - ef * ef) * length;
    if (!(all > 0.0)) return glm::dmat3(0.0);
    return glm::outerProduct(n(c.y) - n(c.x), (ff * e - ef * f) / all) +
           glm::outerProduct(n(c.z) - n(c.x), (ee * f - ef * e) / all);
}

}  // namespace

std::optional<BoundaryPoint> PartBoundary::first(const glm::dvec3& origin,
                                                 const glm::dvec3& direction,
                                                 double farthest) const {
    // What would scatter on the boundary, to rounding, meets it: floats might take it for outside.
    constexpr double kRounding = 1e-6;
    const double reach =
        std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z), 1.0});
    TraceRay ray;
    ray.origin = glm::vec3(origin);
    ray.direction = glm::vec3(direction);
    ray.t_max = static_cast<float>(std::min(farthest + kRounding * reach, 1e30));
    const Hit hit = tracer_.closest(ray);
    if (!hit.valid()) return std::nullopt;
    const SurfacePoint point = surface_point(mesh_, hit);
    BoundaryPoint at;
    at.position = glm::dvec3(point.position_mm);
    at.geometric_normal = glm::dvec3(point.geometric_normal);
    at.normal = glm::dvec3(point.normal);
    at.distance = static_cast<double>(hit.t);
    at.lets_out =
        point.part == part_ && glm::dot(point.geometric_normal, glm::vec3(direction)) > 0.0f;
    const glm::uvec3 c = mesh_.triangles[hit.triangle];
    const glm::vec2 b = hit.barycentric;
    const glm::vec3 mixed = (1.0f - b.x - b.y) * mesh_.normals[c.x] + b.x * mesh_.normals[c.y] +
                            b.y * mesh_.normals[c.z];
    at.change = normal_change(mesh_, hit.triangle, static_cast<double>(glm::length(mixed)));
    return at;
}

glm::dvec3 PartBoundary::inside_of(const BoundaryPoint& at) const {
    return glm::dvec3(offset_origin(glm::vec3(at.position), -glm::vec3(at.geometric_normal)));
}

std::optional<BoundaryPoint> PlaneBoundary::first(const glm::dvec3& origin,
                                                  const glm::dvec3& direction,
                                                  double farthest) const {
    const double along = glm::dot(direction, normal_);
    const bool up = along > 0.0;
    if (!up && !(thickness_mm_ && along < 0.0)) return std::nullopt;
    const glm::dvec3 on = up ? point_ : point_ - *thickness_mm_ * normal_;
    const double distance = std::max(0.0, glm::dot(on - origin, normal_) / along);
    if (distance > farthest) return std::nullopt;
    BoundaryPoint at;
    at.position = origin + distance * direction;
    at.geometric_normal = at.normal = up ? normal_ : -normal_;
    at.distance = distance;
    return at;
}

glm::dvec3 PlaneBoundary::inside_of(const BoundaryPoint& at) const { return at.position; }

}  // namespace livery
