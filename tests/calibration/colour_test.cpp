#include "calibration/colour/colour.h"

#include <cmath>

#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "calibration/support/messages.h"
#include "calibration/support/synthetic_bench.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using testing::SyntheticBench;

std::vector<Pattern> patterns_of(const SyntheticBench& bench,
                                 int s = 0,
                                 int t = 255,
                                 int mosaics = 0) {
    auto patterns = colour_patterns(bench.projector_width, bench.projector_height, s, t);
    if (mosaics > 0)
        for (Pattern& p : mosaic_patterns(bench.projector_width, bench.projector_height, mosaics))
            patterns.push_back(std::move(p));
    return patterns;
}

ColourCalibration calibrate(SyntheticBench& bench,
                            const CalibrationSettings& options = {},
                            int shots = 1,
                            int mosaics = 0) {
    const auto patterns = patterns_of(bench, options.dark_drive, options.bright_drive, mosaics);
    return calibrate_colour(
        bench.photograph_all(patterns, shots), patterns, bench.exact_map(), options);
}

/// Equation 9 at one pixel; NaN where N leaves the measured range.
glm::dvec3 drive_for(const ColourCalibration& c, std::size_t pixel, glm::dvec3 camera) {
    glm::dvec3 drive;
    for (std::size_t row = 0; row < 3; ++row) {
        double n = -static_cast<double>(c.dark.values[3 * pixel + row]);
        for (std::size_t column = 0; column < 3; ++column)
            n += static_cast<double>(c.unmixing.values[9 * pixel + 3 * row + column]) *
                 camera[static_cast<int>(column)];
        n /= static_cast<double>(c.span.values[3 * pixel + row]);
        const auto& curve = c.response[row].drive_from_n;
        const double place = n * static_cast<double>(curve.size() - 1);
        if (!(place >= 0.0 && place <= static_cast<double>(curve.size() - 1)))
            return glm::dvec3(NAN);
        const auto low = std::min(static_cast<std::size_t>(place), curve.size() - 2);
        const double fraction = place - static_cast<double>(low);
        drive[static_cast<int>(row)] = static_cast<double>(curve[low]) * (1 - fraction) +
                                       static_cast<double>(curve[low + 1]) * fraction;
    }
    return drive;
}

struct Recovery {
    double rms = 0.0, worst = 0.0;  ///< light of a channel over its full light
    int count = 0;
};

/// Shows known drives, hands their camera colours to equation 9, and compares the light.
Recovery recover(const SyntheticBench& bench,
                 const ColourCalibration& c,
                 double lowest,
                 double highest) {
    Recovery recovery;
    Random random(31);
    for (int y = 8; y < c.height - 8; y += 3)
        for (int x = 8; x < c.width - 8; x += 3) {
            const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(c.width) +
                               static_cast<std::size_t>(x);
            if (!is_valid(static_cast<PixelStatus>(c.status.values[pixel]))) continue;
            glm::dvec3 drive;
            for (int k = 0; k < 3; ++k) drive[k] = lowest + (highest - lowest) * random.uniform();
            const glm::dvec3 found =
                drive_for(c, pixel, bench.camera_colour(drive, {x + 0.5, y + 0.5}));
            if (std::isnan(found.x)) continue;
            const glm::dvec3 error = bench.response(found) - bench.response(drive);
            recovery.rms += glm::dot(error, error) / 3.0;
            recovery.worst =
                worse_of({recovery.worst, std::abs(error.x), std::abs(error.y), std::abs(error.z)});
            ++recovery.count;
        }
    recovery.rms = std::sqrt(recovery.rms / std::max(recovery.count, 1));
    return recovery;
}

