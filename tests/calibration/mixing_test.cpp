#include "calibration/colour/mixing.h"

#include <cmath>

#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "calibration/colour/camera_xyz.h"
#include "calibration/colour/colour.h"
#include "calibration/colour/shrinkage.h"
#include "calibration/support/messages.h"
#include "calibration/support/synthetic_bench.h"
#include "core/error.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using testing::SyntheticBench;

ColourSamples samples_of(SyntheticBench& bench, int shots = 1) {
    return sample_colours(
        bench.photograph_all(colour_patterns(bench.projector_width, bench.projector_height, 0, 255),
                             shots),
        bench.exact_map());
}

glm::dmat3 unit_diagonal(glm::dmat3 v) {
    for (int k = 0; k < 3; ++k) v[k] /= v[k][k];
    return v;
}

double largest_difference(const glm::dmat3& a, const glm::dmat3& b) {
    double largest = 0.0;
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) largest = worse_of(largest, std::abs(a[k][c] - b[k][c]));
    return largest;
}

glm::dvec2 place_of(const ColourSamples& samples, std::size_t i) {
    return {
        static_cast<double>(samples.pixels[i] % static_cast<std::uint32_t>(samples.width)) + 0.5,
        static_cast<double>(samples.pixels[i] / static_cast<std::uint32_t>(samples.width)) + 0.5};
}

TEST(PoolMixing, FindsTheMatrixColumnByColumn) {
    SyntheticBench bench;
    bench.ambient = {0.01, 0.02, 0.015};
    bench.leak = 0.002;
    const PooledMixing pooled = pool_mixing(samples_of(bench));
    // Column: projector channel; row: camera channel. The transpose differs by 0.08.
    const glm::dmat3 expected = unit_diagonal(bench.mixing);
    EXPECT_LT(largest_difference(pooled.vn, expected), 1e-5);
    EXPECT_GT(largest_difference(pooled.vn, glm::transpose(expected)), 0.05);
    EXPECT_LT(pooled.additivity_error, 1e-6);
    EXPECT_TRUE(pooled.neutral);
}

TEST(PoolMixing, AdditivityErrorIsExactly) {
    // White adds w (r + g + b): the error is w / (1 + w). 56% is what a clear wheel segment gave.
    for (const double error : {0.0, 0.0033, 0.02, 0.3, 0.56}) {
        SyntheticBench bench;
        bench.white_segment = error / (1.0 - error);
        EXPECT_NEAR(pool_mixing(samples_of(bench)).additivity_error, error, 1e-6);
    }
}

TEST(MixByPixel, IsExactWithoutNoise) {
    SyntheticBench bench;
    bench.ambient = {0.01, 0.02, 0.015};
    bench.scale = [](glm::dvec2 p) {
        return 0.3 + p.x / 640.0 + p.y / 1000.0;
    };  // bilinear reads it exactly
    const ColourSamples samples = samples_of(bench);
    const PooledMixing pooled = pool_mixing(samples);
    const glm::dmat3 vn = unit_diagonal(bench.mixing);
    const double units = bench.units_per_light();
    for (const PixelMixing& mixing : {mix_by_pixel(samples), mix_robustly(samples, pooled, true)}) {
        ASSERT_GT(samples.pixels.size(), 50000u);
        for (std::size_t i = 0; i < samples.pixels.size(); i += 501) {
            const double s = units * bench.scale(place_of(samples, i));
            EXPECT_LT(largest_difference(glm::dmat3(mixing.unmixing[i]), glm::inverse(vn)), 2e-5);
            const glm::dvec3 dark = glm::inverse(vn) * bench.ambient * s;
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(mixing.span[i][k], bench.mixing[k][k] * s, 2e-5 * units);
                EXPECT_NEAR(mixing.dark[i][k], dark[k], 2e-6 * units);
            }
            EXPECT_NEAR(mixing.condition[i], condition_number(vn), 1e-3);
        }
    }
}

