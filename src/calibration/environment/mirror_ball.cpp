#include "calibration/environment/mirror_ball.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "appearance/bsdf.h"
#include "core/angles.h"
#include "core/error.h"
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

namespace {

constexpr int kBallSectors = 180;
constexpr double kStep_px = 0.25;  ///< along a way across the outline
constexpr int kSide = 6;           ///< steps to each side over which brightness is compared
/// How far from the outline steps are looked for, round by round; the first of them in parts of the
/// ball's radius, the others in pixels.
constexpr double kFirstReach = 0.06;
constexpr std::array<double, 4> kReaches_px{12.0, 6.0, 4.0, 4.0};
constexpr double kFaintest = 0.04;  ///< step over the brightness around it
constexpr double kOnOutline_px = 1.5, kFewestOfVisible = 0.6, kFewestOfAll = 0.35;
constexpr double kLargestBallRms_px = 1.0;
constexpr double kOpen = kFullTurn * 2.0 / 3.0, kNearAzimuth = kFullTurn / 6.0;

double pixel_angle(const View& view) { return 1.0 / std::min(view.focal_px.x, view.focal_px.y); }

/// The cone's angle and the diameter say how far away the ball is.
Sphere sphere_with(const View& view, TangentCone cone, double diameter_mm) {
    cone.distance_mm = 0.5 * diameter_mm / std::sin(cone.angle_rad);
    return {sphere_of(view, cone).centre_mm, diameter_mm};
}

/// A cone around a bundle of rays, to begin with.
TangentCone cone_around(const View& view, std::span<const glm::dvec3> rays) {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& ray : rays) sum += ray;
    TangentCone cone;
    cone.axis = glm::normalize(sum);
    const glm::dvec3 rows_down = glm::transpose(view.view_from_world.rotation)[1];
    cone.right = glm::normalize(glm::cross(rows_down, cone.axis));
    cone.down = glm::cross(cone.axis, cone.right);
    cone.distance_mm = 1.0;
    for (const glm::dvec3& ray : rays) {
        cone.angle_rad += edge_of(cone, ray).angle_rad / static_cast<double>(rays.size());
    }
    return cone;
}

/// The largest gap between points, and how much of the way around has points near.
struct Spread {
    double largest_gap_rad = 0.0, near_rad = 0.0;
};
Spread spread_of(std::span<const ConeEdge> edges) {
    std::vector<double> turns;
    for (const ConeEdge& edge : edges) turns.push_back(edge.turn_rad);
    std::sort(turns.begin(), turns.end());
    turns.push_back(turns.front() + kFullTurn);
    Spread spread;
    for (std::size_t k = 1; k < turns.size(); ++k) {
        const double gap = turns[k] - turns[k - 1];
        spread.largest_gap_rad = std::max(spread.largest_gap_rad, gap);
        if (gap <= kNearAzimuth) spread.near_rad += gap;
    }
    return spread;
}

double brightness_at(const LightPicture& picture, const glm::dvec2& pixel, bool& known) {
    const auto light = sample(picture, pixel, false);
    if (!light) {
        known = false;
        return 0.0;
    }
    return light->light.x + light->light.y + light->light.z;
}

/// The steepest step across the outline at one turn, as an angle from the axis. `in_picture` tells
/// whether the way lies in the picture.
std::optional<double> steepest_step(const View& view,
                                    const LightPicture& picture,
                                    const TangentCone& cone,
                                    double turn_rad,
                                    double reach_px,
                                    bool& in_picture) {
    const double pixel_rad = pixel_angle(view);
    const glm::dvec3 eye = centre_in_world(view), aside = around(cone, turn_rad);
    const int half = static_cast<int>(std::ceil(reach_px / kStep_px)) + kSide;
    std::vector<double> along(static_cast<std::size_t>(2 * half + 1));
    in_picture = true;
    for (int k = -half; k <= half && in_picture; ++k) {
        const double angle = cone.angle_rad + k * kStep_px * pixel_rad;
        const auto pixel =
            project(view, eye + std::cos(angle) * cone.axis + std::sin(angle) * aside);
        if (!pixel) {
            in_picture = false;
        } else {
            along[static_cast<std::size_t>(k + half)] = brightness_at(picture, *pixel, in_picture);
        }
    }
    if (!in_picture) return std::nullopt;
    const auto mean = [&](int from, int to) {
        double sum = 0.0;
        for (int k = from; k < to; ++k) sum += along[static_cast<std::size_t>(k + half)];
        return sum / (to - from);
    };
    std::vector<double> steps;
    double best = kFaintest;
    int best_at = half + 1;
    for (int k = -half + kSide; k <= half - kSide; ++k) {
        const double inside = mean(k - kSide, k), outside = mean(k + 1, k + 1 + kSide);
        steps.push_back(inside - outside);
        const double scale = std::abs(inside) + std::abs(outside);
        const double contrast = scale > 0.0 ? std::abs(inside - outside) / scale : 0.0;
        if (contrast > best) {
            best = contrast;
            best_at = k;
        }
    }
    const int first = -half + kSide, last = half - kSide;
    if (best_at <= first || best_at >= last) return std::nullopt;
    // Between the steps: the parabola through the three around the steepest.
    const auto step = [&](int k) { return std::abs(steps[static_cast<std::size_t>(k - first)]); };
    int top = best_at;
    while (top > first + 1 && step(top - 1) > step(top)) --top;
    while (top < last - 1 && step(top + 1) > step(top)) ++top;
    const double bend = step(top - 1) - 2.0 * step(top) + step(top + 1);
    const double shift =
        bend < 0.0 ? std::clamp(0.5 * (step(top - 1) - step(top + 1)) / bend, -1.0, 1.0) : 0.0;
    return cone.angle_rad + (top + shift) * kStep_px * pixel_rad;
}