TEST(CalibrateColour, RobustRecoversEveryDriveWithoutNoise) {
    SyntheticBench bench;
    bench.ambient = {0.004, 0.006, 0.005};
    bench.leak = 0.001;
    bench.scale = [](glm::dvec2 p) { return 0.4 + p.x / 640.0 + p.y / 2000.0; };
    const ColourCalibration c = calibrate(bench);
    const Recovery recovery = recover(bench, c, 5.0, 250.0);
    EXPECT_GT(recovery.count, 3000);
    // A level's mean and the chords of rho: 0.0005 of full light, CIEDE2000 0.02 in the middle
    // tones
    EXPECT_LT(recovery.worst, 5e-4);
    EXPECT_LT(recovery.rms, 1.5e-4);
    EXPECT_EQ(c.mode, "robust");
    EXPECT_EQ(c.xyz_origin, "assumed Rec.709");
    EXPECT_EQ(c.xyz_from_camera, xyz_from_rec709());
    EXPECT_LT(c.additivity_error, 1e-5);
    EXPECT_GT(c.valid_fraction, 0.99);
    EXPECT_TRUE(c.warnings.empty()) << c.warnings.front();
}

TEST(CalibrateColour, PaperModeIsTheMethodAtItsOwnDrives) {
    SyntheticBench bench;
    bench.ambient = {0.004, 0.006, 0.005};
    bench.read_noise = 3.0;
    CalibrationSettings options;
    options.mode = ColourMode::paper;
    options.dark_drive = 64;
    options.bright_drive = 200;
    const ColourCalibration c = calibrate(bench, options);
    EXPECT_EQ(c.mode, "paper");
    EXPECT_EQ(c.dark_drive, 64.0);
    EXPECT_EQ(c.bright_drive, 200.0);
    // Nadaraya-Watson with h = 0.02 of N' blurs the foot of the curve and its ends; in between it
    // errs by h^2 rho'' / 2 and the slope of the density.
    EXPECT_LT(recover(bench, c, 90.0, 240.0).rms, 0.01);
    EXPECT_GT(recover(bench, c, 90.0, 240.0).count, 3000);
    // N runs over all drives that were photographed, not from s to t only.
    const std::size_t pixel = 100u * 320u + 160u;
    const glm::dvec3 brightest = bench.camera_colour(glm::dvec3(250.0), {160.5, 100.5});
    EXPECT_GT(drive_for(c, pixel, brightest).x, 235.0);
    EXPECT_LT(c.span.values[3 * pixel], 0.80 * 1.02 * bench.units_per_light());
    EXPECT_GT(c.span.values[3 * pixel], 0.80 * 0.98 * bench.units_per_light());
}

TEST(CalibrateColour, MatrixIsNotTransposed) {
    SyntheticBench bench;
    const ColourCalibration c = calibrate(bench);
    const std::size_t pixel = 100u * 320u + 160u;
    // Pure red light must ask for the red channel alone.
    const glm::dvec3 red = bench.camera_colour({255.0, 0.0, 0.0}, {160.5, 100.5}) * 0.5;
    for (std::size_t row = 0; row < 3; ++row) {
        double n = 0.0;
        for (std::size_t column = 0; column < 3; ++column)
            n += static_cast<double>(c.unmixing.values[9 * pixel + 3 * row + column]) *
                 red[static_cast<int>(column)];
        n /= static_cast<double>(c.span.values[3 * pixel + row]);
        EXPECT_NEAR(n, row == 0 ? 0.5 : 0.0, 1e-4) << row;
    }
}

TEST(CalibrateColour, NoiseGivesTheErrorThatItShould) {
    // Read noise of 1% of white, no structure. Each pixel's scale stands on twelve values, six of
    // them near white: between 0.3% and 0.6%, times the light itself.
    SyntheticBench bench;
    bench.read_noise = 0.01 * 0.8 * bench.full_scale;
    const Recovery one = recover(bench, calibrate(bench), 60.0, 230.0);
    EXPECT_GT(one.rms, 0.001);
    EXPECT_LT(one.rms, 0.006);
    SyntheticBench again;
    again.read_noise = bench.read_noise;
    const Recovery eight = recover(again, calibrate(again, {}, 8), 60.0, 230.0);
    EXPECT_NEAR(eight.rms / one.rms, 1.0 / std::sqrt(8.0), 0.12);
}

