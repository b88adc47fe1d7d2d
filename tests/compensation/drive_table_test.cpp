// Projectors whose channels do not add up: the table's inverse, and the light that comes of it.
#include "compensation/drive_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "compensation/white_segment.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using synthetic::calibrate_segment;
using synthetic::make_world;
using synthetic::World;

class DriveTableTest : public ::testing::Test {
  protected:
    DriveTableTest()
        : world_(make_world(24, 16, 71)),
          calibration_(calibrate_segment(world_)),
          table_(make_non_additive(calibration_.table, calibration_.response)) {}

    World world_;
    ColourCalibration calibration_;
    NonAdditive table_;
};

// At the nodes the table is what was measured, whatever lies between them.
TEST_F(DriveTableTest, NodesAreReproduced) {
    for (int b = 0; b < 9; ++b) {
        for (int g = 0; g < 9; ++g) {
            for (int r = 0; r < 9; ++r) {
                const glm::vec3 n =
                    calibration_.table.n_from_drive[static_cast<std::size_t>(r + 9 * (g + 9 * b))];
                glm::vec3 residual;
                const glm::vec3 drive = drive_of_n(table_, n, &residual);
                EXPECT_NEAR(drive.r, 31.875f * static_cast<float>(r), 0.1f);
                EXPECT_NEAR(drive.g, 31.875f * static_cast<float>(g), 0.1f);
                EXPECT_NEAR(drive.b, 31.875f * static_cast<float>(b), 0.1f);
            }
        }
    }
}

// The inverse of what was measured, inside the gamut: better than half a level.
TEST_F(DriveTableTest, InverseIsBetterThanHalfALevel) {
    Random random(72);
    float worst = 0.0f;
    for (int i = 0; i < 20000; ++i) {
        glm::vec3 linear, drive;
        for (int k = 0; k < 3; ++k) {
            const double x = random.uniform();
            linear[k] = static_cast<float>(x * x);  // dark drives as often as bright ones
            drive[k] = look_up(table_.rho[static_cast<std::size_t>(k)], linear[k]);
        }
        glm::vec3 residual;
        const glm::vec3 found = drive_of_n(table_, n_at_linear(table_, linear, nullptr), &residual);
        for (int k = 0; k < 3; ++k) worst = worse_of(worst, std::abs(found[k] - drive[k]));
    }
    EXPECT_LT(worst, 0.5f);
}

// The unreachable: brute force over a fine grid finds no point that is much nearer than what the
// search found; "much" is the start grid's coarseness.
TEST_F(DriveTableTest, OutsideTheGamutGivesTheNearestPoint) {
    Random random(73);
    double worst_excess = 0.0, sum_excess = 0.0;
    const int count = 60;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 n(
            1.2 * random.uniform(), 0.25 * random.uniform() - 0.1, 1.2 * random.uniform());
        glm::vec3 residual;
        drive_of_n(table_, n, &residual);
        float nearest = 1e9f;
        for (int b = 0; b <= 32; ++b) {
            for (int g = 0; g <= 32; ++g) {
                for (int r = 0; r <= 32; ++r) {
                    const glm::vec3 there =
                        n_at_linear(table_, glm::vec3(r, g, b) / 32.0f, nullptr);
                    nearest = std::min(nearest, glm::length(there - n));
                }
            }
        }
        const double excess = static_cast<double>(glm::length(residual) - nearest);
        worst_excess = worse_of(worst_excess, excess);
        sum_excess += excess;
    }
    EXPECT_LT(worst_excess, 0.05);
    EXPECT_LT(sum_excess / count, 0.005);
}

struct Shown {
    double worst = 0.0, mean = 0.0, mean_ratio = 0.0, median_de = 0.0, p95_de = 0.0;
};

/// The whole way, against the projector itself and not against the table.
Shown show_random_colours(const World& world, const CompensationTable& table, double white_y) {
    Random random(74);
    const ImageF wanted = synthetic::picture(world, [&](std::size_t i) {
        const glm::dvec3 drive = synthetic::random_drive(random, 96.0, 250.0);
        return working_from_xyz() * (world.xyz_from_camera * segment_camera(world, i, drive)) /
               white_y;
    });
    CompensationStats stats;
    const Image8 out = compensate(table, wanted, &stats);
    EXPECT_LT(stats.out_of_gamut_fraction, 0.01);
    EXPECT_EQ(stats.invalid_fraction, 0.0);
    Shown shown;
    std::vector<double> de;
    for (std::size_t i = 0; i < world.mixing.size(); ++i) {
        const glm::dvec3 drive(out.values[3 * i], out.values[3 * i + 1], out.values[3 * i + 2]);
        const glm::dvec3 got = world.xyz_from_camera * segment_camera(world, i, drive) / white_y;
        const glm::dvec3 asked =
            xyz_from_working() *
            glm::dvec3(wanted.values[4 * i], wanted.values[4 * i + 1], wanted.values[4 * i + 2]);
        const double error = glm::length(got - asked) / glm::length(asked);
        shown.worst = worse_of(shown.worst, error);
        shown.mean += error / static_cast<double>(world.mixing.size());
        shown.mean_ratio += got.y / asked.y / static_cast<double>(world.mixing.size());
        de.push_back(
            worst_if_nan(ciede2000(lab_from_xyz(got, d65_xyz()), lab_from_xyz(asked, d65_xyz()))));
    }
    std::sort(de.begin(), de.end());
    shown.median_de = de[de.size() / 2];
    shown.p95_de = de[de.size() * 95 / 100];
    return shown;
}

