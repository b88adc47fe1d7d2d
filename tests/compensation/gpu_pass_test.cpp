// The OpenGL pass against its oracle, compensate(): within one level everywhere.
#include "compensation/gpu_pass.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "compensation/white_segment.h"
#include "core/error.h"
#include "gl/context.h"
#include "gl/handles.h"
#include "gl/program.h"
#include "gl/read_back.h"

namespace livery {
namespace {

class GpuPass : public ::testing::Test {
  protected:
    GpuPass() : context_(GlDevice::automatic) { set_gl_checks(true); }
    ~GpuPass() override { set_gl_checks(false); }

    struct Result {
        int largest = 0;
        double changed_fraction = 0.0;
        Image8 gpu, cpu;
        CompensationStats gpu_stats, cpu_stats;
    };
    static void expect_same_counts(const Result& result) {
        const CompensationStats &gpu = result.gpu_stats, &cpu = result.cpu_stats;
        EXPECT_EQ(gpu.out_of_gamut_fraction, cpu.out_of_gamut_fraction);
        EXPECT_EQ(gpu.invalid_fraction, cpu.invalid_fraction);
        EXPECT_EQ(gpu.clipped_high_fraction, cpu.clipped_high_fraction);
        EXPECT_EQ(gpu.clipped_low_fraction, cpu.clipped_low_fraction);
    }
    /// Both see the same half floats, which is what the radiance texture holds.
    static Result compare(const CompensationTable& table, const ImageF& wanted) {
        Texture2D texture(wanted.width, wanted.height, TexelFormat::rgba16f);
        texture.upload(wanted.values);
        GpuCompensation pass(table);
        Texture2D drive(table.width, table.height, TexelFormat::rgba8);
        CompensationCounts counts;
        pass.run(texture.name(), drive, counts);
        Result result;
        result.gpu = read_bytes(drive, 3);
        const ImageF seen = read_floats(texture);
        CompensationStats of_cpu;
        result.cpu = compensate(table, seen, &of_cpu);
        result.gpu_stats = counts.read(count_covered(seen));
        result.cpu_stats = of_cpu;
        EXPECT_EQ(result.gpu.values.size(), result.cpu.values.size());
        std::size_t changed = 0;
        for (std::size_t i = 0; i < result.cpu.values.size(); ++i) {
            const int step = std::abs(static_cast<int>(result.cpu.values[i]) -
                                      static_cast<int>(result.gpu.values[i]));
            result.largest = std::max(result.largest, step);
            changed += step != 0 ? 1u : 0u;
        }
        result.changed_fraction =
            static_cast<double>(changed) / static_cast<double>(result.cpu.values.size());
        return result;
    }
    HeadlessContext context_;
};

ImageF random_wanted(const synthetic::World& world, std::uint64_t seed) {
    Random random(seed);
    return synthetic::picture(world, [&](std::size_t) {
        return glm::dvec3(2.0 * random.uniform() - 0.4,
                          2.0 * random.uniform() - 0.4,
                          2.0 * random.uniform() - 0.4);
    });
}

TEST_F(GpuPass, AgreesWithTheOracle) {
    // Sizes that are no multiple of a group, smaller than one, and one pixel wide.
    for (const auto& [width, height] : {std::pair{131, 77}, {31, 33}, {1, 65}, {64, 32}}) {
        SCOPED_TRACE(::testing::Message() << width << "x" << height);
        const synthetic::World world = synthetic::make_world(width, height, 81);
        const ImageF wanted = random_wanted(world, 82);
        for (const bool paper : {false, true}) {
            const CompensationTable table = bake(
                paper ? synthetic::calibrate(world, 64.0, 200.0, 257) : synthetic::calibrate(world),
                0.4);
            const Result result = compare(table, wanted);
            EXPECT_LE(result.largest, 1);
            // Only where the two round a threshold of the dither differently.
            EXPECT_LT(result.changed_fraction, 0.005);
            EXPECT_GT(*std::max_element(result.gpu.values.begin(), result.gpu.values.end()), 100);
            expect_same_counts(result);
            EXPECT_GT(result.gpu_stats.clipped_high_fraction, 0.1);
            EXPECT_GT(result.gpu_stats.clipped_low_fraction, 0.1);
        }
    }
}

TEST_F(GpuPass, AgreesOnEverythingThatIsBlack) {
    synthetic::World world = synthetic::make_world(96, 70, 83);
    for (std::size_t i = 0; i < world.lit.size(); ++i) {
        const std::size_t x = i % 96, y = i / 96;
        world.lit[i] = x > 20 && x < 80 && y > 10 && y < 66 && (x + y) % 5 != 0;
    }
    ImageF wanted = random_wanted(world, 84);
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(),
                         std::numeric_limits<float>::infinity(),
                         -std::numeric_limits<float>::infinity()};
    for (std::size_t i = 0; i < wanted.pixel_count(); ++i) {
        if (i % 7 == 0) wanted.values[4 * i + i % 3] = bad[i / 7 % 3];
        if (i % 11 == 0) wanted.values[4 * i + 3] = 0.25f;
        if (i % 13 == 0) wanted.values[4 * i + 3] = 0.5f;
        if (i % 17 == 0) wanted.values[4 * i + 3] = bad[0];
    }
    const Result result = compare(bake(synthetic::calibrate(world, 64.0, 200.0, 257), 0.4), wanted);
    EXPECT_LE(result.largest, 1);
    // 64 is the smallest drive that is not black: black agrees exactly.
    for (std::size_t i = 0; i < result.cpu.values.size(); ++i) {
        EXPECT_EQ(result.cpu.values[i] == 0, result.gpu.values[i] == 0) << i;
    }
    expect_same_counts(result);
    EXPECT_GT(result.gpu_stats.invalid_fraction, 0.1);
}

TEST_F(GpuPass, AgreesOnANonAdditiveProjector) {
    const synthetic::World world = synthetic::make_world(64, 50, 85);
    const CompensationTable table = bake(synthetic::calibrate_segment(world), 0.5);
    Random random(86);
    const ImageF inside = synthetic::picture(world, [&](std::size_t i) {
        const glm::dvec3 drive = synthetic::random_drive(random, 8.0, 250.0);
        return working_from_xyz() *
               (world.xyz_from_camera * synthetic::segment_camera(world, i, drive)) / 0.5;
    });
    EXPECT_LE(compare(table, inside).largest, 1);
    const Result outside = compare(table, random_wanted(world, 87));
    EXPECT_LE(outside.largest, 1);
    EXPECT_LT(outside.changed_fraction, 0.005);
    expect_same_counts(outside);
    EXPECT_GT(outside.gpu_stats.out_of_gamut_fraction, 0.1);
}

TEST_F(GpuPass, AgreesOnTheGamutMapping) {
    const synthetic::World world = synthetic::make_world(131, 77, 91);
    for (const bool segment : {false, true}) {
        SCOPED_TRACE(segment ? "clear segment" : "additive");
        const ColourCalibration calibration =
            segment ? synthetic::calibrate_segment(world) : synthetic::calibrate(world);
        const CompensationTable strict = bake(calibration, 0.4);
        const CompensationTable table = bake(calibration, 0.4, GamutMapping::preserve);
        ImageF wanted = random_wanted(world, 92);
        for (std::size_t i = 0; i < wanted.pixel_count(); i += 19) {
            wanted.values[4 * i] = std::numeric_limits<float>::quiet_NaN();
        }
        const Result result = compare(table, wanted);
        EXPECT_LE(result.largest, 1);
        EXPECT_LT(result.changed_fraction, 0.005);
        expect_same_counts(result);
        // It has moved much.
        const Result clipped = compare(strict, wanted);
        EXPECT_EQ(clipped.gpu_stats.out_of_gamut_fraction, result.gpu_stats.out_of_gamut_fraction);
        std::size_t moved = 0;
        for (std::size_t i = 0; i < result.gpu.values.size(); ++i) {
            moved += result.gpu.values[i] != clipped.gpu.values[i] ? 1u : 0u;
        }
        EXPECT_GT(moved, result.gpu.values.size() / 5);
    }
}

TEST_F(GpuPass, FramesFollowOneAnotherWithoutATrace) {
    const synthetic::World world = synthetic::make_world(40, 40, 88);
    const CompensationTable table = bake(synthetic::calibrate(world), 0.4);
    GpuCompensation pass(table);
    CompensationCounts counts;
    Texture2D bright(40, 40, TexelFormat::rgba16f), none(40, 40, TexelFormat::rgba16f);
    Texture2D drive(40, 40, TexelFormat::rgba8);
    bright.upload(ImageF(40, 40, 4, 1.0f).values);
    none.upload(ImageF(40, 40, 4, 0.0f).values);
    drive.clear(0.5f);  // of a picture that another table made
    pass.run(bright.name(), drive, counts);
    const Image8 first = read_bytes(drive, 3);
    const CompensationStats of_first = counts.read(1600);
    EXPECT_GT(*std::max_element(first.values.begin(), first.values.end()), 200);
    EXPECT_GT(of_first.out_of_gamut_fraction, 0.1);
    pass.run(none.name(), drive, counts);
    const Image8 second = read_bytes(drive, 3);
    EXPECT_EQ(*std::max_element(second.values.begin(), second.values.end()), 0);
    EXPECT_EQ(counts.read(0).out_of_gamut_fraction, 0.0);
    pass.run(bright.name(), drive, counts);
    EXPECT_EQ(read_bytes(drive, 3).values, first.values);
    EXPECT_EQ(counts.read(1600).out_of_gamut_fraction, of_first.out_of_gamut_fraction);
}

TEST_F(GpuPass, EmptyCalibrationIsBlack) {
    synthetic::World world = synthetic::make_world(20, 20, 89);
    world.lit.assign(world.lit.size(), false);
    const Result result = compare(bake(synthetic::calibrate(world), 0.4), ImageF(20, 20, 4, 1.0f));
    EXPECT_EQ(result.largest, 0);
    EXPECT_EQ(*std::max_element(result.gpu.values.begin(), result.gpu.values.end()), 0);
}

TEST_F(GpuPass, TablesFollowOneAnotherAndCompileOnceAKind) {
    const synthetic::World world = synthetic::make_world(40, 40, 93);
    const ColourCalibration calibration = synthetic::calibrate(world);
    Texture2D wanted(40, 40, TexelFormat::rgba16f), drive(40, 40, TexelFormat::rgba8);
    wanted.upload(random_wanted(world, 94).values);
    const ImageF seen = read_floats(wanted);
    GpuCompensation pass;
    CompensationCounts counts;
    const auto expect_oracle = [&](const CompensationTable& table) {
        pass.use(table);
        pass.run(wanted.name(), drive, counts);
        const Image8 oracle = compensate(table, seen);
        const Image8 sent = read_bytes(drive, 3);
        for (std::size_t i = 0; i < oracle.values.size(); ++i) {
            ASSERT_NEAR(sent.values[i], oracle.values[i], 1) << i;
        }
    };
    for (const double white : {0.3, 0.4}) {
        SCOPED_TRACE(white);
        expect_oracle(bake(calibration, white));
        expect_oracle(bake(calibration, white, GamutMapping::preserve));
        expect_oracle(bake(synthetic::calibrate_segment(world), white));
    }
    EXPECT_EQ(pass.programs(), 3);
}

TEST_F(GpuPass, RefusesMorePixelsThanAStorageBlockHolds) {
    const HeadlessContext software(GlDevice::software);
    CompensationTable table;
    table.width = 4096;
    table.height = static_cast<int>(largest_storage_block() / (12 * sizeof(float) * 4096)) + 1;
    const auto count =
        static_cast<std::size_t>(table.width) * static_cast<std::size_t>(table.height);
    table.pixels.resize(count);
    GpuCompensation pass;
    EXPECT_THROW(pass.use(table), Refused);
    // And with a mapping, which has more of each pixel, fewer.
    table.pixels.resize(count * 4 / 5);
    table.gamut.coefficients.resize(1);
    EXPECT_THROW(pass.use(table), Refused);
    EXPECT_EQ(pass.programs(), 0);
}

TEST_F(GpuPass, RefusesATextureThatDoesNotFit) {
    GpuCompensation pass(bake(synthetic::calibrate(synthetic::make_world(20, 20, 90)), 0.4));
    CompensationCounts counts;
    Texture2D wanted(20, 20, TexelFormat::rgba16f);
    Texture2D narrow(19, 20, TexelFormat::rgba8), floats(20, 20, TexelFormat::rgba16f);
    EXPECT_THROW(pass.run(wanted.name(), narrow, counts), std::invalid_argument);
    EXPECT_THROW(pass.run(wanted.name(), floats, counts), std::invalid_argument);
}

}  // namespace
}  // namespace livery
