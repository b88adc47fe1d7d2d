// Profiles that are written down, seen by a slanting camera, and measured again.

#include "calibration/spot/spot_profile.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/error.h"

namespace livery {
namespace {

constexpr double kSigma_mm = 0.25, kAlbedo = 0.9;
const SamplePlane kTilted{{5.0, -3.0, 40.0}, {0.0, 0.6, 0.8}};
constexpr double kClippedLight = std::numeric_limits<double>::quiet_NaN();

/// Some 35 degrees off the plane's normal, with a lens that is distorted.
View slanting_view() {
    View view = look_at({250.0, 300.0, 560.0}, kTilted.point_mm, 0.06, 400, 320);
    view.distortion = {-0.4, 0.1, 0.001, 0.0, 0.0};
    return view;
}

/// The place off the plane's point, on its own axes; a pixel's middle.
glm::dvec2 off_point(const Ray& ray) {
    const glm::dvec3& n = kTilted.normal;
    const glm::dvec3 at =
        ray.origin +
        glm::dot(kTilted.point_mm - ray.origin, n) / glm::dot(ray.direction, n) * ray.direction -
        kTilted.point_mm;
    const glm::dvec3 across = axis_across(kTilted);
    return {glm::dot(at, across), glm::dot(at, glm::cross(n, across))};
}

/// Of the distance from `centre`, and the cosine of the line of sight.
using LightAt = std::function<double(double r_mm, double cosine)>;

ImageF picture(const View& view, const glm::dvec2& centre, const LightAt& light) {
    ImageF image(view.width, view.height, 3);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const Ray ray = ray_through(view, {x + 0.5, y + 0.5});
            const double value = light(glm::distance(off_point(ray), centre),
                                       -glm::dot(ray.direction, kTilted.normal));
            for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(value);
        }
    }
    return image;
}

double spot_irradiance(double r_mm) {
    return 1000.0 * std::exp(-0.5 * r_mm * r_mm / (kSigma_mm * kSigma_mm));
}
double white_light(double r_mm, double) {
    return kAlbedo / std::numbers::pi * spot_irradiance(r_mm);
}
/// R_d, per mm^2: half of it within 2 ln 2 mm or so.
double true_rd(double r_mm) { return 0.06 * std::exp(-r_mm / 1.6); }
/// Share that glass lets through at an angle, by Snell's and Fresnel's laws with angles.
double through_glass(double cosine) {
    if (cosine > 0.999999) return 0.96;
    const double a = std::acos(cosine), b = std::asin(std::sin(a) / 1.5);
    const double s = std::sin(a - b) / std::sin(a + b), t = std::tan(a - b) / std::tan(a + b);
    return 1.0 - 0.5 * (s * s + t * t);
}

std::string refusal_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const Refused& refused) {
        return refused.what();
    }
    return "not refused";
}

class SpotProfileTest : public ::testing::Test {
  protected:
    const View view_ = slanting_view();
    const PlanePixels pixels_ = plane_pixels(view_, kTilted);
    const glm::dvec2 centre_{0.8, -0.5};
    const ImageF white_ = picture(view_, centre_, white_light);
};

TEST_F(SpotProfileTest, PixelsLieInThePlaneWithTheirAreas) {
    double area = 0.0;
    for (int y = 100; y < 200; ++y) {
        for (int x = 100; x < 200; ++x) {
            const glm::dvec2 at = off_point(ray_through(view_, {x + 0.5, y + 0.5}));
            EXPECT_NEAR(pixels_.at(x, y, 0), at.x, 1e-4);
            EXPECT_NEAR(pixels_.at(x, y, 1), at.y, 1e-4);
            area += static_cast<double>(pixels_.at(x, y, 2));
        }
    }
    // The same square as a polygon of its edge.
    double polygon = 0.0;
    glm::dvec2 before = off_point(ray_through(view_, {100.0, 100.0}));
    const auto go_to = [&](double x, double y) {
        const glm::dvec2 now = off_point(ray_through(view_, {x, y}));
        polygon += 0.5 * (before.x * now.y - before.y * now.x);
        before = now;
    };
    for (int k = 1; k <= 100; ++k) go_to(100.0 + k, 100.0);
    for (int k = 1; k <= 100; ++k) go_to(200.0, 100.0 + k);
    for (int k = 1; k <= 100; ++k) go_to(200.0 - k, 200.0);
    for (int k = 1; k <= 100; ++k) go_to(100.0, 200.0 - k);
    EXPECT_NEAR(area / std::abs(polygon), 1.0, 1e-4);
}

TEST_F(SpotProfileTest, TheSpotIsWhereItWasThrown) {
    const SpotOfLight spot = spot_of_light(pixels_, white_);
    EXPECT_NEAR(spot.centre_mm.x, centre_.x, 0.003);
    EXPECT_NEAR(spot.centre_mm.y, centre_.y, 0.003);
    // A Gaussian holds half within sigma times the root of 2 ln 2.
    const double half_mm = kSigma_mm * std::sqrt(2.0 * std::log(2.0));
    const double power =
        kAlbedo / std::numbers::pi * 1000.0 * 2.0 * std::numbers::pi * kSigma_mm * kSigma_mm;
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(spot.diameter_mm[c] / (2.0 * half_mm), 1.0, 0.03);
        EXPECT_NEAR(spot.power[c] / power, 1.0, 0.002);
    }
}