TEST(CalibrateColour, PrimariesGiveAbsoluteXyz) {
    const glm::dmat3 truth(0.4, 0.2, 0.02, 0.3, 0.7, 0.1, 0.2, 0.1, 0.9);
    SyntheticBench bench;
    bench.ambient = {0.002, 0.003, 0.002};
    bench.scale = [](glm::dvec2 p) { return 0.4 + p.x / 640.0; };
    const glm::dvec2 place(200.5, 90.5);
    CalibrationSettings options;
    CameraToXyz& xyz = options.camera_to_xyz;
    xyz.has_primaries = true;
    xyz.measured_at_px = place;
    xyz.black_xyz = truth * bench.camera_colour(glm::dvec3(0.0), place);
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 drive(0.0);
        drive[k] = 255.0;
        xyz.primaries_xyz[k] = truth * bench.camera_colour(drive, place);
    }
    const ColourCalibration c = calibrate(bench, options);
    EXPECT_EQ(c.xyz_origin, "primaries");
    for (int k = 0; k < 3; ++k)
        for (int r = 0; r < 3; ++r) EXPECT_NEAR(c.xyz_from_camera[k][r], truth[k][r], 2e-4);

    // The published drives: N was stretched to full drive, so the primaries still fit.
    CalibrationSettings paper = options;
    paper.mode = ColourMode::paper;
    paper.dark_drive = 64;
    paper.bright_drive = 200;
    const ColourCalibration p = calibrate(bench, paper);
    for (int k = 0; k < 3; ++k)
        for (int r = 0; r < 3; ++r) EXPECT_NEAR(p.xyz_from_camera[k][r], truth[k][r], 5e-3);

    // Off a white reference elsewhere: the same colours, the scale of a middling pixel
    xyz.measured_at_px.reset();
    const ColourCalibration relative = calibrate(bench, options);
    const double scale = relative.xyz_from_camera[1].y / truth[1].y;
    for (int k = 0; k < 3; ++k)
        for (int r = 0; r < 3; ++r)
            EXPECT_NEAR(relative.xyz_from_camera[k][r], scale * truth[k][r], 2e-3);

    xyz.measured_at_px = glm::dvec2(-50.0, 3.0);
    EXPECT_HAS(message_of<Refused>([&] { calibrate(bench, options); }),
               "no valid pixel lies where the primaries");
}

TEST(CalibrateColour, RoomLightOfAnotherSpectrumIsMatchedByItsXyz) {
    // The camera sees the room as `ambient`; the eye sees an XYZ that the projector's matrix does
    // not give. What is wanted in XYZ must come out in XYZ all the same.
    const glm::dmat3 truth(0.4, 0.2, 0.02, 0.3, 0.7, 0.1, 0.2, 0.1, 0.9);
    const glm::dvec3 room_xyz(0.05, 0.04, 0.09);
    SyntheticBench bench;
    bench.ambient = {0.05, 0.06, 0.04};
    bench.scale = [](glm::dvec2 p) { return 0.4 + p.x / 640.0; };
    const auto seen = [&](glm::dvec3 drive, glm::dvec2 p) {
        const glm::dvec3 projected = bench.camera_colour(drive, p) -
                                     bench.units_per_light() * bench.ambient * bench.scale(p);
        return truth * projected + room_xyz * bench.units_per_light() * bench.scale(p);
    };
    const glm::dvec2 place(200.5, 90.5);
    CalibrationSettings options;
    CameraToXyz& xyz = options.camera_to_xyz;
    xyz.has_primaries = true;
    xyz.measured_at_px = place;
    xyz.black_xyz = seen(glm::dvec3(0.0), place);
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 drive(0.0);
        drive[k] = 255.0;
        xyz.primaries_xyz[k] = seen(drive, place);
    }
    const ColourCalibration c = calibrate(bench, options);
    for (const int x : {40, 160, 280}) {
        const glm::dvec3 drive(60.0, 150.0, 210.0);
        const glm::dvec3 wanted = seen(drive, {x + 0.5, 100.5});
        const glm::dvec3 found = drive_for(
            c, 100u * 320u + static_cast<std::size_t>(x), glm::inverse(c.xyz_from_camera) * wanted);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], drive[k], 0.05) << x;
    }
}

