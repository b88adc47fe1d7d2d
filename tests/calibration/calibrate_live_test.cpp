#include "calibration/calibrate_live.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>

#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "calibration/support/messages.h"
#include "calibration/support/synthetic_bench.h"
#include "core/error.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using testing::SyntheticBench;

/// The synthetic bench behind the three ports, with a projector that may be late.
struct LiveBench {
    SyntheticBench bench;
    glm::dmat3 xyz_from_camera{0.4, 0.2, 0.02, 0.3, 0.7, 0.1, 0.2, 0.1, 0.9};
    int latency = 0;
    double drift_per_photograph = 0.0;
    double steps_per_stop = 0.0;  ///< of its shutter; 0: any time
    bool frozen = false;
    std::function<void(int photograph, int& latency)> before_photograph = [](int, int&) {};

    Image8 visible, pending;
    int late = 0, photographs = 0;

    LiveBench() {
        bench.projector_width = 160;
        bench.projector_height = 104;
        bench.camera_width = 212;
        bench.camera_height = 146;
        bench.read_noise = 2.0;
        bench.file_units_per_light = bench.units_per_light();
        bench.exposure_s = 0.013;  // far from right
        visible = pending = Image8(160, 104, 3, 128);
    }
    LiveBench(const LiveBench&) = delete;
    LiveBench& operator=(const LiveBench&) = delete;

    BenchPorts ports() {
        BenchPorts p;
        p.show = [this](const Image8& drive) {
            if (late > 0) visible = pending;
            pending = drive;
            late = latency;
            if (late == 0 && !frozen) visible = pending;
        };
        p.photograph = [this](double exposure_s) {
            before_photograph(photographs, late);
            if (exposure_s > 0.0) bench.exposure_s = nearest_time_s(exposure_s);
            const Photograph photo = bench.photograph(visible);
            if (late > 0 && --late == 0 && !frozen) visible = pending;
            ++photographs;
            bench.lamp *= 1.0 + drift_per_photograph;
            return photo;
        };
        p.measure_xyz = [this](glm::dvec2 place) {
            const std::uint8_t* const d =
                pending.pixel(static_cast<int>(place.x), static_cast<int>(place.y));
            return xyz_from_camera * bench.camera_colour({d[0], d[1], d[2]}, place);
        };
        return p;
    }
    double nearest_time_s(double exposure_s) const {
        if (steps_per_stop == 0.0) return exposure_s;
        return std::exp2(std::round(steps_per_stop * std::log2(exposure_s)) / steps_per_stop);
    }
    CalibrationResult run(int shots = 1, const Progress& progress = {}) {
        CalibrationSettings options;
        options.width = 160;
        options.height = 104;
        options.shots = shots;
        return calibrate_live(ports(), options, progress);
    }
};

double largest_relative_difference(const glm::dmat3& a, const glm::dmat3& b) {
    double largest = 0.0;
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) largest = worse_of(largest, std::abs(a[k][c] - b[k][c]));
    return largest;
}

TEST(CalibrateLive, FindsExposureMapMixingAndXyz) {
    LiveBench live;
    std::vector<double> fractions;
    Progress progress;
    progress.report = [&](double fraction, std::string_view stage) {
        fractions.push_back(fraction);
        EXPECT_FALSE(stage.empty());
    };
    const CalibrationResult result = live.run(1, progress);
    EXPECT_EQ(result.colour_photographs, 6);
    EXPECT_EQ(result.latency_photographs, 0);
    EXPECT_EQ(result.captures.size(), 6u);
    EXPECT_EQ(result.calibration.xyz_origin, "primaries");
    // The neighbourhood's mean of 0.02% noise
    EXPECT_LT(largest_relative_difference(result.calibration.xyz_from_camera, live.xyz_from_camera),
              2e-3);
    EXPECT_GT(result.calibration.valid_fraction, 0.9);
    EXPECT_LT(result.calibration.additivity_error, 1e-3);
    EXPECT_TRUE(result.calibration.warnings.empty()) << result.calibration.warnings.front();
    ColourCalibration sealed = result.calibration;
    seal(sealed);
    EXPECT_EQ(result.calibration.id, sealed.id);
    // Exposure: white peaks between 60% and 85%, in every channel
    float peak = 0.0f;
    for (const float v : result.captures[1].photograph.image.values) peak = std::max(peak, v);
    EXPECT_GT((peak - 256.0) / 16000.0, 0.6);
    EXPECT_LT((peak - 256.0) / 16000.0, 0.86);
    // The projector is black at the end, and progress never went back.
    EXPECT_EQ(*std::max_element(live.visible.values.begin(), live.visible.values.end()), 0);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_LE(fractions.back(), 1.0);
}

