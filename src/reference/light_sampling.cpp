#include "reference/light_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/mutation.h"

namespace livery {

namespace {

/// Right-handed, third column `n` (Duff et al. 2017).
glm::dmat3 frame_around(const glm::dvec3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {glm::dvec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            glm::dvec3(b, sign + n.y * n.y * a, -n.y),
            n};
}

/// Index of the running sum's step that holds u x total, and where in the step.
int find_step(const double* begin, const double* end, double u, double& within) {
    const double wanted = u * *(end - 1);
    const double* found = std::upper_bound(begin, end - 1, wanted);
    const double low = found == begin ? 0.0 : *(found - 1);
    const double width = *found - low;
    within = width > 0.0 ? std::clamp((wanted - low) / width, 0.0, 1.0) : 0.5;
    return static_cast<int>(found - begin);
}

}  // namespace

DiscLight::DiscLight(const DirectionalLight& light)
    : world_from_light_(frame_around(glm::normalize(light.direction))) {
    const glm::dvec3 radiance = working_from_rec709() * light.radiance_rec709;
    irradiance_ = LIVERY_MUTATED(reference_point_lamp, glm::vec3(std::numbers::pi * radiance));
    const double radius = std::min(0.5 * light.angle_rad, 0.5 * std::numbers::pi);
    if (radius <= 0.0) return;
    const double half_sine = std::sin(0.5 * radius);
    one_minus_cos_ = 2.0 * half_sine * half_sine;
    solid_angle_ = 2.0 * std::numbers::pi * one_minus_cos_;
    // A disc of radiance L lights a plane that faces it with pi L sin^2 of its radius.
    radiance_ =
        LIVERY_MUTATED(reference_lamp, glm::vec3(radiance / (std::sin(radius) * std::sin(radius))));
}

LightSample DiscLight::sample(glm::vec2 u) const {
    const double height = static_cast<double>(u.x) * one_minus_cos_;
    const double sine = std::sqrt(height * (2.0 - height));
    const double phi = 2.0 * std::numbers::pi * static_cast<double>(u.y);
    const glm::dvec3 local(sine * std::cos(phi), sine * std::sin(phi), 1.0 - height);
    return {
        glm::vec3(world_from_light_ * local), radiance_, static_cast<float>(1.0 / solid_angle_)};
}

LightSample DiscLight::along(const glm::vec3& direction) const {
    LightSample light;
    light.direction = direction;
    // |d - n|^2 = 2 (1 - cos), without the cancellation of 1 - cos
    const glm::dvec3 apart = glm::normalize(glm::dvec3(direction)) - world_from_light_[2];
    if (is_point() || glm::dot(apart, apart) > 2.0 * one_minus_cos_) return light;
    light.radiance = radiance_;
    light.pdf = static_cast<float>(1.0 / solid_angle_);
    return light;
}

EnvironmentSampler::EnvironmentSampler(const Environment* environment) : environment_(environment) {
    if (!environment || environment->radiance_working.empty()) return;
    const ImageF& map = environment->radiance_working;
    row_sum_.reserve(static_cast<std::size_t>(map.height));
    column_sum_.reserve(map.pixel_count());
    for (int y = 0; y < map.height; ++y) {
        const double solid_angle = 2.0 * std::numbers::pi / map.width *
                                   (std::cos(std::numbers::pi * y / map.height) -
                                    std::cos(std::numbers::pi * (y + 1) / map.height));
        double row = 0.0;
        for (int x = 0; x < map.width; ++x) {
            row += importance(x, y) * solid_angle;
            column_sum_.push_back(row);
        }
        total_ += row;
        row_sum_.push_back(total_);
    }
}

double EnvironmentSampler::importance(int x, int y) const {
    const float* value = environment_->radiance_working.pixel(x, y);
    return std::max(
        0.0,
        environment_->scale * (static_cast<double>(value[0]) + static_cast<double>(value[1]) +
                               static_cast<double>(value[2])));
}

LightSample EnvironmentSampler::of_pixel(int x, int y) const {
    const float* value = environment_->radiance_working.pixel(x, y);
    LightSample light;
    light.radiance =
        glm::vec3(value[0], value[1], value[2]) * static_cast<float>(environment_->scale);
    light.pdf = LIVERY_MUTATED(reference_environment_density,
                               static_cast<float>(importance(x, y) / total_));
    return light;
}

LightSample EnvironmentSampler::sample(glm::vec2 u) const {
    const ImageF& map = environment_->radiance_working;
    double within_row = 0.5, within_column = 0.5;
    const int y = find_step(
        row_sum_.data(), row_sum_.data() + row_sum_.size(), static_cast<double>(u.y), within_row);
    const double* columns = column_sum_.data() + static_cast<std::ptrdiff_t>(y) * map.width;
    const int x = find_step(columns, columns + map.width, static_cast<double>(u.x), within_column);
    LightSample light = of_pixel(x, y);
    // Uniform over the pixel's solid angle: even steps of the polar cosine
    const double top = std::cos(std::numbers::pi * y / map.height);
    const double bottom = std::cos(std::numbers::pi * (y + 1) / map.height);
    const double polar = std::acos(std::clamp(top + within_row * (bottom - top), -1.0, 1.0));
    light.direction = glm::vec3(direction_from_uv(
        *environment_, {(x + within_column) / map.width, polar / std::numbers::pi}));
    return light;
}

LightSample EnvironmentSampler::along(const glm::vec3& direction) const {
    const ImageF& map = environment_->radiance_working;
    const glm::dvec2 uv = uv_from_direction(*environment_, glm::dvec3(direction));
    LightSample light = of_pixel(std::min(static_cast<int>(uv.x * map.width), map.width - 1),
                                 std::min(static_cast<int>(uv.y * map.height), map.height - 1));
    light.direction = direction;
    return light;
}

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
