#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "calibration/correspondence/fringe_decode.h"
#include "calibration/correspondence/patterns.h"
#include "calibration/support/fringe_scene.h"
#include "calibration/support/messages.h"
#include "core/error.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using testing::FringeScene;

constexpr auto kBoth = PlaceCode::gray_and_phase;

FineCode decode(FringeScene& scene, const std::vector<RoledPhotograph>& photographs) {
    return refine_by_fringes(
        photographs,
        decode_gray_code(photographs, scene.projector_width, scene.projector_height),
        scene.projector_width,
        scene.projector_height);
}
FineCode decode(FringeScene& scene) { return decode(scene, scene.photographs(kBoth)); }

/// Errors of the pixels whose place is known finely, away from the projector's border, where blur
/// meets an end of the fringes.
struct PlaceErrors {
    double rms = 0.0, largest = 0.0;
    double rms_of_sigma = 0.0;  ///< of error / standard error
    int fine = 0, decoded = 0, all = 0;
};
PlaceErrors errors_of(const FringeScene& scene,
                      const CameraToProjector& places,
                      double margin = 6.0) {
    PlaceErrors errors;
    for (int y = 0; y < scene.camera_height; ++y)
        for (int x = 0; x < scene.camera_width; ++x) {
            const glm::dvec2 truth = scene.projector_from_camera({x + 0.5, y + 0.5});
            if (truth.x < margin || truth.y < margin || truth.x > scene.projector_width - margin ||
                truth.y > scene.projector_height - margin)
                continue;
            ++errors.all;
            errors.decoded += places.decoded.at(x, y) != 0;
            for (int axis = 0; axis < 2; ++axis) {
                const float sigma = places.sigma_px.at(x, y, axis);
                if (!(sigma < kWholePixelError)) continue;
                errors.fine += axis == 0;
                const double error = places.projector_px.at(x, y, axis) - truth[axis];
                errors.rms += 0.5 * error * error;
                errors.rms_of_sigma += 0.5 * error * error / (sigma * sigma);
                errors.largest = worse_of(errors.largest, std::abs(error));
            }
        }
    errors.rms = std::sqrt(errors.rms / std::max(errors.fine, 1));
    errors.rms_of_sigma = std::sqrt(errors.rms_of_sigma / std::max(errors.fine, 1));
    return errors;
}

/// Largest error of `shifts` shifts over a period, of a projector whose light is `response`.
template <typename Response>
double largest_error(int shifts, const Response& response) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const auto light = [&](int pixel, int shift) {
        const double turns = (pixel + 0.5) / kFringePeriod_px - static_cast<double>(shift) / shifts;
        const double drive = kFringeDarkest + 0.5 * (kFringeBrightest - kFringeDarkest) *
                                                  (1.0 + std::cos(kTurn * turns));
        return response(std::round(drive) / 255.0);
    };
    double largest = 0.0;
    for (int k = 0; k < 8 * kFringePeriod_px; ++k) {
        const double place = 0.5 + k / 8.0;  // a camera pixel as large as the projector's
        const int pixel = static_cast<int>(place - 0.5);
        const double part = place - 0.5 - pixel;
        double sine = 0.0, cosine = 0.0;
        for (int n = 0; n < shifts; ++n) {
            const double value = (1.0 - part) * light(pixel, n) + part * light(pixel + 1, n);
            sine += value * std::sin(kTurn * n / shifts);
            cosine += value * std::cos(kTurn * n / shifts);
        }
        const double found = std::atan2(sine, cosine) / kTurn * kFringePeriod_px;
        largest = worse_of(largest, std::abs(std::remainder(found - place, kFringePeriod_px)));
    }
    return largest;
}