TEST(CalibrateLive, ShowsFringesWhereTheyAreAskedForAndUsesThem) {
    // At as many camera pixels as projector pixels both grids run in step, and the rounding to
    // whole pixels stays in the map: 1 / sqrt(6) px. Three samples a side of a camera pixel see
    // thirds of a projector pixel, so that of fringes a third of that stays.
    const auto error_of = [](PlaceCode places, int& photographs) {
        LiveBench live;
        live.bench.sub_samples = 3;
        live.bench.projector_from_camera = [](glm::dvec2 c) -> std::optional<glm::dvec2> {
            return glm::dvec2(c.x + 0.01 * c.y - 20.3, c.y - 0.01 * c.x - 18.2);
        };
        CalibrationSettings options;
        options.width = 160;
        options.height = 104;
        options.places = places;
        const LiveMap found = photograph_map(live.ports(), options);
        EXPECT_TRUE(found.warnings.empty());
        photographs = live.photographs;
        const ProjectorToCamera exact = live.bench.exact_map();
        double squares = 0.0;
        int count = 0;
        for (int y = 12; y < 92; ++y)
            for (int x = 12; x < 148; ++x) {
                const double dx = found.map.camera_px.at(x, y, 0) - exact.camera_px.at(x, y, 0);
                const double dy = found.map.camera_px.at(x, y, 1) - exact.camera_px.at(x, y, 1);
                if (found.map.edge.at(x, y) || !std::isfinite(dx + dy)) continue;
                squares += dx * dx + dy * dy;
                ++count;
            }
        EXPECT_GT(count, 136 * 80 * 0.95);
        const double rms = std::sqrt(squares / count);
        std::printf(
            "map off by %.4f camera px, said to be %.4f an axis\n", rms, found.map.sigma_px);
        return rms;
    };
    int of_gray = 0, of_both = 0;
    const double gray = error_of(PlaceCode::gray, of_gray);
    const double both = error_of(PlaceCode::gray_and_phase, of_both);
    EXPECT_EQ(of_both, of_gray + 10);
    EXPECT_LT(both, 0.15);
    EXPECT_LT(both, 0.4 * gray);
}

TEST(CalibrateLive, FindsExposureFromFarTooDarkAndFarTooBright) {
    for (const double start : {2e-5, 8.0}) {
        LiveBench live;
        live.bench.exposure_s = start;
        const CalibrationResult result = live.run();
        EXPECT_GT(result.calibration.valid_fraction, 0.9) << start;
        EXPECT_NEAR(result.captures[0].photograph.exposure_s, 0.1, 0.02) << start;
    }
}

TEST(CalibrateLive, FindsExposureAmongTheStepsOfAShutter) {
    constexpr int kBetweenStops = 5;
    for (const double steps_per_stop : {3.0, 2.0, 1.0})
        for (int k = 0; k < kBetweenStops; ++k) {
            SCOPED_TRACE(::testing::Message() << steps_per_stop << " a stop, place " << k);
            LiveBench live;
            live.steps_per_stop = steps_per_stop;
            live.bench.exposure_s = live.nearest_time_s(0.013);
            live.bench.file_units_per_light *= std::exp2(k / static_cast<double>(kBetweenStops));
            const CalibrationResult result = live.run();
            float peak = 0.0f;
            for (const float v : result.captures[1].photograph.image.values)
                peak = std::max(peak, v);
            EXPECT_LT((peak - 256.0) / 16000.0, 0.86);
            EXPECT_GT((peak - 256.0) / 16000.0, steps_per_stop == 1.0 ? 0.4 : 0.59);
        }
}

TEST(CalibrateLive, WaitsForALateProjector) {
    for (const int latency : {1, 3}) {
        LiveBench live;
        live.latency = latency;
        const CalibrationResult result = live.run();
        EXPECT_EQ(result.latency_photographs, latency);
        EXPECT_LT(
            largest_relative_difference(result.calibration.xyz_from_camera, live.xyz_from_camera),
            2e-3);
        ASSERT_EQ(result.calibration.warnings.size(), 1u);
        EXPECT_HAS(result.calibration.warnings[0], std::to_string(latency) + " photograph");
    }
}

TEST(CalibrateLive, RepeatsWhatCameLateOnce) {
    // Three pictures (a stripe picture, an inverse, a colour) arrive one photograph late.
    LiveBench live;
    int shown = 0;
    BenchPorts ports = live.ports();
    const ShowPicture show = ports.show;
    ports.show = [&](const Image8& drive) {
        ++shown;
        live.latency = shown == 9 || shown == 22 || shown == 38 ? 1 : 0;
        show(drive);
    };
    CalibrationSettings options;
    options.width = 160;
    options.height = 104;
    options.shots = 1;
    const CalibrationResult result = calibrate_live(ports, options);
    EXPECT_LT(result.calibration.additivity_error, 1e-3);
    EXPECT_LT(largest_relative_difference(result.calibration.xyz_from_camera, live.xyz_from_camera),
              2e-3);
}

