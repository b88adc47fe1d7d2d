#include "calibration/environment/mirror_ball.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "appearance/bsdf.h"
#include "core/mutation.h"

namespace livery {

namespace {

constexpr double kRim_px = 1.5;

/// Angles in the plane of ball, eye and mirrored direction, all from the way to the eye.
struct MirrorAngles {
    double distance = 0.0;  ///< of the eye from the middle, in radii
    double last_alpha = 0.0;

    /// Between the camera's ray to the place at `alpha` and its ray to the middle.
    double delta(double alpha) const {
        return std::atan2(std::sin(alpha), distance - std::cos(alpha));
    }
    double delta_slope(double alpha) const {
        const double cosine = std::cos(alpha);
        return (distance * cosine - 1.0) / (distance * distance - 2.0 * distance * cosine + 1.0);
    }
    /// The place that mirrors what comes at `gamma`; gamma is below that of the last place.
    double alpha_of(double gamma) const {
        double low = 0.0, high = last_alpha, alpha = 0.5 * gamma;
        for (int step = 0; step < 60; ++step) {
            if (!(alpha > low && alpha < high)) alpha = 0.5 * (low + high);
            const double off = 2.0 * alpha + delta(alpha) - gamma;
            (off > 0.0 ? high : low) = alpha;
            const double change = off / (2.0 + delta_slope(alpha));
            alpha -= change;
            if (std::abs(change) < 1e-14) break;
        }
        return std::clamp(alpha, 0.0, last_alpha);
    }
};

}  // namespace

double hidden_behind_rad(const View& view, const Sphere& sphere) {
    return cone_of(view, sphere).angle_rad;
}

SeeDirection seen_in_ball(const View& view, const MirrorBall& ball) {
    const TangentCone cone = cone_of(view, ball.sphere);
    const double radius = 0.5 * ball.sphere.diameter_mm;
    const glm::dvec3 to_eye = -cone.axis;
    const double pixel_rad = 1.0 / std::min(view.focal_px.x, view.focal_px.y);
    const MirrorAngles angles{cone.distance_mm / radius, 0.5 * std::numbers::pi - cone.angle_rad};
    const double last_gamma = std::numbers::pi - cone.angle_rad;
    return [=](const glm::dvec3& direction) -> std::optional<SeenAt> {
        const double along = glm::dot(direction, to_eye);
        const glm::dvec3 aside = direction - along * to_eye;
        const double gamma = std::atan2(glm::length(aside), along);
        if (gamma >= last_gamma || gamma < ball.camera_rad) return std::nullopt;
        const double alpha = angles.alpha_of(gamma), delta = angles.delta(alpha);
        if (cone.angle_rad - delta < kRim_px * pixel_rad) return std::nullopt;
        const glm::dvec3 across =
            glm::length(aside) > 0.0 ? glm::normalize(aside) : glm::dvec3(0.0);
        const glm::dvec3 normal =
            LIVERY_MUTATED(ball_normal, std::sin(alpha)) * across + std::cos(alpha) * to_eye;
        const auto pixel = project(view, ball.sphere.centre_mm + radius * normal);
        if (!pixel) return std::nullopt;

        SeenAt seen;
        seen.pixel = *pixel;
        const double radial = pixel_rad * (1.0 + 2.0 / angles.delta_slope(alpha));
        const double tangential =
            delta > 1e-9 ? pixel_rad * std::sin(gamma) / std::sin(delta) : radial;
        seen.widest_rad = std::max(radial, tangential);
        seen.finest_rad = std::min(radial, tangential);
        const double cosine = std::cos(alpha + delta);
        const double schlick = ball.fresnel ? f64::schlick_weight(4.0 * cosine * cosine) : 0.0;
        seen.passed = ball.reflectance + (1.0 - ball.reflectance) * schlick;
        return seen;
    };
}

}  // namespace livery
