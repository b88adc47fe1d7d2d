#include "scene/view.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/mutation.h"

namespace livery {

namespace {

struct Distorted {
    glm::dvec2 point{0.0};
    glm::dmat2 jacobian{1.0};
};

/// Brown-Conrady as OpenCV writes it, on the plane z = 1.
Distorted distort(const std::array<double, 5>& lens, const glm::dvec2& p) {
    const auto [k1, k2, p1, p2, k3] = lens;
    const double x = p.x, y = p.y, s = x * x + y * y;
    const double radial = 1.0 + LIVERY_MUTATED(lens_distortion, s * (k1 + s * (k2 + s * k3)));
    const double slope = k1 + s * (2.0 * k2 + s * 3.0 * k3);  // d radial / d s
    Distorted result;
    result.point = {x * radial + 2.0 * p1 * x * y + p2 * (s + 2.0 * x * x),
                    y * radial + p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y};
    const double mixed = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
    result.jacobian[0] = {radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, mixed};
    result.jacobian[1] = {mixed, radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x};
    return result;
}

bool is_distorted(const std::array<double, 5>& lens) {
    return std::any_of(lens.begin(), lens.end(), [](double k) { return k != 0.0; });
}

/// Whether r (1 + k1 r^2 + k2 r^4 + k3 r^6) rises all the way from 0 to r = sqrt(s): its slope,
/// a cubic in s, is positive at the end and at its own turning points in between.
bool rises_up_to(const std::array<double, 5>& lens, double s) {
    const double a = 3.0 * lens[0], b = 5.0 * lens[1], c = 7.0 * lens[4];
    if (a >= 0.0 && b >= 0.0 && c >= 0.0) return true;
    const auto positive = [&](double t) { return 1.0 + t * (a + t * (b + t * c)) > 0.0; };
    const auto turning_is_fine = [&](double t) { return !(t > 0.0 && t < s) || positive(t); };
    if (!positive(s)) return false;
    if (c == 0.0) return b == 0.0 || turning_is_fine(-a / (2.0 * b));
    const double under_root = b * b - 3.0 * a * c;
    if (under_root <= 0.0) return true;
    // The stable pair of roots of a + 2 b t + 3 c t^2.
    const double q = -(b + std::copysign(std::sqrt(under_root), b));
    return turning_is_fine(q / (3.0 * c)) && (q == 0.0 || turning_is_fine(a / q));
}

/// Inside the region around the axis in which the lens maps one to one.
bool is_one_to_one_at(const std::array<double, 5>& lens,
                      const glm::dvec2& p,
                      const Distorted& distorted) {
    return rises_up_to(lens, glm::dot(p, p)) && glm::determinant(distorted.jacobian) > 0.0;
}

/// The radius that the radial polynomial alone maps to `wanted`; where it stops rising, that limit.
double undistorted_radius(const std::array<double, 5>& lens, double wanted) {
    const auto radius = [&](double r) {
        const double s = r * r;
        return r * (1.0 + s * (lens[0] + s * (lens[1] + s * lens[4])));
    };
    double low = 0.0, high = wanted;
    while (rises_up_to(lens, high * high) && radius(high) < wanted && high < 1e6) {
        low = high;
        high *= 2.0;
    }
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        const bool is_low = rises_up_to(lens, middle * middle) && radius(middle) < wanted;
        (is_low ? low : high) = middle;
    }
    return low;
}

/// Newton with halved steps inside the one-to-one region. Nothing when it does not get there.
std::optional<glm::dvec2> undistort_from(const View& view,
                                         const glm::dvec2& wanted,
                                         glm::dvec2 point) {
    // Aiming under the promised 1e-10 px costs nothing: the convergence is quadratic.
    constexpr double tolerance_px = 2e-11;
    const auto error_px = [&](const Distorted& at) {
        return glm::length((at.point - wanted) * view.focal_px);
    };
    Distorted at = distort(view.distortion, point);
    if (!is_one_to_one_at(view.distortion, point, at)) return std::nullopt;
    for (int iteration = 0; iteration < 50; ++iteration) {
        const double error = error_px(at);
        if (error < tolerance_px) return point;
        const glm::dvec2 step = glm::inverse(at.jacobian) * (wanted - at.point);
        double fraction = 1.0;
        for (;; fraction *= 0.5) {
            if (fraction < 1e-6) return error < 1e-10 ? std::optional(point) : std::nullopt;
            const glm::dvec2 next = point + fraction * step;
            const Distorted there = distort(view.distortion, next);
            if (is_one_to_one_at(view.distortion, next, there) && error_px(there) < error) {
                point = next;
                at = there;
                break;
            }
        }
    }
    return std::nullopt;
}

}  // namespace

Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a) {
    return {c_from_b.rotation * b_from_a.rotation, c_from_b * b_from_a.translation};
}