TEST(CalibrateColour, AGivenMatrixIsLabelled) {
    SyntheticBench bench;
    CalibrationSettings options;
    options.camera_to_xyz.origin = "chart";
    options.camera_to_xyz.xyz_from_camera = glm::dmat3(2.0);
    const ColourCalibration c = calibrate(bench, options);
    EXPECT_EQ(c.xyz_origin, "chart");
    EXPECT_EQ(c.xyz_from_camera, glm::dmat3(2.0));
    options.camera_to_xyz.xyz_from_camera = glm::dmat3(0.0);
    EXPECT_HAS(message_of<std::invalid_argument>([&] { calibrate(bench, options); }), "singular");
}

TEST(CalibrateColour, WhiteSegmentIsRefusedOrTabled) {
    SyntheticBench bench;
    bench.white_segment = 1.2727;  // 56%
    const auto refusal = message_of<Refused>([&] { calibrate(bench); });
    EXPECT_HAS(refusal, "not additive: white differs from red + green + blue by 56.0%");
    EXPECT_HAS(refusal, "sRGB or cinema mode");

    const ColourCalibration c = calibrate(bench, {}, 1, 6);
    EXPECT_NEAR(c.additivity_error, 0.56, 1e-4);
    ASSERT_EQ(c.table.grid, 17);
    const auto node = [&](int r, int g, int b) {
        return c.table.n_from_drive[static_cast<std::size_t>((b * 17 + g) * 17 + r)];
    };
    for (const auto& [r, g, b] :
         {std::array{0, 0, 0}, {16, 0, 0}, {16, 16, 16}, {8, 8, 8}, {12, 5, 9}, {16, 16, 0}}) {
        const glm::dvec3 p = bench.response({r * 255 / 16.0, g * 255 / 16.0, b * 255 / 16.0});
        const glm::dvec3 n = (p + glm::dvec3(bench.white_segment * std::min({p.x, p.y, p.z}))) /
                             (1.0 + bench.white_segment);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(node(r, g, b)[k], n[k], 0.004) << r << " " << g << " " << b;
    }
    ASSERT_FALSE(c.warnings.empty());
    EXPECT_HAS(c.warnings[0], "a table of mosaic colours is used");

    CalibrationSettings paper;
    paper.mode = ColourMode::paper;
    EXPECT_HAS(message_of<Refused>([&] { calibrate(bench, paper, 1, 6); }),
               "published method has no model");
    // Mosaics of an additive projector are not needed and do no harm.
    SyntheticBench additive;
    EXPECT_EQ(calibrate(additive, {}, 1, 6).table.grid, 0);
}

TEST(CalibrateColour, WarnsBetweenTwoAndFivePercent) {
    SyntheticBench bench;
    bench.white_segment = 0.03;
    const ColourCalibration c = calibrate(bench);
    EXPECT_EQ(c.table.grid, 0);
    ASSERT_GE(c.warnings.size(), 1u);
    EXPECT_HAS(c.warnings[0], "white differs from red + green + blue by 2.91%");
}

