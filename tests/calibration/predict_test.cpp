#include "calibration/predict.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/random.h"
#include "core/statistics.h"
#include "support/messages.h"

namespace livery {
namespace {

constexpr int kProjectorWidth = 200, kProjectorHeight = 140;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const glm::dvec3 kPeak(0.9, 1.1, 0.7);  ///< span per unit of geometry
const glm::dvec3 kAmbient(0.011, 0.013, 0.017);

/// A surface z(x, y) in a projector's frame, in metres, lit by a lens at the origin.
struct Surface {
    const char* name;
    std::function<double(double x, double y)> depth;
};

const Surface kSurfaces[] = {
    {"plane across", [](double, double) { return 1.0; }},
    {"tilted plane", [](double x, double y) { return 1.0 + 0.9 * x - 0.4 * y; }},
    {"bumps",
     [](double x, double y) { return 1.0 + 0.02 * std::sin(23.0 * x) * std::cos(19.0 * y); }},
    {"cylinder", [](double x, double) { return 1.3 - std::sqrt(0.35 * 0.35 - x * x); }},
};

glm::dvec3 point_of(const Surface& surface, double u, double v) {
    const double x = (u - 0.5 * kProjectorWidth) / 400.0, y = (v - 0.5 * kProjectorHeight) / 400.0;
    double z = 1.0;
    for (int k = 0; k < 60; ++k) z = surface.depth(x * z, y * z);
    return {x * z, y * z, z};
}

/// cos(theta) / distance^2, by finite differences of the surface.
ImageF geometry_of(const Surface& surface) {
    ImageF geometry(kProjectorWidth, kProjectorHeight, 1);
    for (int y = 0; y < kProjectorHeight; ++y) {
        for (int x = 0; x < kProjectorWidth; ++x) {
            const double u = x + 0.5, v = y + 0.5, step = 1e-3;
            const glm::dvec3 p = point_of(surface, u, v);
            const glm::dvec3 across = point_of(surface, u + step, v) - p;
            const glm::dvec3 down = point_of(surface, u, v + step) - p;
            const glm::dvec3 normal = glm::normalize(glm::cross(across, down));
            geometry.at(x, y, 0) =
                static_cast<float>(std::abs(glm::dot(normal, p)) / std::pow(glm::dot(p, p), 1.5));
        }
    }
    return geometry;
}

/// 6% less light in the corners: an ordinary lens has 20% over a picture several times this wide.
double vignetting(int x, int y) {
    const double u = (x - 0.5 * kProjectorWidth) / kProjectorWidth,
                 v = (y - 0.5 * kProjectorHeight) / kProjectorWidth;
    return 1.0 - 0.16 * (u * u + v * v);
}

ColourCalibration measured_everywhere(const ImageF& geometry, std::uint64_t seed) {
    Random random(seed);
    ColourCalibration c;
    c.width = kProjectorWidth;
    c.height = kProjectorHeight;
    c.mixing_spread = 1.1;
    c.unmixing = ImageF(kProjectorWidth, kProjectorHeight, 9);
    c.dark = ImageF(kProjectorWidth, kProjectorHeight, 3);
    c.span = ImageF(kProjectorWidth, kProjectorHeight, 3);
    c.camera_px = ImageF(kProjectorWidth, kProjectorHeight, 2, 10.0f);
    c.status = Image8(
        kProjectorWidth, kProjectorHeight, 1, static_cast<std::uint8_t>(PixelStatus::measured));
    const float unmixing[9] = {1.2f, -0.2f, 0.05f, -0.1f, 1.3f, -0.15f, 0.0f, -0.25f, 1.1f};
    for (int y = 0; y < kProjectorHeight; ++y) {
        for (int x = 0; x < kProjectorWidth; ++x) {
            const double light = static_cast<double>(geometry.at(x, y)) * vignetting(x, y);
            for (int k = 0; k < 9; ++k) c.unmixing.at(x, y, k) = unmixing[k];
            for (int k = 0; k < 3; ++k) {
                const double noise = 1.0 + 0.005 * random.normal();
                c.span.at(x, y, k) = static_cast<float>(light * kPeak[k] * noise);
                c.dark.at(x, y, k) = static_cast<float>(kAmbient[k] * noise);
            }
        }
    }
    return c;
}

void hide(ColourCalibration& c, int x, int y, PixelStatus status) {
    c.status.at(x, y) = static_cast<std::uint8_t>(status);
    for (int k = 0; k < 9; ++k) c.unmixing.at(x, y, k) = 0.0f;
    for (int k = 0; k < 3; ++k) c.dark.at(x, y, k) = c.span.at(x, y, k) = 0.0f;
    for (int k = 0; k < 2; ++k) c.camera_px.at(x, y, k) = kNan;
}

PixelStatus status_at(const ColourCalibration& c, int x, int y) {
    return static_cast<PixelStatus>(c.status.at(x, y));
}

/// A disc of 18 px as four kinds of hidden pixels.
std::vector<glm::ivec2> hide_disc(ColourCalibration& c) {
    constexpr PixelStatus kinds[] = {
        PixelStatus::unlit, PixelStatus::not_decoded, PixelStatus::edge, PixelStatus::too_dark};
    std::vector<glm::ivec2> hidden;
    for (int y = 0; y < kProjectorHeight; ++y) {
        for (int x = 0; x < kProjectorWidth; ++x) {
            if ((x - 130) * (x - 130) + (y - 60) * (y - 60) > 18 * 18) continue;
            c.status.at(x, y) = static_cast<std::uint8_t>(kinds[hidden.size() % 4]);
            for (int k = 0; k < 9; ++k) c.unmixing.at(x, y, k) = 0.0f;
            for (int k = 0; k < 3; ++k) c.dark.at(x, y, k) = c.span.at(x, y, k) = 0.0f;
            hidden.emplace_back(x, y);
        }
    }
    return hidden;
}

TEST(PredictHidden, FindsTheLightOfAHiddenRegion) {
    for (const Surface& surface : kSurfaces) {
        const ImageF geometry = geometry_of(surface);
        ColourCalibration c = measured_everywhere(geometry, 11);
        const auto hidden = hide_disc(c);
        const ColourCalibration p = predict_hidden(c, geometry);

        EXPECT_TRUE(p.warnings.empty()) << p.warnings.front();
        EXPECT_NEAR(p.predicted_fraction,
                    static_cast<double>(hidden.size()) / (kProjectorWidth * kProjectorHeight),
                    1e-12);
        std::vector<double> errors;
        for (const glm::ivec2 at : hidden) {
            ASSERT_EQ(status_at(p, at.x, at.y), PixelStatus::predicted) << surface.name;
            EXPECT_TRUE(std::isnan(p.camera_px.at(at.x, at.y, 0)));
            EXPECT_NEAR(p.unmixing.at(at.x, at.y, 5), -0.15f, 1e-6f);
            for (int k = 0; k < 3; ++k) {
                const double truth = static_cast<double>(geometry.at(at.x, at.y)) *
                                     vignetting(at.x, at.y) * kPeak[k];
                errors.push_back(
                    std::abs(static_cast<double>(p.span.at(at.x, at.y, k)) / truth - 1.0));
                // A median of 64 or more with 0.5% scatter: 0.1% each, five of these
                EXPECT_NEAR(
                    static_cast<double>(p.dark.at(at.x, at.y, k)) / kAmbient[k], 1.0, 0.005);
            }
        }
        // Vignetting changes by at most 0.1% a pixel, and a window at the disc's rim is centred
        // some 8 px outside it: 0.8%, and noise as above.
        EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.012) << surface.name;
        EXPECT_LT(median(errors), 0.004) << surface.name;
        // Noise of each measured pixel, 0.5%: the mean of three has its median at 0.38%.
        EXPECT_NEAR(p.prediction_error_median, 0.0038, 0.0012) << surface.name;
        EXPECT_LT(p.prediction_error_p95, 0.015) << surface.name;
    }
}

TEST(PredictHidden, LeavesMeasuredPixelsAsTheyAre) {
    const ImageF geometry = geometry_of(kSurfaces[2]);
    ColourCalibration c = measured_everywhere(geometry, 12);
    hide(c, 40, 40, PixelStatus::edge);
    const ColourCalibration p = predict_hidden(c, geometry);
    for (int y = 0; y < kProjectorHeight; ++y) {
        for (int x = 0; x < kProjectorWidth; ++x) {
            if (x == 40 && y == 40) continue;
            ASSERT_EQ(p.span.at(x, y, 1), c.span.at(x, y, 1));
            ASSERT_EQ(p.dark.at(x, y, 1), c.dark.at(x, y, 1));
            ASSERT_EQ(p.status.at(x, y), c.status.at(x, y));
        }
    }
}

TEST(PredictHidden, WhatTheCameraRejectedByItsColourStaysRejected) {
    const ImageF geometry = geometry_of(kSurfaces[0]);
    for (const PixelStatus status :
         {PixelStatus::saturated, PixelStatus::ill_conditioned, PixelStatus::one_channel}) {
        ColourCalibration c = measured_everywhere(geometry, 13);
        hide(c, 40, 40, status);
        EXPECT_EQ(status_at(predict_hidden(c, geometry), 40, 40), status);
    }
}

TEST(PredictHidden, GrazingAndUncoveredPixelsStayBlack) {
    const ImageF whole = geometry_of(kSurfaces[0]);
    ColourCalibration c = measured_everywhere(whole, 14);
    ImageF geometry = whole;
    const float brightest = *std::max_element(whole.values.begin(), whole.values.end());
    const auto share = [&](int x, double factor) {
        hide(c, x, 40, PixelStatus::not_decoded);
        geometry.at(x, 40) = static_cast<float>(factor * static_cast<double>(brightest));
    };
    share(30, 0.0);
    share(50, 0.9 * kGrazingShare);
    share(70, 1.1 * kGrazingShare);
    const ColourCalibration p = predict_hidden(c, geometry);
    EXPECT_EQ(status_at(p, 30, 40), PixelStatus::not_decoded);
    EXPECT_EQ(status_at(p, 50, 40), PixelStatus::not_decoded);
    EXPECT_EQ(p.span.at(50, 40, 0), 0.0f);
    EXPECT_EQ(status_at(p, 70, 40), PixelStatus::predicted);
    EXPECT_NEAR(p.span.at(70, 40, 0),
                1.1 * kGrazingShare * static_cast<double>(brightest) * vignetting(70, 40) * kPeak.x,
                0.01 * kGrazingShare);
}

TEST(PredictHidden, NothingIsPredictedOnASurfaceThatIsNotNeutral) {
    const ImageF geometry = geometry_of(kSurfaces[1]);
    ColourCalibration c = measured_everywhere(geometry, 15);
    hide(c, 100, 60, PixelStatus::edge);
    // A fifth of it painted: another matrix there, far over its noise.
    for (int y = 0; y < kProjectorHeight; ++y) {
        for (int x = 0; x < kProjectorWidth / 5; ++x) c.unmixing.at(x, y, 1) -= 0.2f;
    }
    c.mixing_spread = 40.0;
    const ColourCalibration p = predict_hidden(c, geometry);
    EXPECT_EQ(status_at(p, 100, 60), PixelStatus::edge);
    EXPECT_EQ(p.predicted_fraction, 0.0);
    ASSERT_EQ(p.warnings.size(), 1u);
    EXPECT_HAS(p.warnings[0], "hidden from the camera are not predicted");
    EXPECT_HAS(p.warnings[0], "the mock-up is not neutral");
    // A spread over a tiny noise alone is no paint.
    ColourCalibration clean = measured_everywhere(geometry, 15);
    hide(clean, 100, 60, PixelStatus::edge);
    clean.mixing_spread = 40.0;
    EXPECT_EQ(status_at(predict_hidden(clean, geometry), 100, 60), PixelStatus::predicted);
}

TEST(PredictHidden, APoseThatDoesNotFitIsNotUsed) {
    const ImageF geometry = geometry_of(kSurfaces[3]);
    ColourCalibration c = measured_everywhere(geometry, 16);
    hide(c, 100, 60, PixelStatus::edge);
    Random random(17);
    ImageF other = geometry;  // of a mesh with relief that the mock-up does not have
    for (float& value : other.values) value *= static_cast<float>(0.6 + 0.8 * random.uniform());
    const ColourCalibration p = predict_hidden(c, other);
    EXPECT_EQ(status_at(p, 100, 60), PixelStatus::edge);
    EXPECT_GT(p.prediction_error_median, kPredictionLimit);
    ASSERT_EQ(p.warnings.size(), 1u);
    EXPECT_HAS(p.warnings[0], "check that pose, lens and mesh");

    const ColourCalibration beside =
        predict_hidden(c, ImageF(kProjectorWidth, kProjectorHeight, 1));
    ASSERT_EQ(beside.warnings.size(), 1u);
    EXPECT_HAS(beside.warnings[0], "only 0 measured pixels lie on the mesh");
}

TEST(PredictHidden, RefusesGeometryThatMakesNoSense) {
    const ImageF geometry = geometry_of(kSurfaces[0]);
    const ColourCalibration c = measured_everywhere(geometry, 18);
    const auto message = [&](const ImageF& wrong) {
        return message_of<std::invalid_argument>([&] { predict_hidden(c, wrong); });
    };
    EXPECT_HAS(message(ImageF(kProjectorWidth, kProjectorHeight - 1, 1)),
               "geometry of 200x139 with 1 channels");
    EXPECT_HAS(message(ImageF(kProjectorWidth, kProjectorHeight, 3)),
               "geometry of 200x140 with 3 channels");
    ImageF wrong = geometry;
    wrong.at(3, 3) = -1.0f;
    EXPECT_HAS(message(wrong), "geometry of -1");
    wrong.at(3, 3) = kNan;
    EXPECT_HAS(message(wrong), "geometry of");
}

}  // namespace
}  // namespace livery
