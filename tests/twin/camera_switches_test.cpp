// Each nuisance of the camera does what docs/bench.md says, and nothing when it is off.
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/colour.h"
#include "small_bench.h"
#include "twin/sensor.h"

namespace livery {
namespace {

using namespace livery::testing;

CameraDescription noisy_camera() {
    CameraDescription camera;
    camera.electrons_per_unit = 8.0;
    camera.read_noise_units = 5.0;
    return camera;
}

struct Statistics {
    double mean = 0.0, variance = 0.0;
};
Statistics statistics(const ImageF& image, int channel) {
    Statistics s;
    const double n = static_cast<double>(image.pixel_count());
    for (std::size_t k = 0; k < image.pixel_count(); ++k) {
        s.mean += image.values[3 * k + static_cast<std::size_t>(channel)] / n;
    }
    for (std::size_t k = 0; k < image.pixel_count(); ++k) {
        const double d = image.values[3 * k + static_cast<std::size_t>(channel)] - s.mean;
        s.variance += d * d / (n - 1.0);
    }
    return s;
}

TEST(CameraSwitches, PhotonTransferHasTheGainAndTheReadNoise) {
    // variance = signal / electrons_per_unit + read noise^2 + 1/12 for whole units.
    const CameraDescription camera = noisy_camera();
    for (const float signal : {0.0f, 100.0f, 1000.0f, 4000.0f, 12000.0f}) {
        const ImageF light(512, 512, 3, signal);
        const ImageF file = develop(camera, light, 1.0, 1, 7);
        for (int c = 0; c < 3; ++c) {
            const Statistics s = statistics(file, c);
            const double variance = signal / 8.0 + 25.0 + 1.0 / 12.0;
            // 262144 draws: the mean to sd / 512, the variance to .28%; four of each.
            EXPECT_NEAR(s.mean, 1024.0 + signal, 4.0 * std::sqrt(variance) / 512.0) << signal;
            EXPECT_NEAR(s.variance / variance, 1.0, 0.011) << signal << " " << c;
        }
    }
}

TEST(CameraSwitches, NoiseIsIndependentBetweenPixelsChannelsAndPhotographs) {
    const CameraDescription camera = noisy_camera();
    const ImageF light(256, 256, 3, 2000.0f);
    const ImageF a = develop(camera, light, 1.0, 1, 0), b = develop(camera, light, 1.0, 1, 1);
    const double variance = 2000.0 / 8.0 + 25.0;
    const auto correlation = [&](const ImageF& p, const ImageF& q, std::size_t shift) {
        double sum = 0.0;
        const std::size_t n = p.values.size() - shift;
        for (std::size_t k = 0; k < n; ++k) {
            sum += (p.values[k] - 3024.0) * (q.values[k + shift] - 3024.0);
        }
        return sum / (static_cast<double>(n) * variance);
    };
    // 196608 products: standard deviation .0023; four of it.
    EXPECT_NEAR(correlation(a, b, 0), 0.0, 0.009);
    for (const std::size_t shift : {1u, 2u, 3u, 6u, 768u, 769u, 771u}) {
        EXPECT_NEAR(correlation(a, a, shift), 0.0, 0.009) << shift;
    }
}

TEST(CameraSwitches, WithoutNoiseTheFileIsTheRoundedLight) {
    CameraDescription camera;
    ImageF light(64, 4, 3);
    for (std::size_t k = 0; k < light.values.size(); ++k) light.values[k] = 20.3f * float(k);
    const ImageF file = develop(camera, light, 0.5, 1, 0);
    for (std::size_t k = 0; k < file.values.size(); ++k) {
        EXPECT_EQ(file.values[k], std::min(16383.0f, std::round(0.5f * light.values[k] + 1024.0f)));
    }
}

TEST(CameraSwitches, LightBeyondFullScaleIsClipped) {
    const ImageF file = develop(noisy_camera(), ImageF(32, 32, 3, 50'000.0f), 1.0, 1, 0);
    for (const float value : file.values) ASSERT_EQ(value, 16383.0f);
}

TEST(CameraSwitches, EightBitFilesFollowTheCurveOfSrgb) {
    CameraDescription camera;
    camera.encoding = CameraEncoding::srgb8;
    EXPECT_EQ(saturates_at(camera), 255.0);
    EXPECT_EQ(black_level(camera), 0.0);
    ImageF light(512, 2, 3);
    for (std::size_t k = 0; k < light.values.size(); ++k) light.values[k] = 5.1f * float(k);
    const ImageF file = develop(camera, light, 1.0, 1, 0);
    for (std::size_t k = 0; k < file.values.size(); ++k) {
        const double linear = light.values[k] / 15359.0;
        EXPECT_EQ(file.values[k], std::round(file.values[k]));
        if (linear > 1.0) {
            EXPECT_EQ(file.values[k], 255.0f);
        } else if (linear > 0.005) {
            // Half a step of the file, and half a unit before it.
            EXPECT_NEAR(file.values[k], 255.0 * srgb_encode(linear), 0.51 + 0.05 / linear * 1e-2);
        }
    }
}

TEST(CameraSwitches, FlareTakesItsShareAndSpreadsItWide) {
    ImageF light(480, 320, 3);
    for (int y = 120; y < 200; ++y) {
        for (int x = 200; x < 280; ++x) {
            for (int c = 0; c < 3; ++c) light.at(x, y, c) = 1000.0f;
        }
    }
    const ImageF flared = with_flare(light, 0.05, 0.2);
    // A Gaussian of 96 px around a square of 80 px: closed form, erf in both axes.
    const auto spread = [](double at, double low, double high) {
        const double s = 96.0 * std::sqrt(2.0);
        return 0.5 * (std::erf((high - at) / s) - std::erf((low - at) / s));
    };
    for (const auto& [x, y] : {std::pair(240, 160), std::pair(300, 160), std::pair(240, 60)}) {
        const double scattered =
            50.0 * spread(x + 0.5, 200.0, 280.0) * spread(y + 0.5, 120.0, 200.0);
        const double own = 0.95 * light.at(x, y, 1);
        // Cells of 16 px add 64 to the variance of 9216 and the kernel ends at 3 sigma: 1%.
        EXPECT_NEAR(flared.at(x, y, 1) - own, scattered, 0.01 * scattered) << x << " " << y;
        EXPECT_GT(flared.at(x, y, 1), own);
    }
}

TEST(CameraSwitches, VignettingDarkensTheCornersOfThePhotograph) {
    BenchDescription description = wall_bench();
    Bench plain(description, product_of(make_wall()));
    description.camera.vignetting = 0.4;
    Bench dark(description, product_of(make_wall()));
    const Image8 white = filled(description, 255, 255, 255);
    plain.ports().show(white);
    dark.ports().show(white);
    const double exposure = plain.default_exposure_s();
    const Photograph a = plain.ports().photograph(exposure), b = dark.ports().photograph(exposure);
    for (const auto& [x, y] : {std::pair(120, 90), std::pair(30, 100), std::pair(200, 150)}) {
        const double dx = x + 0.5 - 120.0, dy = y + 0.5 - 90.0;
        const double radius2 = (dx * dx + dy * dy) / (120.0 * 120.0 + 90.0 * 90.0);
        EXPECT_NEAR((b.image.at(x, y, 1) - 1024.0) / (a.image.at(x, y, 1) - 1024.0),
                    1.0 - 0.4 * radius2,
                    3e-4);
    }
    // The observer's truth has nothing to do with the camera.
    EXPECT_EQ(plain.observe_xyz(white).values, dark.observe_xyz(white).values);
}

TEST(CameraSwitches, ShiftDisplacesThePictureByItsAmount) {
    // A smooth hump: its centroid moves with the picture.
    ImageF light(240, 180, 3);
    for (int y = 0; y < 180; ++y) {
        for (int x = 0; x < 240; ++x) {
            const double r2 =
                std::pow((x + 0.5 - 120.0) / 12.0, 2) + std::pow((y + 0.5 - 90.0) / 12.0, 2);
            for (int c = 0; c < 3; ++c) light.at(x, y, c) = float(1000.0 * std::exp(-0.5 * r2));
        }
    }
    const ImageF moved = shifted(light, 1.0);
    double sum = 0.0, mean_x = 0.0, mean_y = 0.0;
    for (int y = 0; y < 180; ++y) {
        for (int x = 0; x < 240; ++x) {
            sum += moved.at(x, y, 0);
            mean_x += moved.at(x, y, 0) * (x + 0.5);
            mean_y += moved.at(x, y, 0) * (y + 0.5);
        }
    }
    // In the picture's middle the displacement is 80% of the largest, along (.8, .6).
    EXPECT_NEAR(mean_x / sum - 120.0, 0.64, 0.01);
    EXPECT_NEAR(mean_y / sum - 90.0, 0.48, 0.01);
}

TEST(CameraSwitches, TheCameraSagsOverItsPhotographsAndOffIsBitIdentical) {
    BenchDescription description = wall_bench();
    Bench still(description, product_of(make_wall()));
    description.camera.shift_px = 1.0;
    description.camera.shift_photographs = 4;
    Bench sagging(description, product_of(make_wall()));
    Image8 edge(160, 120, 3);
    for (int y = 0; y < 120; ++y) {
        for (int x = 80; x < 160; ++x) edge.at(x, y, 1) = 255;
    }
    still.ports().show(edge);
    sagging.ports().show(edge);
    const auto place = [](const Photograph& p) {  // columns left of the edge, in pixels
        double light = 0.0;
        const float full = p.image.at(180, 90, 1) - 1024.0f;
        for (int x = 60; x < 180; ++x) light += (p.image.at(x, 90, 1) - 1024.0) / full;
        return -light;
    };
    const double exposure = still.default_exposure_s();
    const Photograph reference = still.ports().photograph(exposure);
    std::vector<double> places;
    for (int k = 0; k < 7; ++k) {
        const Photograph p = sagging.ports().photograph(exposure);
        if (k == 0) {
            EXPECT_EQ(p.image.values, reference.image.values);
        }
        places.push_back(place(p) - place(reference));
    }
    // .8 x (60% + 40% x .5) at most, plus the .6 px that a slanted edge moves with the rows.
    EXPECT_GT(places[4], 0.5);
    EXPECT_LT(places[4], 1.0);
    EXPECT_NEAR(places[2], 0.5 * places[4], 0.06);
    EXPECT_NEAR(places[6], places[4], 1e-9);
}

TEST(CameraSwitches, NoiseDoesNotReachTheTruth) {
    BenchDescription description = wall_bench();
    const Bench plain(description, product_of(make_wall()));
    description.camera.electrons_per_unit = 3.0;
    description.camera.read_noise_units = 20.0;
    description.camera.flare = 0.1;
    description.camera.shift_px = 3.0;
    description.camera.encoding = CameraEncoding::srgb8;
    const Bench bad(description, product_of(make_wall()));
    const Image8 picture = filled(description, 90, 160, 220);
    EXPECT_EQ(plain.observe_xyz(picture).values, bad.observe_xyz(picture).values);
}

}  // namespace
}  // namespace livery