Rigid3 inverse(const Rigid3& target_from_source) {
    const glm::dmat3 rotation = glm::transpose(target_from_source.rotation);
    return {rotation, -(rotation * target_from_source.translation)};
}

std::optional<glm::dvec2> project(const View& view, const glm::dvec3& x_in_world) {
    const glm::dvec3 x_in_view = view.view_from_world * x_in_world;
    if (!(x_in_view.z > 0.0)) return std::nullopt;
    glm::dvec2 point = glm::dvec2(x_in_view) / x_in_view.z;
    if (is_distorted(view.distortion)) {
        const Distorted distorted = distort(view.distortion, point);
        if (!is_one_to_one_at(view.distortion, point, distorted)) return std::nullopt;
        point = distorted.point;
    }
    const glm::dvec2 pixel =
        LIVERY_MUTATED(camera_focal, point * view.focal_px) + view.principal_px;
    if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y)) return std::nullopt;
    return pixel;
}

std::optional<Ray> find_ray(const View& view, const glm::dvec2& pixel) {
    const glm::dvec2 wanted = (pixel - view.principal_px) / view.focal_px;
    glm::dvec2 point = wanted;
    if (is_distorted(view.distortion)) {
        auto solved = undistort_from(view, wanted, wanted);
        if (!solved) {
            // Strong lenses: start from the exact inverse of the radial part.
            const double radius = glm::length(wanted);
            const double start = undistorted_radius(view.distortion, radius);
            solved = undistort_from(view, wanted, wanted * (radius > 0.0 ? start / radius : 1.0));
        }
        if (!solved) return std::nullopt;
        point = *solved;
    }
    const glm::dvec3 direction_in_view = glm::normalize(glm::dvec3(point, 1.0));
    return Ray{centre_in_world(view), direction_in_view * view.view_from_world.rotation};
}

Ray ray_through(const View& view, const glm::dvec2& pixel) {
    const std::optional<Ray> ray = find_ray(view, pixel);
    if (!ray) {
        const auto& lens = view.distortion;
        throw std::invalid_argument(fmt::format(
            "ray_through: no ray meets pixel ({}, {}) through the lens {}, {}, {}, {}, {}",
            pixel.x,
            pixel.y,
            lens[0],
            lens[1],
            lens[2],
            lens[3],
            lens[4]));
    }
    return *ray;
}

glm::dvec3 centre_in_world(const View& view) {
    // A vector times a matrix multiplies with the transpose, which is the inverse rotation.
    return -(view.view_from_world.translation * view.view_from_world.rotation);
}

View look_at(glm::dvec3 from, glm::dvec3 at, double vertical_fov_rad, int width, int height) {
    check_argument(glm::distance(from, at) > 0.0, "look_at: from and at are the same point");
    check_argument(
        vertical_fov_rad > 0.0 && vertical_fov_rad < 3.14159,
        fmt::format("look_at: field of view {} rad is not in (0, pi)", vertical_fov_rad));
    check_argument(width > 0 && height > 0, fmt::format("look_at: a {}x{} picture", width, height));
    const glm::dvec3 forward = glm::normalize(at - from);
    glm::dvec3 right = glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0));
    // Straight up or down, the picture's top is toward -z or +z.
    if (glm::length(right) < 1e-9) right = {1.0, 0.0, 0.0};
    right = glm::normalize(right - forward * glm::dot(forward, right));
    const glm::dvec3 down = glm::cross(forward, right);

    View view;
    view.width = width;
    view.height = height;
    view.focal_px = glm::dvec2(0.5 * height / std::tan(0.5 * vertical_fov_rad));
    view.principal_px = {0.5 * width, 0.5 * height};
    view.view_from_world.rotation = glm::transpose(glm::dmat3(right, down, forward));
    view.view_from_world.translation = -(view.view_from_world.rotation * from);
    return view;
}

View resized(const View& view, int width, int height) {
    check_argument(width > 0 && height > 0, "resized: needs a positive size");
    const glm::dvec2 scale(static_cast<double>(width) / view.width,
                           static_cast<double>(height) / view.height);
    View result = view;
    result.focal_px *= scale;
    result.principal_px *= scale;
    result.width = width;
    result.height = height;
    return result;
}

View cropped(const View& view, int left, int top, int width, int height) {
    check_argument(width > 0 && height > 0, "cropped: needs a positive size");
    View result = view;
    result.principal_px -= glm::dvec2(left, top);
    result.width = width;
    result.height = height;
    return result;
}

}  // namespace livery