// One mirror array serves all colours of a wheel, so its channels share one response; then the
// segment's crease lies on the tetrahedra's faces and only the 8 bits are left: a level is 2.3% of
// the light at drive 96 and 0.9% at 250, half of it on average far less.
TEST(WhiteSegment, SharedResponseLeavesOnlyTheEightBits) {
    World world = make_world(48, 32, 75);
    world.response[0] = world.response[2] = world.response[1];
    const Shown shown = show_random_colours(world, bake(calibrate_segment(world), 0.5), 0.5);
    EXPECT_LT(shown.worst, 0.023);
    EXPECT_LT(shown.mean, 0.006);
    EXPECT_NEAR(shown.mean_ratio, 1.0, 0.002);
}

// Responses that differ move the crease off the faces. What is to be reached with a clear segment:
// CIEDE2000 0.5 in the median and 1.0 for 95%.
TEST(WhiteSegment, DifferingResponsesStayWithinTheTarget) {
    const World world = make_world(48, 32, 76);
    const Shown nine = show_random_colours(world, bake(calibrate_segment(world, 9), 0.5), 0.5);
    EXPECT_LT(nine.median_de, 0.5);
    EXPECT_LT(nine.p95_de, 1.0);
    const Shown finer = show_random_colours(world, bake(calibrate_segment(world, 17), 0.5), 0.5);
    EXPECT_LT(finer.mean, nine.mean);
    EXPECT_LT(std::abs(finer.mean_ratio - 1.0), 0.004);
}

TEST_F(DriveTableTest, CountsAndSurvivesTheImpossible) {
    const CompensationTable table = bake(calibration_, 0.5);
    ImageF wanted(24, 16, 3, 50.0f);
    CompensationStats stats;
    for (const std::uint8_t level : compensate(table, wanted, &stats).values) {
        EXPECT_EQ(level, 255);
    }
    EXPECT_EQ(stats.clipped_high_fraction, 1.0);
    wanted = ImageF(24, 16, 3, -1.0f);
    for (const std::uint8_t level : compensate(table, wanted, &stats).values) EXPECT_EQ(level, 0);
    EXPECT_EQ(stats.clipped_low_fraction, 1.0);
    wanted = ImageF(24, 16, 3, std::numeric_limits<float>::quiet_NaN());
    for (const std::uint8_t level : compensate(table, wanted, &stats).values) EXPECT_EQ(level, 0);
    EXPECT_EQ(stats.invalid_fraction, 1.0);
}

// Design white of a clear segment: grey 255 is the brightest neutral-ish colour, and pure D65 can
// be no brighter than the channel that runs out first.
TEST_F(DriveTableTest, DesignWhiteIsReachable) {
    const double white = design_white_luminance(calibration_, 0.0, {});
    EXPECT_GT(white, 0.0);
    CompensationStats stats;
    compensate(bake(calibration_, white * 0.98), ImageF(24, 16, 3, 1.0f), &stats);
    EXPECT_EQ(stats.out_of_gamut_fraction, 0.0);
    compensate(bake(calibration_, white * 1.05), ImageF(24, 16, 3, 1.0f), &stats);
    EXPECT_GT(stats.out_of_gamut_fraction, 0.0);
}

TEST_F(DriveTableTest, WithoutAResponseTheTableStillWorks) {
    ColourCalibration bare = calibration_;
    for (ResponseCurve& curve : bare.response) curve.drive_from_n.clear();
    const Image8 out = compensate(bake(bare, 0.5), ImageF(24, 16, 3, 50.0f));
    for (const std::uint8_t level : out.values) EXPECT_EQ(level, 255);
}

// No light under drive 40 on one channel, and a step in another: what projectors do near black.
TEST_F(DriveTableTest, DeadZonesAndStepsStayFinite) {
    ColourCalibration odd = calibration_;
    std::vector<float>& red = odd.response[0].drive_from_n;
    for (std::size_t i = 1; i < red.size(); ++i) red[i] = std::max(red[i], 40.0f);
    std::vector<float>& green = odd.response[1].drive_from_n;
    for (std::size_t i = 100; i < 400; ++i) green[i] = green[100];
    for (std::size_t i = 0; i < odd.table.n_from_drive.size(); ++i) {
        if (i % 9 == 1) odd.table.n_from_drive[i] = odd.table.n_from_drive[i - 1];
    }
    const NonAdditive table = make_non_additive(odd.table, odd.response);
    Random random(79);
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 n(1.4 * random.uniform() - 0.2,
                          1.4 * random.uniform() - 0.2,
                          1.4 * random.uniform() - 0.2);
        glm::vec3 residual;
        const glm::vec3 drive = drive_of_n(table, n, &residual);
        for (int k = 0; k < 3; ++k) {
            ASSERT_GE(drive[k], 0.0f);
            ASSERT_LE(drive[k], 255.0f);
            ASSERT_TRUE(std::isfinite(residual[k]));
        }
    }
}

TEST_F(DriveTableTest, NamesABadTable) {
    const auto message = [&](int grid, std::size_t values, float value) -> std::string {
        DriveTable table;
        table.grid = grid;
        table.n_from_drive.assign(values, glm::vec3(value));
        try {
            make_non_additive(table, calibration_.response);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "nothing thrown";
    };
    EXPECT_NE(message(1, 1, 0.0f).find("drive table of 1 nodes"), std::string::npos);
    EXPECT_NE(message(9, 728, 0.0f).find("holds 728 values"), std::string::npos);
    EXPECT_NE(message(-4, 0, 0.0f).find("drive table of -4 nodes"), std::string::npos);
    EXPECT_NE(message(66, 66 * 66 * 66, 0.0f).find("drive table of 66"), std::string::npos);
    EXPECT_NE(message(2, 8, std::numeric_limits<float>::infinity()).find("not finite"),
              std::string::npos);
}

}  // namespace
}  // namespace livery
