// A whole colour session in about a second: the default bench with fewer pixels, calibrated through
// its ports and judged by its own observer.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "calibration/calibrate_live.h"
#include "compensation/compensation.h"
#include "compensation/lit_pixels.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/random.h"
#include "jobs/comparison.h"
#include "scene/library.h"
#include "support/kept_light.h"
#include "twin/bench.h"

namespace livery::testing {

/// Pixels of the small bench's projector.
inline constexpr int kSmallWidth = 320, kSmallHeight = 200;

/// The default bench with a sixteenth of its pixels; every nuisance is off. Noise, spectra and
/// geometry are the full bench's.
inline BenchDescription small_bench_description() {
    BenchDescription description = read_bench_file("default");
    description.projector.view = resized(description.projector.view, kSmallWidth, kSmallHeight);
    description.camera.view = resized(description.camera.view, 432, 288);
    return description;
}

inline std::shared_ptr<const Product> small_bench_product() {
    static const std::shared_ptr<const Product> product =
        find_product(small_bench_description().product.string());
    return product;
}

/// Smooth random colours, Rec.709 values in [0.12, 0.72] of design white: inside the gamut of every
/// projector here but for shadows. Waves of 50 to 200 px; coverage 1.
inline ImageF smooth_colours(int width, int height, std::uint64_t seed) {
    Random random(seed, 1);
    constexpr int kWaves = 3;
    struct Wave {
        glm::dvec2 per_px{0.0};
        double phase = 0.0;
    } waves[3][kWaves];
    for (auto& channel : waves)
        for (Wave& wave : channel) {
            const double angle = 2.0 * std::numbers::pi * random.uniform();
            const double length_px = 50.0 + 150.0 * random.uniform();
            wave.per_px =
                2.0 * std::numbers::pi / length_px * glm::dvec2(std::cos(angle), std::sin(angle));
            wave.phase = 2.0 * std::numbers::pi * random.uniform();
        }
    ImageF wanted(width, height, 4, 1.0f);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            glm::dvec3 rec709(0.42);
            for (int c = 0; c < 3; ++c)
                for (const Wave& wave : waves[c])
                    rec709[c] += 0.30 / kWaves *
                                 std::sin(wave.per_px.x * x + wave.per_px.y * y + wave.phase);
            const glm::dvec3 working = working_from_rec709() * rec709;
            for (int c = 0; c < 3; ++c) wanted.at(x, y, c) = static_cast<float>(working[c]);
        }
    return wanted;
}

inline CalibrationSettings live_settings(const BenchDescription& description, int shots = 1) {
    CalibrationSettings options;
    options.width = description.projector.view.width;
    options.height = description.projector.view.height;
    options.shots = shots;
    return options;
}

/// What the observer sees of a calibration: smooth colours corrected with it against wanted.
struct Judged {
    CalibrationResult live;
    Comparison comparison;
};

inline std::string all_warnings(const ColourCalibration& calibration) {
    std::string text;
    for (const std::string& warning : calibration.warnings) text += warning + "\n";
    return text;
}

/// In smooth colours over the whole picture, or over the mock-up's pixels alone.
inline Judged judged(const Bench& bench, CalibrationResult live, const Image8* mockup = nullptr) {
    Judged result;
    bool masked_is_black = true;
    const ColourCalibration& calibration = live.calibration;
    const double design_white_y =
        design_white_luminance(calibration, 20.0, mockup ? *mockup : bench.truth().lit);
    ImageF wanted = smooth_colours(calibration.width, calibration.height, 7);
    for (std::size_t i = 0; mockup && i < mockup->values.size(); ++i)
        wanted.values[4 * i + 3] = mockup->values[i] ? 1.0f : 0.0f;
    const Image8 drive = compensate(bake(calibration, design_white_y), wanted);
    const ImageF wanted_xyz = xyz_from_wanted(wanted, design_white_y);
    ComparisonMasks masks{bench.truth().lit,
                          bench.truth().edge,
                          Image8(calibration.width, calibration.height, 1),
                          bench.reachable(wanted_xyz)};
    for (std::size_t i = 0; i < masks.valid.values.size(); ++i) {
        const bool valid = is_valid(static_cast<PixelStatus>(calibration.status.values[i]));
        masks.valid.values[i] = valid ? 255 : 0;
    }
    // Around what is known light fades to black, and goes no farther.
    const std::vector<std::uint32_t> lit = lit_pixels(calibration.status).pixels;
    for (std::size_t i = 0; i < masks.valid.values.size(); ++i) {
        const bool is_lit =
            std::binary_search(lit.begin(), lit.end(), static_cast<std::uint32_t>(i));
        for (std::size_t c = 0; c < 3; ++c)
            masked_is_black &= is_lit || drive.values[3 * i + c] == 0;
    }
    const Comparison& comparison = result.comparison =
        compare_xyz(wanted_xyz, bench.observe_xyz(drive), design_white_y * d65_xyz(), masks);
    std::printf("    CIEDE2000 median %.3f, p95 %.3f; valid %.1f%%, reachable %.1f%%\n",
                comparison.interior.median,
                comparison.interior.p95,
                100.0 * comparison.valid_fraction,
                100.0 * comparison.reachable_fraction);
    EXPECT_TRUE(masked_is_black) << "a pixel is lit with nothing known around it";
    EXPECT_GT(comparison.interior.pixels, 1000u);
    result.live = std::move(live);
    return result;
}

/// A new bench of that description, calibrated and judged.
inline Judged session_on(const BenchDescription& description, int shots = 1) {
    Bench bench = testing::bench_on_kept_light(description, small_bench_product());
    return judged(bench, calibrate_live(bench.ports(), live_settings(description, shots)));
}

/// The small bench with no nuisance, calibrated and judged once for all tests.
inline const Judged& clean_session() {
    static const Judged judged = session_on(small_bench_description());
    return judged;
}

/// The ports of a bench whose photographs `damage` changes; it gets their number.
template <typename Damage>
BenchPorts damaged(Bench& bench, const Damage& damage) {
    BenchPorts ports = bench.ports();
    ports.photograph = [damage, take = ports.photograph, count = 0](double exposure_s) mutable {
        Photograph photograph = take(exposure_s);
        damage(photograph, count++);
        return photograph;
    };
    return ports;
}

inline std::size_t count_of(const ColourCalibration& calibration, PixelStatus status) {
    return static_cast<std::size_t>(std::count(calibration.status.values.begin(),
                                               calibration.status.values.end(),
                                               static_cast<std::uint8_t>(status)));
}

/// Why and fix of the refusal that is expected; empty (and a failure) when there is none.
struct Refusal {
    std::string why, fix;
};
template <typename Call>
Refusal refusal_of(const Call& call) {
    try {
        call();
    } catch (const Refused& refused) {
        EXPECT_FALSE(refused.fix().empty()) << refused.why();
        return {refused.why(), refused.fix()};
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
}

}  // namespace livery::testing