TEST(CalibrateColour, AmbientLightIsMeasuredAndWarnedAbout) {
    for (const auto& [ambient, expected] :
         {std::pair{0.005, ""}, {0.03, "the dark picture has"}, {0.08, "STRONG"}}) {
        SyntheticBench bench;
        bench.ambient = bench.mixing * glm::dvec3(ambient);
        const ColourCalibration c = calibrate(bench);
        EXPECT_NEAR(c.ambient_fraction, ambient / (1.0 + ambient), 1e-4);
        EXPECT_EQ(c.warnings.empty(), std::string(expected).empty());
        if (!c.warnings.empty()) {
            EXPECT_HAS(c.warnings[0], expected);
        }
    }
}

TEST(CalibrateColour, EachPixelSaysWhyItIsInvalid) {
    SyntheticBench bench;
    bench.read_noise = 20.0;
    bench.scale = [](glm::dvec2 p) { return p.x < 60 ? 0.001 : 1.0; };
    const auto patterns = patterns_of(bench);
    auto captures = bench.photograph_all(patterns);
    ProjectorToCamera map = bench.exact_map();
    const auto camera_of = [&](int x, int y) {
        return glm::ivec2(map.camera_px.at(x, y, 0), map.camera_px.at(x, y, 1));
    };
    const auto paint = [&](std::size_t role, int x, int y, float value) {
        const glm::ivec2 c = camera_of(x, y);
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx)
                for (int k = 0; k < 3; ++k)
                    captures[role].photograph.image.at(c.x + dx, c.y + dy, k) = value;
    };
    paint(1, 100, 50, 16100.0f);                                 // bright-gray: 99%
    paint(3, 150, 50, std::numeric_limits<float>::quiet_NaN());  // green
    // Blue as dark as black: only red and green pass, and Vn has no third column.
    {
        const glm::ivec2 c = camera_of(200, 50);
        for (int dy = -3; dy <= 3; ++dy)
            for (int dx = -3; dx <= 3; ++dx)
                for (const std::size_t role : {1u, 4u})
                    captures[role].photograph.image.at(c.x + dx, c.y + dy, 2) =
                        captures[0].photograph.image.at(c.x + dx, c.y + dy, 2);
    }
    map.edge.at(250, 50) = 255;
    for (int y = 80; y < 84; ++y)
        for (int x = 250; x < 254; ++x)
            for (int k = 0; k < 2; ++k)
                map.camera_px.at(x, y, k) = std::numeric_limits<float>::quiet_NaN();
    for (int y = 150; y < 200; ++y)
        for (int x = 0; x < 320; ++x)
            for (int k = 0; k < 2; ++k)
                map.camera_px.at(x, y, k) = std::numeric_limits<float>::quiet_NaN();

    const ColourCalibration c = calibrate_colour(captures, patterns, map, {});
    const auto status = [&](int x, int y) { return static_cast<PixelStatus>(c.status.at(x, y)); };
    EXPECT_EQ(status(30, 50), PixelStatus::too_dark);
    EXPECT_EQ(status(100, 50), PixelStatus::saturated);
    EXPECT_EQ(status(150, 50), PixelStatus::not_decoded);  // not finite
    EXPECT_EQ(status(200, 50), PixelStatus::one_channel);
    EXPECT_EQ(status(250, 50), PixelStatus::edge);
    EXPECT_EQ(status(251, 81), PixelStatus::not_decoded);  // a hole
    EXPECT_EQ(status(160, 180), PixelStatus::unlit);
    EXPECT_EQ(status(200, 100), PixelStatus::measured);
    for (const auto& [x, y] :
         {std::pair{30, 50}, {100, 50}, {150, 50}, {200, 50}, {250, 50}, {160, 180}})
        for (int k = 0; k < 3; ++k) EXPECT_EQ(c.span.at(x, y, k), 0.0f);
    for (const float v : c.span.values) ASSERT_TRUE(std::isfinite(v));
    for (const float v : c.unmixing.values) ASSERT_TRUE(std::isfinite(v));
}