TEST(Fringes, FiveShiftsAreTheFewestThatNoResponseMovesByATwentiethOfAPixel) {
    struct Case {
        const char* name;
        double (*response)(double);
    };
    const Case cases[] = {
        {"gamma 1.0", [](double d) { return d; }},
        {"gamma 1.4", [](double d) { return std::pow(d, 1.4); }},
        {"gamma 1.8", [](double d) { return std::pow(d, 1.8); }},
        {"gamma 2.2", [](double d) { return std::pow(d, 2.2); }},
        {"gamma 2.6", [](double d) { return std::pow(d, 2.6); }},
        {"sRGB",
         [](double d) { return d <= 0.04045 ? d / 12.92 : std::pow((d + 0.055) / 1.055, 2.4); }},
        {"S-shaped", [](double d) { return std::pow(d, 2.2) * (1.6 - 0.6 * std::pow(d, 2.2)); }},
        {"video levels",
         [](double d) { return std::pow(std::clamp((255 * d - 16) / 219, 0.0, 1.0), 2.2); }},
    };
    double worst_of_four = 0.0;
    for (const Case& one : cases) {
        std::printf("%-12s", one.name);
        for (int shifts = 3; shifts <= 8; ++shifts) {
            const double error = largest_error(shifts, one.response);
            std::printf("  %d: %.3f px", shifts, error);
            if (shifts == 4) worst_of_four = worse_of(worst_of_four, error);
            if (shifts == kFringeShifts) {
                EXPECT_LT(error, 0.05) << one.name;
            }
        }
        std::printf("\n");
    }
    EXPECT_GT(worst_of_four, 0.05);
}

TEST(Fringes, ArcTangentAndRoundingAreThoseOfTheLibrary) {
    for (int k = 0; k < 100000; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / 100000.0;
        const double turns = static_cast<double>(turns_of(
            static_cast<float>(3.0 * std::sin(angle)), static_cast<float>(3.0 * std::cos(angle))));
        ASSERT_LT(std::abs(std::remainder(turns - k / 100000.0, 1.0)), 2e-6) << k;
    }
    for (const float value : {-3.6f, -3.4f, -0.2f, 0.0f, 0.4f, 0.6f, 7.3f})
        EXPECT_EQ(rounded(value), std::round(value));
    EXPECT_EQ(rounded(std::numeric_limits<float>::quiet_NaN()), 4096.0f);
}

TEST(Fringes, PicturesAreTheSinusoidsOfTheirRoles) {
    const auto roles = place_roles(kBoth, 240, 176);
    EXPECT_EQ(roles.size(), geometry_roles(240, 176).size() + 10);
    EXPECT_EQ(place_roles(PlaceCode::gray, 240, 176), geometry_roles(240, 176));
    for (std::size_t k = 0; k < roles.size(); ++k)
        EXPECT_EQ(place_pattern(kBoth, 240, 176, k).role, roles[k]);
    const Pattern row = fringe_pattern(240, 176, 7);
    EXPECT_EQ(row.role, "phase-row-2");
    for (int y = 0; y < 176; ++y)
        for (const int x : {0, 117, 239})
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(row.drive.pixel(x, y)[c], fringe_drive(y + 0.5, 2), 0.5001);
    EXPECT_THROW(fringe_pattern(240, 176, 10), std::invalid_argument);
    EXPECT_THROW(fringe_pattern(1, 176, 0), std::invalid_argument);
}

