#include "reference/projected_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"

namespace livery {

ProjectedLight::ProjectedLight(const View& projector, ImageF picture, double distance_mm)
    : projector_(projector),
      picture_(std::move(picture)),
      centre_mm_(centre_in_world(projector)),
      distance_mm_(distance_mm),
      distorts_(std::any_of(projector.distortion.begin(), projector.distortion.end(), [](double k) {
          return k != 0.0;
      })) {
    check_argument(picture_.width == projector.width && picture_.height == projector.height &&
                       picture_.channels >= 3,
                   fmt::format("a picture of {}x{} with {} channels for a projector of {}x{}",
                               picture_.width,
                               picture_.height,
                               picture_.channels,
                               projector.width,
                               projector.height));
    check_argument(std::isfinite(distance_mm) && distance_mm > 0.0,
                   fmt::format("a projector {} mm away", distance_mm));
    for (std::size_t i = 0; i < picture_.values.size(); ++i) {
        const float value = picture_.values[i];
        check_argument(std::isfinite(value) && value >= 0.0f,
                       fmt::format("a projected picture with a value of {}", value));
    }
}

double ProjectedLight::magnified(const glm::dvec3& in_view_mm) const {
    if (!distorts_) return 1.0;
    View lens = projector_;
    lens.view_from_world = Rigid3();
    const double step_mm = 1e-4 * in_view_mm.z;
    const auto along = [&](const glm::dvec3& axis) {
        const auto more = project(lens, in_view_mm + step_mm * axis);
        const auto less = project(lens, in_view_mm - step_mm * axis);
        if (!more || !less) return glm::dvec2(0.0);
        return (*more - *less) * in_view_mm.z / (2.0 * step_mm) / projector_.focal_px;
    };
    const glm::dvec2 x = along({1.0, 0.0, 0.0}), y = along({0.0, 1.0, 0.0});
    return std::abs(x.x * y.y - x.y * y.x);
}

ProjectedLight::Arriving ProjectedLight::at(const glm::dvec3& point_mm) const {
    Arriving arriving;
    const glm::dvec3 way = centre_mm_ - point_mm;
    const double distance = glm::length(way);
    if (!(distance > 0.0)) return arriving;
    arriving.direction = glm::vec3(way / distance);
    arriving.distance_mm = static_cast<float>(distance);
    const auto pixel = project(projector_, point_mm);
    if (!pixel) return arriving;
    const double column = std::floor(pixel->x), row = std::floor(pixel->y);
    if (!(column >= 0.0 && column < projector_.width && row >= 0.0 && row < projector_.height)) {
        return arriving;
    }
    // On a plane across the axis light falls off with the square of the depth alone; one that faces
    // the projector gets more by the cosine between them
    const glm::dvec3 in_view = projector_.view_from_world * point_mm;
    const double nearer = distance_mm_ / in_view.z;
    const double share = nearer * nearer * magnified(in_view) * distance / in_view.z;
    const float* light = picture_.pixel(static_cast<int>(column), static_cast<int>(row));
    arriving.irradiance =
        static_cast<float>(std::numbers::pi * share) * glm::vec3(light[0], light[1], light[2]);
    return arriving;
}

}  // namespace livery
