// What a mirror ball shows, against rays mirrored here by formulas of their own.

#include "calibration/environment/mirror_ball.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/support/degree.h"
#include "core/random.h"
#include "support/message_of.h"

namespace livery {
namespace {

using testing::kDegree;

const Sphere kBall{{12.0, -7.0, 20.0}, 90.0};

View camera(double distance_mm = 600.0) {
    View view = look_at({0.2 * distance_mm, 0.3 * distance_mm, 0.9 * distance_mm},
                        {10.0, 0.0, 15.0},
                        2.6 * std::asin(45.0 / distance_mm),
                        400,
                        300);
    view.distortion = {-0.3, 0.05, 0.001, -0.0005, 0.0};
    return view;
}

/// Where light that leaves the ball through a pixel came from; nothing beside the ball.
std::optional<glm::dvec3> mirrored(const View& view, const glm::dvec2& pixel) {
    const Ray ray = ray_through(view, pixel);
    const glm::dvec3 from = ray.origin - kBall.centre_mm;
    const double b = glm::dot(ray.direction, from);
    const double c = glm::dot(from, from) - 45.0 * 45.0;
    if (b * b < c) return std::nullopt;
    const glm::dvec3 n = glm::normalize(from + (-b - std::sqrt(b * b - c)) * ray.direction);
    return ray.direction - 2.0 * glm::dot(n, ray.direction) * n;
}

TEST(MirrorBall, EachPixelsDirectionLeadsBackToIt) {
    // From far away and from so near that half of the ball is hidden.
    for (const double distance_mm : {3000.0, 600.0, 110.0}) {
        const View view = camera(distance_mm);
        const SeeDirection see = seen_in_ball(view, {kBall});
        int led = 0;
        for (int y = 0; y < view.height; y += 7) {
            for (int x = 0; x < view.width; x += 7) {
                const glm::dvec2 pixel(x + 0.3, y + 0.6);
                const auto direction = mirrored(view, pixel);
                if (!direction) continue;
                const auto seen = see(*direction);
                if (!seen) continue;  // at the rim
                ++led;
                ASSERT_LT(glm::distance(seen->pixel, pixel), 1e-6) << x << "," << y;
            }
        }
        EXPECT_GT(led, 500) << distance_mm;
    }
}

TEST(MirrorBall, TellsHowMuchAPixelSpans) {
    const View view = camera();
    const SeeDirection see = seen_in_ball(view, {kBall});
    const auto slope = [&](const glm::dvec2& pixel, const glm::dvec2& step) {
        return 50.0 * (*mirrored(view, pixel + 0.01 * step) - *mirrored(view, pixel - 0.01 * step));
    };
    int compared = 0;
    for (int y = 5; y < view.height; y += 11) {
        for (int x = 5; x < view.width; x += 11) {
            const glm::dvec2 pixel(x, y);
            const auto direction = mirrored(view, pixel);
            if (!direction) continue;
            const auto seen = see(*direction);
            if (!seen) continue;
            // The singular values of the direction's slopes along x and y.
            const glm::dvec3 x_slope = slope(pixel, {1.0, 0.0}), y_slope = slope(pixel, {0.0, 1.0});
            const double xx = glm::dot(x_slope, x_slope), yy = glm::dot(y_slope, y_slope);
            const double root = std::hypot(0.5 * (xx - yy), glm::dot(x_slope, y_slope));
            const double widest = std::sqrt(0.5 * (xx + yy) + root);
            const double finest = glm::length(glm::cross(x_slope, y_slope)) / widest;
            // The picture's own distortion is left out of them.
            EXPECT_NEAR(seen->widest_rad / widest, 1.0, 0.1);
            EXPECT_NEAR(seen->finest_rad / finest, 1.0, 0.1);
            ++compared;
        }
    }
    EXPECT_GT(compared, 200);
}

TEST(MirrorBall, HidesWhatIsBehindItAndBehindTheCamera) {
    const View view = camera();
    const glm::dvec3 eye = centre_in_world(view);
    const glm::dvec3 to_eye = glm::normalize(eye - kBall.centre_mm);
    const double hidden = hidden_behind_rad(view, kBall);
    EXPECT_NEAR(std::sin(hidden), 45.0 / glm::distance(eye, kBall.centre_mm), 1e-12);
    const SeeDirection see = seen_in_ball(view, {kBall});
    EXPECT_FALSE(see(-to_eye));
    const auto at = [&](double angle) {
        const glm::dvec3 aside = glm::normalize(glm::cross(to_eye, glm::dvec3(0, 1, 0)));
        return std::cos(angle) * to_eye + std::sin(angle) * aside;
    };
    EXPECT_FALSE(see(at(std::numbers::pi - 0.9 * hidden)));
    // The outermost pixel and a half, of 150, mirror the next 20 degrees.
    EXPECT_FALSE(see(at(std::numbers::pi - hidden - 0.1)));
    EXPECT_TRUE(see(at(std::numbers::pi - hidden - 0.5)));
    EXPECT_TRUE(see(to_eye));
    const SeeDirection beside = seen_in_ball(view, {kBall, glm::dvec3(1.0), true, 5.0 * kDegree});
    EXPECT_FALSE(beside(to_eye));
    EXPECT_FALSE(beside(at(4.9 * kDegree)));
    EXPECT_TRUE(beside(at(5.1 * kDegree)));
    EXPECT_THROW(seen_in_ball(view, {{eye, 90.0}}), std::invalid_argument);
    EXPECT_THROW(seen_in_ball(view, {{kBall.centre_mm, 0.0}}), std::invalid_argument);
}

TEST(MirrorBall, ReflectsMoreTheMoreAslant) {
    const View view = camera();
    const glm::dvec3 metal(0.6, 0.5, 0.4);
    const SeeDirection even = seen_in_ball(view, {kBall, metal, false});
    const SeeDirection see = seen_in_ball(view, {kBall, metal, true});
    const glm::dvec3 to_eye = glm::normalize(centre_in_world(view) - kBall.centre_mm);
    EXPECT_LT(glm::distance(see(to_eye)->passed, metal), 1e-9);
    const glm::dvec3 aside = glm::normalize(glm::cross(to_eye, glm::dvec3(0, 1, 0)));
    const double angle = 150.0 * kDegree;
    const auto seen = see(std::cos(angle) * to_eye + std::sin(angle) * aside);
    ASSERT_TRUE(seen);
    // From the mirrored pixel's own rays: the angle of incidence is half of that between them.
    const Ray ray = ray_through(view, seen->pixel);
    const glm::dvec3 out = *mirrored(view, seen->pixel);
    const double cosine = std::cos(0.5 * std::acos(glm::dot(-ray.direction, out)));
    const glm::dvec3 schlick = metal + (1.0 - metal) * std::pow(1.0 - cosine, 5.0);
    EXPECT_LT(glm::distance(seen->passed, schlick), 1e-6);
    EXPECT_GT(seen->passed.z, 0.5);
    EXPECT_LT(
        glm::distance(even(std::cos(angle) * to_eye + std::sin(angle) * aside)->passed, metal),
        1e-12);
}

/// Points of the outline, all around or a part of it, with noise in pixels.
std::vector<glm::dvec2> outline_points(const View& view, int count, double turns, double noise_px) {
    const glm::dvec3 eye = centre_in_world(view), way = kBall.centre_mm - eye;
    const double distance = glm::length(way), radius = 45.0;
    const glm::dvec3 axis = way / distance;
    const glm::dvec3 side = glm::normalize(glm::cross(axis, glm::dvec3(0.3, 1.0, 0.2)));
    const glm::dvec3 up = glm::cross(side, axis);
    // The circle in which the tangents touch.
    const glm::dvec3 middle = eye + (distance - radius * radius / distance) * axis;
    const double touch = radius * std::sqrt(1.0 - radius * radius / (distance * distance));
    Random random(5);
    std::vector<glm::dvec2> points;
    for (int k = 0; k < count; ++k) {
        const double turn = 2.0 * std::numbers::pi * turns * k / count;
        const auto pixel =
            project(view, middle + touch * (std::cos(turn) * side + std::sin(turn) * up));
        points.push_back(*pixel + noise_px * glm::dvec2(random.normal(), random.normal()));
    }
    return points;
}

TEST(BallOutline, ExactPointsGiveTheBallInAnyPerspective) {
    for (const double distance_mm : {3000.0, 600.0, 110.0}) {
        const View view = camera(distance_mm);
        const OutlineFit fit =
            fit_outline_points(view, outline_points(view, 12, 1.0, 0.0), 90.0, 1.0);
        EXPECT_LT(glm::distance(fit.sphere.centre_mm, kBall.centre_mm), 1e-4 * distance_mm);
        EXPECT_LT(fit.rms_px, 1e-3);
        EXPECT_NEAR(fit.seen_fraction, 1.0, 1e-9);
    }
}

TEST(BallOutline, NoiseOfHalfAPixelAveragesOut) {
    const View view = camera();
    const OutlineFit fit = fit_outline_points(view, outline_points(view, 60, 1.0, 0.5), 90.0, 2.0);
    const auto middle = project(view, fit.sphere.centre_mm), truth = project(view, kBall.centre_mm);
    // A middle's standard error is 0.5 sqrt(2 / 60) px, the radius' 0.5 / sqrt(60).
    EXPECT_LT(glm::distance(*middle, *truth), 4.0 * 0.5 * std::sqrt(2.0 / 60.0));
    EXPECT_NEAR(hidden_behind_rad(view, fit.sphere) / hidden_behind_rad(view, kBall),
                1.0,
                4.0 * 0.5 / std::sqrt(60.0) / 130.0);
    EXPECT_NEAR(fit.rms_px, 0.5, 0.15);
    // One that was clicked in the wrong place hardly matters.
    auto points = outline_points(view, 60, 1.0, 0.0);
    points[7] += glm::dvec2(9.0, -6.0);
    const OutlineFit despite = fit_outline_points(view, points, 90.0, 3.0);
    EXPECT_LT(glm::distance(*project(view, despite.sphere.centre_mm), *truth), 0.1);
}

TEST(BallOutline, SaysWhatIsWrongWithPoints) {
    const View view = camera();
    const auto refusal = [&](const std::vector<glm::dvec2>& points) {
        return message_of([&] { fit_outline_points(view, points, 90.0, 2.0); });
    };
    EXPECT_NE(refusal(outline_points(view, 4, 1.0, 0.0)).find("4 points"), std::string::npos);
    EXPECT_NE(refusal(outline_points(view, 20, 0.2, 0.0)).find("degrees open"), std::string::npos);
    EXPECT_NE(refusal(outline_points(view, 30, 1.0, 12.0)).find("px from a ball's outline"),
              std::string::npos);
    // Half of it is enough.
    EXPECT_EQ(refusal(outline_points(view, 30, 0.5, 0.0)), "nothing thrown");
    EXPECT_NE(refusal(std::vector<glm::dvec2>(8, glm::dvec2(200.0, 150.0))), "nothing thrown");
}

/// A striped ball before a background of `behind`, each pixel the mean of 16.
LightPicture picture_of(const View& view, double behind) {
    MergedPhotographs merged{ImageF(view.width, view.height, 3),
                             ImageF(view.width, view.height, 3, 1)};
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            double sum = 0.0;
            for (int s = 0; s < 16; ++s) {
                const auto direction =
                    mirrored(view, {x + (s % 4 + 0.5) / 4, y + (s / 4 + 0.5) / 4});
                sum += direction ? 1.0 + 0.3 * std::sin(5.0 * direction->y) : behind;
            }
            for (int c = 0; c < 3; ++c) {
                merged.counts.at(x, y, c) = static_cast<float>(sum / 16.0);
            }
        }
    }
    return light_of(merged, glm::dvec3(1e9));
}

