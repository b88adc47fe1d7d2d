#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/image_io.h"
#include "core/random.h"
#include "scene/look.h"
#include "support/file_error.h"
#include "support/reference_data.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(EnvironmentMap, LooksWhereItsPictureSays) {
    const Environment environment;
    const auto at = [&](double x, double y, double z) {
        return uv_from_direction(environment, {x, y, z});
    };
    EXPECT_NEAR(at(0, 0, -1).x, 0.5, 1e-15);
    EXPECT_NEAR(at(0, 0, -1).y, 0.5, 1e-15);
    EXPECT_NEAR(at(1, 0, 0).x, 0.75, 1e-15);
    EXPECT_NEAR(at(-1, 0, 0).x, 0.25, 1e-15);
    EXPECT_NEAR(at(0, 1, 0).y, 0.0, 1e-15);
    EXPECT_NEAR(at(0, -1, 0).y, 1.0, 1e-15);
    EXPECT_LT(at(0, -1, 0).y, 1.0);
    EXPECT_LT(at(0, 0, 1).x, 1.0);
    EXPECT_NEAR(at(0, 5, -5).y, 0.25, 1e-15);
}

TEST(EnvironmentMap, RotationIsCounterClockwiseSeenFromAbove) {
    Environment environment;
    environment.rotation_rad = 0.5 * kPi;
    // What stood at +x stands at -z: a quarter turn about +y takes x to -z.
    const glm::dvec2 uv = uv_from_direction(Environment{}, {1, 0, 0});
    const glm::dvec3 now = direction_from_uv(environment, uv);
    EXPECT_LT(glm::distance(now, glm::dvec3(0, 0, -1)), 1e-15);
}

TEST(EnvironmentMap, DirectionsComeBack) {
    Random random(31);
    for (int trial = 0; trial < 10000; ++trial) {
        Environment environment;
        environment.rotation_rad = 20.0 * (random.uniform() - 0.5);
        const glm::dvec3 direction =
            glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
        const glm::dvec2 uv = uv_from_direction(environment, direction);
        ASSERT_TRUE(uv.x >= 0.0 && uv.x < 1.0 && uv.y >= 0.0 && uv.y < 1.0);
        ASSERT_LT(glm::distance(direction_from_uv(environment, uv), direction), 1e-13);
    }
    // Within a millionth of the pole too.
    const Environment environment;
    const glm::dvec3 near_pole = glm::normalize(glm::dvec3(1e-6, 1.0, 2e-6));
    const glm::dvec2 uv = uv_from_direction(environment, near_pole);
    EXPECT_LT(glm::distance(direction_from_uv(environment, uv), near_pole), 1e-15);
}

ImageF some_map() {
    ImageF map(8, 4, 3);
    for (std::size_t k = 0; k < map.values.size(); ++k)
        map.values[k] = 0.25f * static_cast<float>(k);
    return map;
}

TEST(EnvironmentMap, IsReadIntoTheWorkingSpace) {
    const TemporaryFolder folder;
    write_exr(folder / "sky.exr", some_map());
    const Environment sky = load_environment({"sky.exr", 0.5, 2.0}, folder.path());
    EXPECT_EQ(sky.rotation_rad, 0.5);
    EXPECT_EQ(sky.scale, 2.0);
    ASSERT_EQ(sky.radiance_working.width, 8);
    const float* pixel = sky.radiance_working.pixel(5, 2);
    const glm::dvec3 rec709 = rec709_from_working() * glm::dvec3(pixel[0], pixel[1], pixel[2]);
    const double first = 0.25 * 3 * (2 * 8 + 5);
    EXPECT_NEAR(rec709.x, first, 1e-5);
    EXPECT_NEAR(rec709.z, first + 0.5, 1e-5);
}

TEST(EnvironmentMap, AGreyMapServesAllChannelsAndNoNameIsNone) {
    const TemporaryFolder folder;
    write_exr(folder / "grey.exr", ImageF(4, 2, 1, 0.5f));
    const Environment sky = load_environment({(folder / "grey.exr").string(), 0.0, 1.0}, "");
    for (const float value : sky.radiance_working.values) EXPECT_NEAR(value, 0.5f, 1e-6f);
    EXPECT_TRUE(load_environment({}, folder.path()).radiance_working.empty());
}

TEST(EnvironmentMap, ReadsRadianceFiles) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    int read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(data / "environments")) {
        if (entry.path().extension() != ".hdr") continue;
        const Environment sky = load_environment({entry.path().string(), 0.0, 1.0}, "");
        EXPECT_EQ(sky.radiance_working.width, 2 * sky.radiance_working.height);
        ++read;
    }
    EXPECT_GE(read, 1);
}

TEST(EnvironmentMap, EachMistakeIsNamed) {
    const TemporaryFolder folder;
    const auto refuses = [&](const ImageF& map, std::initializer_list<std::string_view> parts) {
        write_exr(folder / "sky.exr", map);
        return fails_with([&] { load_environment({"sky.exr", 0.0, 1.0}, folder.path()); }, parts);
    };
    const auto refuses_file = [&](std::string name, std::initializer_list<std::string_view> parts) {
        return fails_with([&] { load_environment({name, 0.0, 1.0}, folder.path()); }, parts);
    };
    EXPECT_TRUE(refuses(ImageF(8, 5, 3), {"sky.exr: size: found 8x5, expected twice as wide"}));
    ImageF map = some_map();
    map.at(3, 1, 2) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(refuses(map, {"pixel (3, 1): found", "nan", "expected finite radiance"}));
    map.at(3, 1, 2) = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(refuses(map, {"pixel (3, 1): found", "inf"}));
    map.at(3, 1, 2) = -0.5f;
    EXPECT_TRUE(refuses(map, {"pixel (3, 1): found", "-0.5", "not negative"}));
    EXPECT_TRUE(refuses(ImageF(8, 4, 2), {"channels: found", "expected R, G, B"}));

    EXPECT_TRUE(refuses_file("gone.hdr", {"gone.hdr: environment: found nothing in", "nor in"}));
    EXPECT_TRUE(refuses_file((folder / "gone.hdr").string(), {"gone.hdr: found no such file"}));
    folder.write("empty.hdr", "");
    EXPECT_TRUE(refuses_file("empty.hdr", {"empty.hdr"}));
    folder.write("text.hdr", "not a picture");
    EXPECT_TRUE(refuses_file("text.hdr", {"text.hdr"}));
    folder.write("huge.hdr",
                 "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 40000 +X 80000\n\x02\x02\x01\x01");
    EXPECT_TRUE(refuses_file("huge.hdr", {"huge.hdr: size: found 80000x40000"}));
    folder.write("short.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 64 +X 128\n\x02\x02");
    EXPECT_TRUE(refuses_file("short.hdr", {"short.hdr"}));
    write_png(folder / "sky.png", Image8(8, 4, 3, 100));
    EXPECT_TRUE(refuses_file("sky.png", {"found integer pixels, expected an .hdr or .exr map"}));
}

}  // namespace
}  // namespace livery