TEST(FringeDecoding, ErrorIsTheCramerRaoBoundAndIsReported) {
    // Read and shot noise that make about .04 px. What remains of the staircase of projector pixels
    // adds under .01 px; 40,000 pixels know the figure to .3%: 10% leaves room for both.
    FringeScene scene;
    scene.read_noise = 60.0;
    scene.electrons_per_unit = 0.6;
    const FineCode code = decode(scene);
    const PlaceErrors errors = errors_of(scene, code.places);
    const FringeOfPower fringe = fringe_of_power(scene.gamma);
    const double blur = 2.0 * std::pow(std::numbers::pi * scene.blur_px / kFringePeriod_px, 2.0);
    const double variance = 60.0 * 60.0 + scene.white_level * fringe.mean / 0.6;
    const double bound = kFringePeriod_px / (2.0 * std::numbers::pi) *
                         std::sqrt(2.0 / kFringeShifts * variance) /
                         (scene.white_level * fringe.amplitude * std::exp(-blur));
    std::printf("error %.4f px, bound %.4f px, reported %.4f px, error over reported %.3f\n",
                errors.rms,
                bound,
                code.report.median_sigma_px,
                errors.rms_of_sigma);
    EXPECT_GT(errors.fine, 0.99 * errors.all);
    EXPECT_NEAR(errors.rms / bound, 1.0, 0.10);
    EXPECT_NEAR(code.report.median_sigma_px / bound, 1.0, 0.10);
    EXPECT_NEAR(errors.rms_of_sigma, 1.0, 0.10);
}

TEST(FringeDecoding, NoPeriodSlipsUnderBlur) {
    // From 2 px on the finest stripes are grey. Half a pixel is far beyond noise and far under the
    // period that a slip would be off by. The bound: ten read-outs of 24 units of the amplitude
    // that blur leaves, and the staircase.
    for (const double blur : {0.5, 1.0, 2.0, 3.0, 4.0}) {
        FringeScene scene;
        scene.blur_px = blur;
        scene.read_noise = 24.0;
        const FineCode code = decode(scene);
        const PlaceErrors errors = errors_of(scene, code.places, 4.0 + 3.0 * blur);
        std::printf(
            "blur %.1f px: error %.4f px, largest %.3f px, fine %.3f of what decoded, "
            "decoded %.3f\n",
            blur,
            errors.rms,
            errors.largest,
            static_cast<double>(errors.fine) / errors.decoded,
            static_cast<double>(errors.decoded) / errors.all);
        EXPECT_LT(errors.rms, 0.05) << blur;
        EXPECT_LT(errors.largest, 0.5) << blur;
        EXPECT_GT(errors.fine, 0.95 * errors.decoded) << blur;
    }
}

TEST(FringeDecoding, ResponsesDoNotMovePlacesAndAreFound) {
    for (const double gamma : {1.0, 1.4, 1.8, 2.2, 2.6}) {
        FringeScene scene;
        scene.gamma = gamma;
        const FineCode code = decode(scene);
        const PlaceErrors errors = errors_of(scene, code.places);
        EXPECT_LT(errors.largest, 0.05) << gamma;
        EXPECT_GT(errors.fine, 0.99 * errors.all) << gamma;
        EXPECT_NEAR(code.report.response_power, gamma, 0.05) << gamma;
    }
}

TEST(FringeDecoding, SaturatedAndDarkPixelsKeepTheirWholePixel) {
    // Left third: so bright that whichever shift is nearest to the peak is clipped. Right third: so
    // dark that the fringes' error passes a whole pixel's.
    FringeScene scene;
    scene.read_noise = 24.0;
    scene.direct = [](glm::dvec2 c) { return c.x < 100 ? 2.6 : c.x < 200 ? 1.0 : 0.018; };
    const auto photographs = scene.photographs(kBoth);
    const CameraToProjector gray =
        decode_gray_code(photographs, scene.projector_width, scene.projector_height);
    const FineCode code = decode(scene, photographs);
    int saturated = 0, dark = 0, fine = 0, kept = 0;
    for (int y = 20; y < 200; ++y)
        for (int x = 10; x < 290; ++x) {
            const bool is_fine = code.places.sigma_px.at(x, y, 0) < kWholePixelError;
            if (x < 100) saturated += is_fine;
            if (x >= 200) dark += is_fine;
            if (x >= 100 && x < 200) fine += is_fine;
            if ((x < 100 || x >= 200) && gray.decoded.at(x, y) && !is_fine) {
                ++kept;
                ASSERT_EQ(code.places.projector_px.at(x, y, 0), gray.projector_px.at(x, y, 0));
                ASSERT_EQ(code.places.projector_px.at(x, y, 1), gray.projector_px.at(x, y, 1));
                ASSERT_EQ(code.places.sigma_px.at(x, y, 1), kWholePixelError);
            }
        }
    EXPECT_EQ(fine, 180 * 100);
    EXPECT_LT(saturated, 180 * 90 * 0.01);
    EXPECT_LT(dark, 180 * 90 * 0.05);
    EXPECT_GT(kept, 180 * 80);
}