TEST(BallOutline, IsFoundBeforeBrightAndDark) {
    const View view = camera();
    const auto truth = project(view, kBall.centre_mm);
    for (const double behind : {0.2, 3.0}) {
        const LightPicture picture = picture_of(view, behind);
        for (const glm::dvec3 off : {glm::dvec3(0.0), glm::dvec3(2.0, -1.0, 0.0)}) {
            const OutlineFit fit =
                find_ball_outline(view, picture, {kBall.centre_mm + off, kBall.diameter_mm});
            EXPECT_LT(glm::distance(*project(view, fit.sphere.centre_mm), *truth), 0.1);
            EXPECT_NEAR(hidden_behind_rad(view, fit.sphere) / hidden_behind_rad(view, kBall),
                        1.0,
                        0.3 / 130.0);
            EXPECT_LT(fit.rms_px, 0.3);
            EXPECT_GT(fit.seen_fraction, 0.9);
        }
    }
    // A picture without a ball.
    LightPicture even = picture_of(view, 1.0);
    std::fill(even.light.values.begin(), even.light.values.end(), 1.0f);
    EXPECT_NE(
        message_of([&] { find_ball_outline(view, even, kBall); }).find("outline does not show"),
        std::string::npos);
}

}  // namespace
}  // namespace livery