TEST(CalibrateLive, ShowsMosaicsWhereWhiteIsNotTheSum) {
    LiveBench live;
    live.bench.white_segment = 0.8;
    const CalibrationResult result = live.run();
    EXPECT_EQ(result.colour_photographs, 12);
    EXPECT_EQ(result.patterns.size(), 12u);
    EXPECT_GT(result.calibration.table.grid, 0);
    EXPECT_NEAR(result.calibration.additivity_error, 0.8 / 1.8, 1e-3);
}

// A projector that boosts pure colours: its stripes say that the files are linear, so that neither
// they nor white's exposure are blamed, and the mosaics describe it.
TEST(CalibrateLive, ShowsMosaicsWhereWhiteIsLessThanItsParts) {
    LiveBench live;
    live.bench.white_segment = -0.1;
    const CalibrationResult result = live.run();
    EXPECT_EQ(result.colour_photographs, 12);
    EXPECT_GT(result.calibration.table.grid, 0);
    EXPECT_NEAR(result.calibration.additivity_error, 0.1 / 0.9, 1e-3);
    ASSERT_EQ(result.calibration.warnings.size(), 1u);
    EXPECT_HAS(result.calibration.warnings[0], "a table of mosaic colours is used");
}

TEST(CalibrateLive, FollowsASlowLampAndRefusesAFastOne) {
    LiveBench slow;
    slow.drift_per_photograph = -5e-4;
    const CalibrationResult result = slow.run();
    EXPECT_LT(result.calibration.additivity_error, 1e-3);
    LiveBench fast;
    fast.drift_per_photograph = -4e-3;
    EXPECT_HAS(message_of<Refused>([&] { fast.run(); }), "lamp");
    LiveBench flicker;
    flicker.before_photograph = [&](int photograph, int&) {
        flicker.bench.lamp = photograph % 3 == 0 ? 0.97 : 1.0;
    };
    EXPECT_HAS(message_of<Refused>([&] { flicker.run(); }), "from one to the next");
    LiveBench later;  // steady for the stripes
    later.before_photograph = [&](int photograph, int&) {
        later.bench.lamp = photograph > 50 && photograph % 3 == 0 ? 0.97 : 1.0;
    };
    EXPECT_HAS(message_of<Refused>([&] { later.run(4); }), "differ by 3.0");
}

TEST(CalibrateLive, SaysWhatIsWrongWithTheSetUp) {
    LiveBench off;
    off.bench.mixing = glm::dmat3(0.0);
    EXPECT_HAS(message_of<Refused>([&] { off.run(); }), "sees no light of the projector");

    LiveBench freezes;
    freezes.before_photograph = [&](int photograph, int&) { freezes.frozen = photograph > 46; };
    EXPECT_HAS(message_of<Refused>([&] { freezes.run(); }),
               "shows no change from the picture before");

    LiveBench bad;
    EXPECT_THROW(calibrate_live(BenchPorts{}, CalibrationSettings{}), std::invalid_argument);
    CalibrationSettings options;
    options.width = 160;
    options.height = 104;
    options.shots = 0;
    EXPECT_HAS(message_of<std::invalid_argument>([&] { calibrate_live(bad.ports(), options); }),
               "shots 0");
    options.shots = 1;
    BenchPorts ports = bad.ports();
    ports.photograph = [](double) { return Photograph{}; };
    EXPECT_HAS(message_of<FileError>([&] { calibrate_live(ports, options); }), "camera: ");
}

TEST(CalibrateLive, StopsBetweenPhotographs) {
    LiveBench live;
    std::atomic<bool> stop{false};
    Progress progress;
    progress.stop = &stop;
    live.before_photograph = [&](int photograph, int&) { stop = photograph >= 20; };
    EXPECT_THROW(live.run(1, progress), Cancelled);
    EXPECT_LE(live.photographs, 21);
}

TEST(CalibrateLive, WithoutAColorimeterTheMatrixIsLabelledAsAssumed) {
    LiveBench live;
    BenchPorts ports = live.ports();
    ports.measure_xyz = nullptr;
    CalibrationSettings options;
    options.width = 160;
    options.height = 104;
    options.shots = 1;
    EXPECT_EQ(calibrate_live(ports, options).calibration.xyz_origin, "assumed Rec.709");
}

}  // namespace
}  // namespace livery