[[noreturn]] void refuse_ball_outline(const std::string& why) {
    throw Refused("the ball's outline does not show: " + why,
                  "put it before a background of another brightness, or name points of its outline "
                  "(outline_px) and set fit_outline to false");
}

}  // namespace

OutlineFit fit_outline_points(const View& view,
                              std::span<const glm::dvec2> outline_px,
                              double diameter_mm,
                              double largest_rms_px) {
    const std::string fix = "click points all around the ball's outline";
    if (outline_px.size() < 5) {
        throw Refused(
            fmt::format("{} points of the outline, expected five or more", outline_px.size()), fix);
    }
    std::vector<glm::dvec3> rays;
    for (const glm::dvec2& pixel : outline_px) {
        const auto ray = find_ray(view, pixel);
        if (!ray) {
            throw Refused(
                fmt::format("no ray of the camera goes to the outline's point {:.1f},{:.1f}",
                            pixel.x,
                            pixel.y),
                fix);
        }
        rays.push_back(ray->direction);
    }
    TangentCone cone = cone_around(view, rays);
    const double pixel_rad = pixel_angle(view);
    std::vector<ConeEdge> edges;
    double rms = 0.0;
    for (int round = 0; round < 20; ++round) {
        edges.clear();
        for (const glm::dvec3& ray : rays) edges.push_back(edge_of(cone, ray));
        rms = move_cone(edges, 2.0 * pixel_rad, cone) / pixel_rad;
    }
    const Spread spread = spread_of(edges);
    if (!(spread.largest_gap_rad < kOpen) || !(cone.angle_rad > pixel_rad) ||
        !(cone.angle_rad < 0.25 * kFullTurn)) {
        throw Refused(fmt::format("the outline's points leave {:.0f} degrees open",
                                  360.0 * spread.largest_gap_rad / kFullTurn),
                      fix);
    }
    if (!(rms <= largest_rms_px)) {
        throw Refused(fmt::format("the outline's points lie {:.1f} px from a ball's outline", rms),
                      "check them and the camera file: pixel centres are at half integers");
    }
    return {sphere_with(view, cone, diameter_mm), rms, spread.near_rad / kFullTurn};
}

OutlineFit find_ball_outline(const View& view, const LightPicture& picture, const Sphere& start) {
    TangentCone cone = cone_of(view, start);
    const double pixel_rad = pixel_angle(view);
    OutlineFit fit;
    const double first = std::max(kFirstReach * cone.angle_rad / pixel_rad, kReaches_px.front());
    for (std::size_t round = 0; round <= kReaches_px.size(); ++round) {
        const double reach_px = round == 0 ? first : kReaches_px[round - 1];
        std::vector<ConeEdge> edges;
        double in_picture = 0.0;
        for (int k = 0; k < kBallSectors; ++k) {
            const double turn = kFullTurn * (k + 0.5) / kBallSectors;
            bool inside = false;
            const auto edge = steepest_step(view, picture, cone, turn, reach_px, inside);
            in_picture += inside ? 1.0 : 0.0;
            if (edge) edges.push_back({turn, *edge});
        }
        const auto found = static_cast<double>(edges.size());
        if (found < kFewestOfVisible * in_picture || found < kFewestOfAll * kBallSectors) {
            refuse_ball_outline(
                fmt::format("a step of brightness is found over {:.0f}% of the way around",
                            100.0 * found / kBallSectors));
        }
        const TangentCone before = cone;
        move_cone(edges, 0.5 * pixel_rad, cone);
        // What lies off belongs to what the ball mirrors.
        double squares = 0.0, on = 0.0;
        for (const ConeEdge& edge : edges) {
            const double off =
                (edge_of(cone,
                         std::cos(edge.angle_rad) * before.axis +
                             std::sin(edge.angle_rad) * around(before, edge.turn_rad))
                     .angle_rad -
                 cone.angle_rad) /
                pixel_rad;
            if (std::abs(off) > kOnOutline_px) continue;
            squares += off * off;
            on += 1.0;
        }
        fit.seen_fraction = on / kBallSectors;
        fit.rms_px = on > 0.0 ? std::sqrt(squares / on) : 0.0;
        if (round == kReaches_px.size() &&
            (on < kFewestOfVisible * in_picture || fit.rms_px > kLargestBallRms_px)) {
            refuse_ball_outline(
                fmt::format("{:.0f}% of the way around lies on one", 100.0 * fit.seen_fraction));
        }
    }
    fit.sphere = sphere_with(view, cone, start.diameter_mm);
    return fit;
}

}  // namespace livery
