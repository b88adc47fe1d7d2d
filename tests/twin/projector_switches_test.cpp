// Each nuisance of the projector does what docs/bench.md says, and nothing when it is off.
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/colour.h"
#include "small_bench.h"
#include "twin/projector_light.h"

namespace livery {
namespace {

using namespace livery::testing;

/// A picture with something of everything, and its border pixels not special.
Image8 busy_picture(const ProjectorDescription& projector) {
    Image8 picture(projector.view.width, projector.view.height, 3);
    for (std::size_t k = 0; k < picture.values.size(); ++k) {
        picture.values[k] = static_cast<std::uint8_t>((k * 2654435761u) >> 24u);
    }
    return picture;
}

TEST(ProjectorSwitches, OffIsBitIdentical) {
    const ProjectorDescription plain = wall_bench().projector;
    ProjectorDescription on = plain;
    on.leak = 0.01;
    on.white_segment = 0.5;
    on.gamma_spread = 0.1;
    on.defocus_sigma_px = 0.7;
    const Image8 picture = busy_picture(plain);
    const auto reference = light_from_drive(plain, picture).values;
    EXPECT_NE(light_from_drive(on, picture).values, reference);
    on.leak = on.white_segment = on.gamma_spread = on.defocus_sigma_px = 0.0;
    EXPECT_EQ(light_from_drive(on, picture).values, reference);
}

TEST(ProjectorSwitches, LeakIsAddedToEachChannel) {
    ProjectorDescription projector = wall_bench().projector;
    const Image8 picture = busy_picture(projector);
    const ImageF plain = light_from_drive(projector, picture);
    projector.leak = 0.002;
    const ImageF leaking = light_from_drive(projector, picture);
    for (std::size_t k = 0; k < plain.values.size(); ++k) {
        const float expected = k % 4 == 3 ? 0.0f : 0.002f;  // the clear segment does not leak
        EXPECT_NEAR(leaking.values[k] - plain.values[k], expected, 1e-7f);
    }
}

TEST(ProjectorSwitches, GammaGrowsTowardTheCorners) {
    ProjectorDescription projector = wall_bench().projector;
    projector.gamma = glm::dvec3(2.0);
    projector.gamma_spread = 0.1;
    Image8 grey(projector.view.width, projector.view.height, 3, 128);
    const ImageF light = light_from_drive(projector, grey);
    const double x = 128.0 / 255.0;
    // The middle pixel is .4% of the half diagonal off; the corner pixel .5% short of it.
    EXPECT_NEAR(light.at(80, 60, 0), std::pow(x, 2.0), 1e-5);
    EXPECT_NEAR(light.at(0, 0, 0), std::pow(x, 2.2), 2e-3 * std::pow(x, 2.2));
    EXPECT_NEAR(channel_light(projector, 0, x, 0.5), std::pow(x, 2.05), 1e-12);
}

TEST(ProjectorSwitches, DefocusSpreadsAPixelByItsSigmaAndKeepsItsLight) {
    ProjectorDescription projector = wall_bench().projector;
    projector.defocus_sigma_px = 1.5;
    Image8 dot(projector.view.width, projector.view.height, 3);
    for (int c = 0; c < 3; ++c) dot.at(70, 50, c) = 255;
    const ImageF light = light_from_drive(projector, dot);
    double sum = 0.0, sum_xx = 0.0, sum_yy = 0.0;
    for (int y = 0; y < light.height; ++y) {
        for (int x = 0; x < light.width; ++x) {
            const double here = light.at(x, y, 1);
            sum += here;
            sum_xx += here * (x - 70) * (x - 70);
            sum_yy += here * (y - 50) * (y - 50);
        }
    }
    EXPECT_NEAR(sum, 1.0, 1e-5);
    // The kernel ends at 3.5 sigma or more: that costs at most .5% of the variance.
    EXPECT_NEAR(sum_xx, 2.25, 0.012);
    EXPECT_NEAR(sum_yy, 2.25, 0.012);
}

TEST(ProjectorSwitches, TheWhiteSegmentAddsItsShareOfWhatTheChannelsHaveInCommon) {
    BenchDescription description = wall_bench();
    description.projector.white_segment = 0.6;
    const Bench bench(description, product_of(make_wall()));
    const auto observed = [&](int r, int g, int b) {
        const ImageF xyz = bench.observe_xyz(filled(description, r, g, b));
        return glm::dvec3(xyz.at(80, 60, 0), xyz.at(80, 60, 1), xyz.at(80, 60, 2));
    };
    // Single channels and pairs add up; white is brighter by 60%.
    const glm::dvec3 red = observed(255, 0, 0), green = observed(0, 255, 0),
                     blue = observed(0, 0, 255);
    const glm::dvec3 sum = red + green + blue;
    EXPECT_NEAR(glm::distance(observed(255, 255, 0), red + green), 0.0, 1e-6);
    EXPECT_NEAR(observed(255, 255, 255).y / sum.y, 1.6, 1e-5);
    // The segment's own colour: the lamp behind clear glass is no sum of the primaries.
    const glm::dvec3 clear = observed(255, 255, 255) - sum;
    EXPECT_GT(glm::distance(clear / clear.y, sum / sum.y), 0.05);
    // It follows the smallest channel's light.
    const glm::dvec3 half =
        observed(255, 255, 128) - observed(255, 255, 0) - (observed(0, 0, 128) - observed(0, 0, 0));
    EXPECT_NEAR(half.y / clear.y, std::pow(128.0 / 255.0, 2.2), 1e-4);
}

TEST(ProjectorSwitches, VignettingTakesItsShareInTheCorners) {
    BenchDescription description = wall_bench();
    const Bench plain(description, product_of(make_wall()));
    description.projector.vignetting = 0.3;
    const Bench dim(description, product_of(make_wall()));
    const Image8 white = filled(description, 255, 255, 255);
    const ImageF a = plain.observe_xyz(white), b = dim.observe_xyz(white);
    for (const auto& [x, y] : {std::pair(80, 60), std::pair(5, 60), std::pair(2, 2)}) {
        const double dx = (x + 0.5 - 80.0), dy = (y + 0.5 - 60.0);
        const double radius2 = (dx * dx + dy * dy) / (80.0 * 80.0 + 60.0 * 60.0);
        // Samples are jittered inside the pixel: .1% of the corner's slope.
        EXPECT_NEAR(b.at(x, y, 1) / a.at(x, y, 1), 1.0 - 0.3 * radius2, 5e-4) << x;
    }
}

TEST(ProjectorSwitches, FlickerVariesTheLampBetweenPhotographsAndNotTheTruth) {
    BenchDescription description = wall_bench();
    description.projector.flicker = 0.01;
    Bench bench(description, product_of(make_wall()));
    auto ports = bench.ports();
    ports.show(filled(description, 255, 255, 255));
    const glm::dvec3 truth = ports.measure_xyz({80.5, 60.5});
    std::vector<double> lamps;
    for (int k = 0; k < 80; ++k) {
        const Photograph p = ports.photograph(0.0);
        lamps.push_back(p.image.at(120, 90, 1) - p.black_level);
    }
    double mean = 0.0, variance = 0.0;
    for (const double lamp : lamps) mean += lamp / 80.0;
    for (const double lamp : lamps) variance += (lamp - mean) * (lamp - mean) / 79.0;
    // 80 draws know a standard deviation to 8%: three of those.
    EXPECT_NEAR(std::sqrt(variance) / mean, 0.01, 0.0024);
    EXPECT_EQ(ports.measure_xyz({80.5, 60.5}), truth);
}

TEST(ProjectorSwitches, DriftGrowsWithEachPhotograph) {
    BenchDescription description = wall_bench();
    description.projector.drift_per_photograph = -0.002;
    Bench bench(description, product_of(make_wall()));
    auto ports = bench.ports();
    ports.show(filled(description, 255, 255, 255));
    const double first = ports.photograph(0.0).image.at(120, 90, 1) - 1024.0;
    for (int k = 1; k < 10; ++k) ports.photograph(0.0);
    const double later = ports.photograph(0.0).image.at(120, 90, 1) - 1024.0;
    EXPECT_NEAR(later / first, 0.98, 2e-4);  // whole units of 10^4
}

TEST(ProjectorSwitches, LatePicturesStillShowTheOneBefore) {
    BenchDescription description = wall_bench();
    description.projector.latency_photographs = 2;
    Bench bench(description, product_of(make_wall()));
    auto ports = bench.ports();
    const auto brightness = [&] { return ports.photograph(0.0).image.at(120, 90, 1) - 1024.0; };
    ports.show(filled(description, 255, 255, 255));
    EXPECT_EQ(brightness(), 0.0);  // dark before anything was shown
    EXPECT_EQ(brightness(), 0.0);
    const double white = brightness();
    EXPECT_GT(white, 1000.0);
    ports.show(filled(description, 0, 0, 0));
    EXPECT_EQ(brightness(), white);
    EXPECT_EQ(brightness(), white);
    EXPECT_EQ(brightness(), 0.0);
    EXPECT_EQ(brightness(), 0.0);
}

}  // namespace
}  // namespace livery