TEST(MixRobustly, KeepsAColouredSurfaceApart) {
    // Left half red paint, right half grey: per-pixel mixing must not be pooled away.
    SyntheticBench bench;
    bench.read_noise = 20.0;
    bench.tint = [](glm::dvec2 p) {
        return p.x < 160 ? glm::dvec3(0.8, 0.25, 0.2) : glm::dvec3(0.5);
    };
    const ColourSamples samples = samples_of(bench);
    const PooledMixing pooled = pool_mixing(samples);
    EXPECT_FALSE(pooled.neutral);
    EXPECT_GT(pooled.spread, 3.0);
    const PixelMixing mixing = mix_robustly(samples, pooled, true);
    double worst = 0.0, square = 0.0, count = 0.0;
    for (std::size_t i = 0; i < samples.pixels.size(); i += 101) {
        const glm::dvec2 p = place_of(samples, i);
        if (std::abs(p.x - 160) < 8) continue;
        glm::dmat3 v = bench.mixing;
        for (int k = 0; k < 3; ++k) v[k] *= bench.tint(p);
        const double error =
            largest_difference(glm::inverse(glm::dmat3(mixing.unmixing[i])), unit_diagonal(v));
        worst = worse_of(worst, error);
        square += error * error;
        count += 1.0;
    }
    EXPECT_LT(std::sqrt(square / count), 0.02);
    EXPECT_LT(worst, 0.12);
}

TEST(NoiseModel, IsReadFromThePhotographs) {
    SyntheticBench bench;
    bench.read_noise = 12.0;
    bench.electrons_per_unit = 2.0;
    bench.scale = [](glm::dvec2 p) { return 0.1 + 0.9 * p.x / 320.0; };
    const ColourSamples samples = samples_of(bench);
    // One file unit is 1 / exposure of camera colour.
    const double unit = 1.0 / bench.exposure_s;
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(samples.noise.read[c] / (12.0 * 12.0 * unit * unit), 1.0, 0.25) << c;
        EXPECT_NEAR(samples.noise.shot[c] / (0.5 * unit), 1.0, 0.15) << c;
    }
}

TEST(MixByPixel, StatesItsNoise) {
    SyntheticBench bench;
    bench.read_noise = 60.0;
    bench.electrons_per_unit = 1.0;
    const ColourSamples samples = samples_of(bench);
    const PixelMixing by_pixel = mix_by_pixel(samples);
    const PixelMixing robust = mix_robustly(samples, pool_mixing(samples), true);
    double square_pixel = 0.0, square_robust = 0.0, z = 0.0, z_robust = 0.0, count = 0.0;
    for (std::size_t i = 0; i < samples.pixels.size(); i += 7)
        for (int k = 0; k < 3; ++k) {
            const double truth = bench.mixing[k][k] * bench.units_per_light();
            const double e = by_pixel.span[i][k] - truth, r = robust.span[i][k] - truth;
            square_pixel += e * e;
            square_robust += r * r;
            z += e * e /
                 (static_cast<double>(by_pixel.span_sigma[i][k]) *
                  static_cast<double>(by_pixel.span_sigma[i][k]));
            z_robust += r * r /
                        (static_cast<double>(robust.span_sigma[i][k]) *
                         static_cast<double>(robust.span_sigma[i][k]));
            count += 1.0;
        }
    // Vn's own noise is not in the stated figure of the published method: a tenth or two more.
    EXPECT_NEAR(std::sqrt(z / count), 1.05, 0.2);
    EXPECT_NEAR(std::sqrt(z_robust / count), 1.0, 0.3);
    // Twelve values instead of two, and pooled mixing: the error falls at least to two thirds.
    EXPECT_LT(square_robust, 0.45 * square_pixel);
}

TEST(MixRobustly, EightShotsHalveTheErrorAndMore) {
    const auto rms = [](int shots) {
        SyntheticBench bench;
        bench.read_noise = 40.0;
        const ColourSamples samples = samples_of(bench, shots);
        const PixelMixing mixing = mix_robustly(samples, pool_mixing(samples), true);
        double square = 0.0;
        for (std::size_t i = 0; i < samples.pixels.size(); ++i)
            square += std::pow(static_cast<double>(mixing.span[i].y) -
                                   bench.mixing[1][1] * bench.units_per_light(),
                               2.0);
        return std::sqrt(square / static_cast<double>(samples.pixels.size()));
    };
    // 1 / sqrt(8) = 0.354
    EXPECT_NEAR(rms(8) / rms(1), 0.354, 0.05);
}