TEST_F(SpotProfileTest, AProfileComesBackInAbsoluteUnits) {
    // Exitance for what enters: radiance below spreads as Lambert's, and .9082 of it passes glass
    // in the mean (1 - .0918, the external diffuse reflectance of index 1.5), .96 along the normal.
    const double power = 1000.0 * 2.0 * std::numbers::pi * kSigma_mm * kSigma_mm;
    const double incidence = 0.2;
    const double enters = power * through_glass(std::cos(incidence));
    const ImageF sample = picture(view_, centre_, [&](double r_mm, double cosine) {
        return true_rd(r_mm) * enters / std::numbers::pi * through_glass(cosine) / 0.9082;
    });
    const SpotProfile profile = spot_profile(pixels_,
                                             sample,
                                             spot_of_light(pixels_, white_),
                                             1,
                                             {1.5, std::cos(incidence), glm::dvec3(kAlbedo)});
    ASSERT_GT(profile.samples.size(), 10u);
    for (const ProfileSample& one : profile.samples) {
        // Six decays out a ring's mean is no longer its middle's value.
        if (one.r_mm > 9.6) continue;
        EXPECT_NEAR(one.rd / true_rd(one.r_mm), 1.0, 0.01) << one.r_mm;
    }
    const double reach = profile.samples.back().r_mm;
    EXPECT_GT(reach, 5.0);
    EXPECT_NEAR(profile.total_reflectance, 0.06 * 2.0 * std::numbers::pi * 1.6 * 1.6, 0.05);
    // Half of x exp(-x) lies within 1.678.
    EXPECT_NEAR(profile.half_energy_radius_mm, 1.6 * 1.678, 0.2);
}

TEST_F(SpotProfileTest, MeansOverDirectionsArePublishedOnes) {
    EXPECT_NEAR(mean_transmittance(1.5), 0.9082, 2e-4);
    EXPECT_NEAR(mean_transmittance(1.0), 1.0, 1e-9);
    // Without a boundary Lambert's mean cosine is two thirds.
    EXPECT_NEAR(mean_view_rad(1.0), std::acos(2.0 / 3.0), 1e-9);
}

TEST_F(SpotProfileTest, WhatIsNotASpotIsRefused) {
    const auto white_refused = [&](const ImageF& white) {
        return refusal_of([&] { spot_of_light(pixels_, white); });
    };
    EXPECT_NE(
        white_refused(picture(view_, centre_, [](double, double) { return 0.0; })).find("no spot"),
        std::string::npos);
    EXPECT_NE(white_refused(picture(view_, centre_, [](double, double) { return kClippedLight; }))
                  .find("every pixel of the white reference is saturated"),
              std::string::npos);
    EXPECT_NE(white_refused(picture(view_,
                                    centre_,
                                    [](double r, double) {
                                        return r < 0.2 ? kClippedLight : white_light(r, 1.0);
                                    }))
                  .find("is saturated in every photograph: pixel"),
              std::string::npos);
    const glm::dvec2 border(pixels_.at(200, 4, 0), pixels_.at(200, 4, 1));
    EXPECT_NE(white_refused(picture(view_, border, white_light)).find("not wholly in the picture"),
              std::string::npos);
    EXPECT_NE(
        white_refused(picture(view_,
                              centre_,
                              [](double r, double) { return 100.0 * std::exp(-r * r / 18.0); }))
            .find("not wholly in the picture"),
        std::string::npos);
}

TEST_F(SpotProfileTest, SamplesThatDoNotTellAreRefused) {
    const SpotOfLight spot = spot_of_light(pixels_, white_);
    const auto refused = [&](const LightAt& light) {
        const ImageF sample = picture(view_, centre_, light);
        return refusal_of([&] {
            spot_profile(pixels_, sample, spot, 1, {1.5, 1.0, glm::dvec3(kAlbedo)});
        });
    };
    EXPECT_NE(refused([](double, double) { return 0.0; }).find("only 0 rings"), std::string::npos);
    EXPECT_NE(refused([](double r, double) {
                  return r < 0.3 ? kClippedLight : true_rd(r);
              }).find("the sample is saturated in every photograph where the spot is"),
              std::string::npos);
    EXPECT_NE(
        refused([](double r, double) { return std::exp(-r / 0.5); }).find("more than a third"),
        std::string::npos);
    // Rings that are clipped are left out, and the profile goes on beyond.
    const ImageF half = picture(view_, centre_, [](double r, double) {
        return r > 2.0 && r < 3.0 ? kClippedLight : true_rd(r);
    });
    const SpotProfile profile =
        spot_profile(pixels_, half, spot, 1, {1.5, 1.0, glm::dvec3(kAlbedo)});
    EXPECT_GE(profile.clipped_rings, 3u);
    EXPECT_GT(profile.samples.back().r_mm, 4.0);
}

}  // namespace
}  // namespace livery
