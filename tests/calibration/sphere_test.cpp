// A sphere's outline and reflectance, from pictures made here by formulas of their own.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/sphere/sphere_outline.h"
#include "calibration/sphere/sphere_reflectance.h"
#include "core/random.h"
#include "core/worst_error.h"
#include "support/message_of.h"

namespace livery {
namespace {

const Sphere kSphere{{4.0, -3.0, 12.0}, 50.0};

View camera(int size_px) {
    View view = look_at({30.0, 20.0, 900.0}, {0.0, 0.0, 0.0}, 0.09, size_px, size_px);
    view.distortion = {-0.5, 0.0, 0.0, 0.0, 0.0};
    return view;
}

/// Value of a paint, per steradian, from the half vector's angle to the normal and the light's to
/// the half vector.
using Paint = std::function<double(double theta_h, double theta_d)>;

double chalk(double, double) { return 0.3 / std::numbers::pi; }
/// Brighter the more grazing.
double sheen(double, double theta_d) { return 0.05 + 0.5 * std::pow(1.0 - std::cos(theta_d), 2.0); }
double satin(double theta_h, double) {
    return 0.1 / std::numbers::pi + 0.8 * std::exp(-theta_h * theta_h / 0.08);
}

/// What a lamp of strength 1e9 at `light_mm` lets the camera see a second.
LitSphere photographed(const View& view, const glm::dvec3& light_mm, const Paint& paint) {
    LitSphere lit;
    lit.light_mm = light_mm;
    lit.picture.counts = ImageF(view.width, view.height, 3);
    lit.picture.seconds = ImageF(view.width, view.height, 3, 2.0f);
    const glm::dvec3 eye = centre_in_world(view);
    constexpr int kSide = 4;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            double sum = 0.0;
            for (int s = 0; s < kSide * kSide; ++s) {
                const glm::dvec3 d =
                    ray_through(view,
                                {x + (s % kSide + 0.5) / kSide, y + (s / kSide + 0.5) / kSide})
                        .direction;
                const glm::dvec3 from = eye - kSphere.centre_mm;
                const double b = glm::dot(d, from);
                const double c = glm::dot(from, from) - std::pow(0.5 * kSphere.diameter_mm, 2);
                if (b * b < c) continue;
                const glm::dvec3 p = eye + (-b - std::sqrt(b * b - c)) * d;
                const glm::dvec3 n = glm::normalize(p - kSphere.centre_mm);
                const double distance = glm::length(light_mm - p);
                const glm::dvec3 l = (light_mm - p) / distance;
                const double cosine = glm::dot(n, l);
                if (cosine <= 0.0) continue;
                const glm::dvec3 h = glm::normalize(l - d);
                const double theta_h = std::acos(std::min(glm::dot(n, h), 1.0));
                const double theta_d = std::acos(std::min(glm::dot(l, h), 1.0));
                sum += 1e9 * paint(theta_h, theta_d) * cosine / (distance * distance);
            }
            for (int c = 0; c < 3; ++c) {
                lit.picture.counts.at(x, y, c) = static_cast<float>(2.0 * sum / (kSide * kSide));
            }
        }
    }
    return lit;
}

std::vector<LitSphere> photographed_all(const View& view, const Paint& paint) {
    std::vector<LitSphere> lit;
    for (int k = 0; k < 14; ++k) {
        const double angle = std::numbers::pi / 180.0 * (5.0 + 11.0 * k), turn = 2.4 * k;
        lit.push_back(photographed(view,
                                   500.0 * glm::dvec3(std::sin(angle) * std::cos(turn),
                                                      std::sin(angle) * std::sin(turn),
                                                      std::cos(angle)),
                                   paint));
    }
    return lit;
}

LampResponse exact_lamp() { return {glm::dvec3(1e9), 0.0}; }

TEST(SphereOutline, IsFoundToSomeHundredthsOfAPixel) {
    const View view = camera(240);
    const auto lit = photographed_all(view, satin);
    const double mm_per_px = 900.0 / view.focal_px.x;
    for (const Sphere& start : {kSphere,
                                Sphere{{5.0, -2.0, 12.0}, 51.0},
                                Sphere{{0.0, 0.0, 12.0}, 46.0},
                                Sphere{{6.0, -6.0, 12.0}, 55.0}}) {
        const OutlineFit fit = fit_outline(view, start, lit);
        EXPECT_LT(glm::length(fit.sphere.centre_mm - kSphere.centre_mm), 0.1);
        EXPECT_NEAR(fit.sphere.diameter_mm, kSphere.diameter_mm, 0.1 * mm_per_px);
        EXPECT_LT(fit.rms_px, 0.1);
        EXPECT_GT(fit.seen_fraction, 0.95);
    }
    // Nearer and smaller has the same outline: the distance is kept.
    const OutlineFit nearer = fit_outline(view, {{4.0, -3.0, 62.0}, 50.0}, lit);
    EXPECT_NEAR(nearer.sphere.diameter_mm / kSphere.diameter_mm, 838.0 / 888.0, 0.003);
}