TEST(ConditionNumber, OfKnownMatrices) {
    EXPECT_NEAR(condition_number(glm::dmat3(1.0)), 1.0, 1e-9);
    EXPECT_NEAR(condition_number(glm::dmat3(4, 0, 0, 0, 2, 0, 0, 0, 0.5)), 8.0, 1e-9);
    // A rotation does not change it.
    const double c = std::cos(0.7), s = std::sin(0.7);
    const glm::dmat3 turn(c, s, 0, -s, c, 0, 0, 0, 1);
    EXPECT_NEAR(condition_number(turn * glm::dmat3(100, 0, 0, 0, 1, 0, 0, 0, 3)), 100.0, 1e-4);
    // The middle singular value drowns beside much larger ones, harmlessly.
    EXPECT_NEAR(condition_number(turn * glm::dmat3(1e4, 0, 0, 0, 1, 0, 0, 0, 3)), 1e4, 1e2);
    EXPECT_TRUE(std::isinf(condition_number(glm::dmat3(1, 1, 1, 1, 1, 1, 0, 0, 1))));
    EXPECT_TRUE(std::isinf(condition_number(glm::dmat3(NAN))));
}

TEST(ShrinkLocally, AveragesNoiseAndKeepsStructure) {
    constexpr int kWidth = 120, kHeight = 80;
    std::vector<std::uint32_t> pixels;
    std::vector<float> noise, step, variance;
    Random random(2);
    for (int i = 0; i < kWidth * kHeight; ++i) {
        pixels.push_back(static_cast<std::uint32_t>(i));
        const auto e = static_cast<float>(0.1 * random.normal());
        noise.push_back(e);
        step.push_back(e + (i % kWidth < 60 ? 0.0f : 5.0f));
        variance.push_back(0.01f);
    }
    const SampleGrid grid(kWidth, pixels);
    const auto rms = [&](const std::vector<float>& v, auto truth) {
        double square = 0.0;
        for (int i = 0; i < kWidth * kHeight; ++i)
            square += std::pow(
                static_cast<double>(v[static_cast<std::size_t>(i)]) - truth(i % kWidth), 2.0);
        return std::sqrt(square / (kWidth * kHeight));
    };
    const auto zero = [](int) { return 0.0; };
    EXPECT_LT(rms(shrink_locally(grid, noise, variance, 4, false).value, zero), 0.035);
    EXPECT_LT(rms(shrink_locally(grid, noise, variance, 4, true).value, zero), 0.030);
    const auto stepped = [](int x) { return x < 60 ? 0.0 : 5.0; };
    EXPECT_LT(rms(shrink_locally(grid, step, variance, 4, false).value, stepped), 0.055);
    // Without noise nothing moves; without variance nothing takes part.
    const std::vector<float> tiny(noise.size(), 1e-12f), none(noise.size(), 0.0f);
    EXPECT_LT(rms(shrink_locally(grid, step, tiny, 4, false).value, stepped), 0.101);
    EXPECT_EQ(shrink_locally(grid, step, none, 4, false).value, step);

    // Spokes of a wheel: bright ones, whose noise is that of their light, among dark ones whose
    // small variances make up the mean.
    std::vector<float> spokes = step, of_light = variance;
    for (std::size_t i = 0; i < spokes.size(); ++i) {
        const bool bright = i % 7 == 0;
        const float sigma = bright ? 30.0f : 1.0f;
        spokes[i] = (bright ? 2000.0f : 40.0f) + sigma * noise[i] / 0.1f;
        of_light[i] = sigma * sigma;
    }
    for (const bool toward_zero : {false, true}) {
        const Shrunk kept = shrink_locally(grid, spokes, of_light, 4, toward_zero);
        for (std::size_t i = 0; i < spokes.size(); ++i)
            ASSERT_LE(std::abs(kept.value[i] - spokes[i]), 3.01f * std::sqrt(of_light[i])) << i;
    }
}

TEST(SampleColours, BadCapturesAreNamed) {
    SyntheticBench bench;
    bench.projector_width = 160;
    bench.projector_height = 100;
    bench.camera_width = 210;
    bench.camera_height = 140;
    const auto good = bench.photograph_all(colour_patterns(160, 100, 0, 255));
    const ProjectorToCamera map = bench.exact_map();
    using Captures = std::vector<RoledPhotograph>;
    const auto message = [&](auto change) {
        Captures captures = good;
        change(captures);
        return message_of<FileError>([&] { sample_colours(captures, map); });
    };
    EXPECT_HAS(message([](Captures& c) { c.erase(c.begin() + 3); }), "no photograph of green");
    EXPECT_HAS(message([](Captures& c) { c.clear(); }), "no photograph of dark-gray");
    EXPECT_HAS(message([](Captures& c) { c[1].role = "purple"; }),
               "role: found purple, expected dark-gray, bright-gray");
    EXPECT_HAS(message([](Captures& c) { c[2].photograph.image = ImageF(20, 10, 3); }),
               "red: size: found 20x10, expected 210x140");
    EXPECT_HAS(message([](Captures& c) { c[4].photograph.image = ImageF(210, 140, 1); }),
               "blue: channels: found 1, expected 3");
    EXPECT_HAS(message([](Captures& c) { c[5].photograph.exposure_s = 0.0; }),
               "gray-levels: exposure_s");
    EXPECT_HAS(message([](Captures& c) { c[5].photograph.saturates_at = 10.0; }),
               "gray-levels: saturates_at: found 10.0");
    for (const char* role : {"gray-row-3", "verify-0"})
        EXPECT_HAS(message([&](Captures& c) {
                       c.push_back({role, c[0].photograph});
                   }),
                   std::string("role: found ") + role);
    EXPECT_THROW(sample_colours(good, ProjectorToCamera{}), std::invalid_argument);
}