TEST(FringeDecoding, DirectAndGlobalLightComeApart) {
    // A fifth from elsewhere over the upper half, nothing else over the lower, and in a corner
    // more than from the projector: refused there, and nowhere else. The Gray code takes pixels
    // down to a third.
    FringeScene scene;
    scene.read_noise = 12.0;
    scene.blur_px = 0.5;
    const auto corner = [](glm::dvec2 c) { return c.x > 200 && c.y > 150; };
    scene.direct = [&](glm::dvec2 c) { return corner(c) ? 0.4 : c.y < 100 ? 0.8 : 1.0; };
    scene.global = [&](glm::dvec2 c) { return corner(c) ? 0.6 : c.y < 100 ? 0.2 : 0.0; };
    const FineCode code = decode(scene);
    int refused = 0, wrongly = 0, in_corner = 0;
    double worst = 0.0;
    for (int y = 20; y < 200; ++y)
        for (int x = 10; x < 290; ++x) {
            const bool global = code.light.global_dominates.at(x, y) != 0;
            if (corner({x + 0.5, y + 0.5})) {
                ++in_corner;
                refused += global;
                EXPECT_EQ(global, code.places.decoded.at(x, y) == 0);
            } else {
                wrongly += global;
                const double white = scene.white_level;
                // Blur of .5 px takes 1.9%, noise and response 1% each.
                worst = worse_of(worst,
                                 std::abs(code.light.direct.at(x, y) / white -
                                          scene.direct({x + 0.5, y + 0.5})));
                worst = worse_of(worst,
                                 std::abs(code.light.global.at(x, y) / white -
                                          scene.global({x + 0.5, y + 0.5})));
            }
        }
    std::printf("direct and global light: off by %.3f of white at most\n", worst);
    EXPECT_EQ(refused, in_corner);
    EXPECT_EQ(wrongly, 0);
    EXPECT_LT(worst, 0.05);
}

TEST(FringeDecoding, AWallThatLightsTheNextOneIsRefusedWhereItDominates) {
    // Light from elsewhere grows toward an inner edge in the middle: 0 at the borders, 8 times the
    // direct light at the edge.
    FringeScene scene;
    scene.read_noise = 12.0;
    scene.white_level = 4000.0;
    scene.direct = [](glm::dvec2 c) { return std::abs(c.x - 150.0) < 40.0 ? 0.25 : 1.0; };
    scene.global = [](glm::dvec2 c) { return 2.0 * std::exp(-std::abs(c.x - 150.0) / 30.0); };
    const FineCode code = decode(scene);
    for (int y = 20; y < 200; ++y)
        for (int x = 20; x < 280; ++x) {
            const glm::dvec2 c(x + 0.5, y + 0.5);
            const double share = scene.direct(c) / (scene.direct(c) + scene.global(c));
            if (share < 0.4 || share > 0.6) {
                ASSERT_EQ(code.places.decoded.at(x, y) != 0, share > 0.6) << x << " " << share;
            }
        }
    const PlaceErrors errors = errors_of(scene, code.places);
    EXPECT_LT(errors.largest, 0.1);
}