TEST(CalibrateColour, IllConditionedPixelsTakeThePooledMatrixOrAreMasked) {
    // A camera whose channels nearly coincide: condition over 10 everywhere
    SyntheticBench bench;
    bench.mixing = glm::dmat3(1.0, 0.90, 0.86, 0.92, 1.0, 0.91, 0.88, 0.93, 1.0);
    EXPECT_HAS(message_of<Refused>([&] { calibrate(bench); }), "ill-conditioned");
}

TEST(CalibrateColour, DriftBetweenShotsIsRefused) {
    SyntheticBench bench;
    const auto patterns = patterns_of(bench);
    auto captures = bench.photograph_all(patterns, 2);
    const auto scale = [&](std::size_t i, float gain) {
        for (float& v : captures[i].photograph.image.values) v = 256.0f + (v - 256.0f) * gain;
    };
    scale(3, 0.995f);
    EXPECT_NO_THROW(calibrate_colour(captures, patterns, bench.exact_map(), {}));
    scale(3, 0.98f);
    EXPECT_HAS(
        message_of<Refused>([&] { calibrate_colour(captures, patterns, bench.exact_map(), {}); }),
        "photographs of bright-gray differ by 2.49% in brightness");
}

TEST(CalibrateColour, APictureThatDidNotArriveIsNoticed) {
    SyntheticBench bench;
    const auto patterns = patterns_of(bench);
    auto captures = bench.photograph_all(patterns);
    captures[5].photograph = captures[4].photograph;  // gray-levels shows blue
    EXPECT_HAS(
        message_of<Refused>([&] { calibrate_colour(captures, patterns, bench.exact_map(), {}); }),
        "does not show its pattern");
    captures[5].photograph = captures[1].photograph;  // gray-levels shows bright-gray
    EXPECT_THROW(calibrate_colour(captures, patterns, bench.exact_map(), {}), Refused);
    // Red and green swapped
    captures = bench.photograph_all(patterns);
    std::swap(captures[2].role, captures[3].role);
    EXPECT_THROW(calibrate_colour(captures, patterns, bench.exact_map(), {}), Refused);
}

TEST(CalibrateColour, OptionsAndPatternsThatMakeNoSense) {
    SyntheticBench bench;
    const auto patterns = patterns_of(bench);
    const auto captures = bench.photograph_all(patterns);
    const ProjectorToCamera map = bench.exact_map();
    const auto message = [&](CalibrationSettings options, std::vector<Pattern> p) {
        return message_of<std::invalid_argument>(
            [&] { calibrate_colour(captures, p, map, options); });
    };
    CalibrationSettings options;
    options.dark_drive = 64;
    EXPECT_HAS(message(options, patterns), "robust mode needs s = 0");
    options.mode = ColourMode::paper;
    options.bright_drive = 30;
    EXPECT_HAS(message(options, patterns), "s = 64, t = 30");
    EXPECT_HAS(message({}, {}), "no pattern given for the photograph of gray-levels");
    EXPECT_HAS(message({}, colour_patterns(640, 400, 0, 255)),
               "gray-levels is 640x400, the map is 320x200");
    auto noise = patterns;
    for (std::size_t i = 0; i < noise[5].drive.values.size(); ++i)
        noise[5].drive.values[i] = static_cast<std::uint8_t>(i * 7);
    EXPECT_HAS(message({}, noise), "no uniform blocks");

    ProjectorToCamera nothing = map;
    std::fill(nothing.camera_px.values.begin(), nothing.camera_px.values.end(), NAN);
    EXPECT_HAS(message_of<Refused>([&] { calibrate_colour(captures, patterns, nothing, {}); }),
               "only 0 projector pixels have a place");
    std::atomic<bool> stop{true};
    Progress progress;
    progress.stop = &stop;
    EXPECT_THROW(calibrate_colour(captures, patterns, map, {}, progress), Cancelled);
}

}  // namespace
}  // namespace livery