TEST(PoolMixing, SaysWhyNothingCanBeSolved) {
    const auto refusal = [](auto change) {
        SyntheticBench bench;
        bench.projector_width = 160;
        bench.projector_height = 100;
        bench.camera_width = 210;
        bench.camera_height = 140;
        auto captures = bench.photograph_all(colour_patterns(160, 100, 0, 255));
        change(captures);
        return message_of<Refused>(
            [&] { pool_mixing(sample_colours(captures, bench.exact_map())); });
    };
    using Captures = std::vector<RoledPhotograph>;
    const auto fill = [](float value) {
        return [value](Captures& c) {
            for (auto& capture : c)
                std::fill(capture.photograph.image.values.begin(),
                          capture.photograph.image.values.end(),
                          value);
        };
    };
    EXPECT_HAS(refusal(fill(256.0f)), "nowhere on the mock-up brighter");
    EXPECT_HAS(refusal(fill(NAN)), "nowhere on the mock-up brighter");
    EXPECT_HAS(refusal(fill(16256.0f)), "saturated on the whole mock-up");
    EXPECT_HAS(refusal([](Captures& c) { c[4].photograph = c[0].photograph; }), "blue picture");
}

TEST(XyzFromPrimaries, IsExactAndWeighsWhite) {
    const glm::dmat3 truth(0.4, 0.2, 0.02, 0.3, 0.7, 0.1, 0.2, 0.1, 0.9);
    SyntheticBench bench;
    CameraPrimaries camera{bench.mixing, bench.mixing * glm::dvec3(1.0)};
    CameraToXyz measured;
    measured.has_primaries = true;
    measured.black_xyz = {0.01, 0.012, 0.02};
    for (int k = 0; k < 3; ++k)
        measured.primaries_xyz[k] = truth * bench.mixing[k] + measured.black_xyz;
    EXPECT_LT(largest_difference(xyz_from_primaries(measured, camera), truth), 1e-9);
    // White with light of another colour than the sum: the fit leans to it.
    measured.white_xyz = truth * camera.white * 1.1 + measured.black_xyz;
    const glm::dvec3 white = xyz_from_primaries(measured, camera) * camera.white;
    EXPECT_NEAR(white.y / (truth * camera.white).y, 1.1, 0.03);

    measured.primaries_xyz[2] = measured.primaries_xyz[1];
    EXPECT_HAS(message_of<Refused>([&] { xyz_from_primaries(measured, camera); }),
               "not three different colours");
}

TEST(FitCameraMatrix, RecoversAMatrixAndRefusesNonsense) {
    const glm::dmat3 truth(0.4, 0.2, 0.02, 0.3, 0.7, 0.1, 0.2, 0.1, 0.9);
    Random random(4);
    std::vector<glm::dvec3> rgb, xyz;
    for (int i = 0; i < 24; ++i) {
        rgb.emplace_back(random.uniform(), random.uniform(), random.uniform());
        xyz.push_back(truth * rgb.back());
    }
    EXPECT_LT(largest_difference(fit_camera_matrix(rgb, xyz), truth), 1e-9);
    EXPECT_HAS(message_of<std::invalid_argument>([&] { fit_camera_matrix(rgb, {xyz[0]}); }),
               "24 camera colours and 1 XYZ");
    std::vector<glm::dvec3> grey(24, glm::dvec3(0.5));
    EXPECT_HAS(message_of<std::invalid_argument>([&] { fit_camera_matrix(grey, xyz); }),
               "three dimensions");
    rgb[3].y = NAN;
    EXPECT_HAS(message_of<std::invalid_argument>([&] { fit_camera_matrix(rgb, xyz); }), "colour 3");
}

}  // namespace
}  // namespace livery