TEST(SphereOutline, SaysWhatIsInTheWay) {
    const View view = camera(160);
    std::vector<LitSphere> lit = {photographed(view, {0.0, 200.0, 450.0}, chalk)};
    // One lamp from above: the lower half of the outline is dark.
    lit[0].light_mm = {0.0, 500.0, 0.0};
    EXPECT_NE(message_of([&] { fit_outline(view, kSphere, lit); }).find("outline does not show"),
              std::string::npos);
    // Noise, and no sphere.
    lit = photographed_all(view, chalk);
    Random random(3);
    for (LitSphere& one : lit) {
        for (float& value : one.picture.counts.values) value = random.uniform_float();
    }
    EXPECT_THROW(fit_outline(view, kSphere, lit), Refused);
    EXPECT_THROW(fit_outline(view, kSphere, {}), std::invalid_argument);
    EXPECT_THROW(fit_outline(camera(100), kSphere, lit), std::invalid_argument);
}

TEST(SphereOutline, BoxesAreWhereTheSphereIs) {
    const View view = camera(240);
    const auto box = outline_box(view, kSphere);
    ASSERT_TRUE(box);
    const auto middle = project(view, kSphere.centre_mm);
    EXPECT_NEAR(0.5 * (box->left + box->right), middle->x, 0.5);
    EXPECT_NEAR(0.5 * (box->top + box->bottom), middle->y, 0.5);
    EXPECT_NEAR(box->right - box->left, 50.0 * view.focal_px.x / 888.0, 2.0);
    EXPECT_FALSE(outline_box(view, {{0.0, 0.0, 950.0}, 50.0}));
    EXPECT_FALSE(outline_box(view, {{0.0, 0.0, 890.0}, 50.0}));
}

TEST(SphereReflectance, ALampsStrengthIsTheWhiteSpheres) {
    const View view = camera(240);
    const LitSphere white = photographed(
        view, {250.0, 0.0, 450.0}, [](double, double) { return 0.9 / std::numbers::pi; });
    const LampResponse lamp = lamp_response(view, kSphere, white, glm::dvec3(0.9));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(lamp.units[c], 1e9, 3e6);
    EXPECT_LT(lamp.rms, 0.01);
    const LampResponse coloured = lamp_response(view, kSphere, white, {0.9, 0.45, 0.3});
    EXPECT_NEAR(coloured.units.y / coloured.units.x, 2.0, 1e-9);
    EXPECT_NEAR(coloured.units.z / coloured.units.x, 3.0, 1e-9);
    // Another lamp's place shows.
    LitSphere wrong = white;
    wrong.light_mm = {-250.0, 0.0, 450.0};
    EXPECT_GT(lamp_response(view, kSphere, wrong, glm::dvec3(0.9)).rms, 0.2);

    LitSphere behind = white;
    behind.light_mm = {0.0, 100.0, -500.0};
    EXPECT_NE(message_of([&] {
                  lamp_response(view, kSphere, behind, glm::dvec3(0.9));
              }).find("stands near the camera"),
              std::string::npos);
    LitSphere blown = white;
    std::fill(blown.picture.seconds.values.begin(), blown.picture.seconds.values.end(), 0.0f);
    EXPECT_THROW(lamp_response(view, kSphere, blown, glm::dvec3(0.9)), Refused);
}