TEST(FringeDecoding, PhotographsInEachOthersPlaceAreRefused) {
    FringeScene scene;
    scene.read_noise = 24.0;
    const auto good = scene.photographs(kBoth);
    const std::size_t first = good.size() - 10;
    const auto why = [&](auto change) {
        auto photographs = good;
        change(photographs);
        return message_of<Refused>([&] { decode(scene, photographs); });
    };
    using All = std::vector<RoledPhotograph>;
    for (std::size_t a = 0; a < 5; ++a)
        for (std::size_t b = a + 1; b < 5; ++b)
            EXPECT_HAS(why([&](All& all) {
                           std::swap(all[first + a].photograph, all[first + b].photograph);
                       }),
                       "do not fit the Gray code (most of all phase-column-N)");
    // Each shows the picture before; rows in columns' place; the last to first; one late.
    EXPECT_HAS(why([&](All& all) {
                   for (std::size_t n = 0; n < 5; ++n)
                       all[first + 5 + n].photograph = good[first + 5 + (n + 4) % 5].photograph;
               }),
               "most of all phase-row-N");
    EXPECT_HAS(why([&](All& all) {
                   for (std::size_t n = 0; n < 5; ++n)
                       std::swap(all[first + n].photograph, all[first + 5 + n].photograph);
               }),
               "do not fit the Gray code");
    EXPECT_HAS(why([&](All& all) {
                   for (std::size_t n = 0; n < 5; ++n)
                       all[first + n].photograph = good[first + 4 - n].photograph;
               }),
               "do not fit the Gray code");
    EXPECT_HAS(why([&](All& all) { all[first + 3].photograph = good[first + 2].photograph; }),
               "do not fit the Gray code");
}

TEST(FringeDecoding, BadPhotographsAreNamed) {
    FringeScene scene;
    const auto good = scene.photographs(kBoth);
    const std::size_t first = good.size() - 10;
    const auto why = [&](auto change) {
        auto photographs = good;
        change(photographs);
        return message_of<FileError>(
            [&] { decode_places(photographs, scene.projector_width, scene.projector_height); });
    };
    using All = std::vector<RoledPhotograph>;
    for (std::size_t k = 0; k < 10; ++k)
        EXPECT_HAS(
            why([&](All& all) { all.erase(all.begin() + static_cast<std::ptrdiff_t>(first + k)); }),
            "no photograph of " + fringe_roles()[k]);
    EXPECT_HAS(why([&](All& all) {
                   all.push_back({"phase-row-5", all.back().photograph});
               }),
               "found phase-row-5, expected phase-column-0 to -4");
    EXPECT_HAS(why([&](All& all) { all[first + 2].photograph.image = ImageF(10, 11, 1); }),
               "phase-column-2: size: found 10x11, expected 300x220");
    EXPECT_HAS(why([&](All& all) { all[first + 2].photograph.image = ImageF(); }), "found 0x0");

    // Without any fringes the Gray code is what there is; NaN in a fringe keeps the whole pixel.
    All gray = good;
    gray.resize(first);
    EXPECT_TRUE(
        decode_places(gray, scene.projector_width, scene.projector_height).places.sigma_px.empty());
    All broken = good;
    broken[first + 6].photograph.image.at(150, 110) = std::numeric_limits<float>::quiet_NaN();
    const auto places = decode_places(broken, scene.projector_width, scene.projector_height).places;
    EXPECT_EQ(places.decoded.at(150, 110), 255);
    EXPECT_EQ(places.sigma_px.at(150, 110, 0), kWholePixelError);
    EXPECT_LT(places.sigma_px.at(151, 110, 0), 0.05f);

    // All of them clipped, black or not finite
    for (const float value : {16383.0f, 256.0f, std::numeric_limits<float>::quiet_NaN()}) {
        All flat = good;
        for (std::size_t k = first; k < flat.size(); ++k)
            std::fill(flat[k].photograph.image.values.begin(),
                      flat[k].photograph.image.values.end(),
                      value);
        EXPECT_HAS(message_of<Refused>(
                       [&] { decode_places(flat, scene.projector_width, scene.projector_height); }),
                   value == 256.0f ? "no fringes" : "saturated");
    }
}

}  // namespace
}  // namespace livery