TEST(SphereReflectance, GivesThePaintBack) {
    const View view = camera(240);
    for (const Paint& paint : {Paint(chalk), Paint(satin), Paint(sheen)}) {
        const auto lit = photographed_all(view, paint);
        const std::vector<LampResponse> lamps(lit.size(), exact_lamp());
        const SphereReflectance measured = sphere_reflectance(view, kSphere, lit, lamps);
        ASSERT_EQ(measured.pairs.size(), measured.values.size());
        ASSERT_GT(measured.pairs.size(), 5000u);
        std::vector<double> errors;
        for (std::size_t k = 0; k < measured.pairs.size(); ++k) {
            const auto& [wi, wo] = measured.pairs[k];
            EXPECT_NEAR(glm::length(wi), 1.0, 1e-9);
            EXPECT_NEAR(glm::length(wo), 1.0, 1e-9);
            const glm::dvec3 h = glm::normalize(wi + wo);
            const double truth =
                paint(std::acos(std::min(h.z, 1.0)), std::acos(std::min(glm::dot(wi, h), 1.0)));
            errors.push_back(worst_if_nan(std::abs(measured.values[k].y / truth - 1.0)));
        }
        std::sort(errors.begin(), errors.end());
        EXPECT_LT(errors[errors.size() / 2], 0.003);
        EXPECT_LT(errors[errors.size() * 9 / 10], 0.02);
        EXPECT_LT(measured.residual_median, 0.01);
        // 14 lamps, 11 degrees apart, leave gaps.
        EXPECT_GT(measured.coverage, 0.5);
        EXPECT_LT(measured.coverage, 0.8);
        EXPECT_EQ(measured.saturated, 0u);
    }
}

TEST(SphereReflectance, TakesVeilingLightOff) {
    const View view = camera(240);
    auto lit = photographed_all(view, chalk);
    const std::vector<LampResponse> lamps(lit.size(), exact_lamp());
    // A fifth of what a lit pixel has, everywhere.
    for (LitSphere& one : lit) {
        for (float& value : one.picture.counts.values)
            value += 2.0f * 1e9f * 0.3f / 3.14f / 250000.0f * 0.2f;
    }
    const SphereReflectance measured = sphere_reflectance(view, kSphere, lit, lamps);
    EXPECT_GT(measured.dark, 0u);
    std::vector<double> values;
    for (const glm::dvec3& value : measured.values) values.push_back(worst_if_nan(value.y));
    std::sort(values.begin(), values.end());
    EXPECT_NEAR(values[values.size() / 2] / (0.3 / std::numbers::pi), 1.0, 0.005);
    EXPECT_NEAR(values[values.size() / 20] / (0.3 / std::numbers::pi), 1.0, 0.03);
}

TEST(SphereReflectance, ResidualsTellOfAWrongLamp) {
    const View view = camera(240);
    auto lit = photographed_all(view, satin);
    const std::vector<LampResponse> lamps(lit.size(), exact_lamp());
    const double right = sphere_reflectance(view, kSphere, lit, lamps).residual;
    lit[5].light_mm += glm::dvec3(40.0, -40.0, 0.0);
    lit[8].light_mm += glm::dvec3(-40.0, 40.0, 0.0);
    EXPECT_GT(sphere_reflectance(view, kSphere, lit, lamps).residual, 2.0 * right);
}

TEST(SphereReflectance, SaysWhyThereIsNothing) {
    const View view = camera(160);
    std::vector<LitSphere> lit = {photographed(view, {100.0, 0.0, 450.0}, chalk)};
    const std::vector<LampResponse> lamps = {exact_lamp()};
    EXPECT_NO_THROW(check_lit(view, kSphere, lit));
    LitSphere behind = lit[0];
    behind.light_mm = {4.0, -3.0, -500.0};
    EXPECT_NE(message_of([&] {
                  check_lit(view, kSphere, std::vector{behind});
              }).find("no light shines on the side"),
              std::string::npos);
    LitSphere blown = lit[0];
    std::fill(blown.picture.seconds.values.begin(), blown.picture.seconds.values.end(), 0.0f);
    EXPECT_NE(message_of([&] {
                  check_lit(view, kSphere, std::vector{blown});
              }).find("saturated in every photograph"),
              std::string::npos);
    LitSphere even = lit[0];
    std::fill(even.picture.counts.values.begin(), even.picture.counts.values.end(), 5.0f);
    EXPECT_NE(message_of([&] {
                  sphere_reflectance(view, kSphere, std::vector{even}, lamps);
              }).find("nowhere clearly brighter than the cloth"),
              std::string::npos);
    // A picture that the sphere fills has no cloth.
    const View close = cropped(view, 60, 60, 40, 40);
    const std::vector<LitSphere> cut = {photographed(close, {100.0, 0.0, 450.0}, chalk)};
    EXPECT_NE(
        message_of([&] { sphere_reflectance(close, kSphere, cut, lamps); }).find("no dark cloth"),
        std::string::npos);
    EXPECT_THROW(sphere_reflectance(view, kSphere, lit, {}), std::invalid_argument);
    EXPECT_THROW(sphere_reflectance(view, kSphere, lit, lamps, {0, 1, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace livery
