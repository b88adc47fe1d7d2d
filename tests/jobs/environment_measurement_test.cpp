// A known room, photographed in a mirror ball on the simulated stand, and the map made of it. The
// limits are what was asked for before anything was measured: 3% of the irradiance of every
// surface, 1 degree of a lamp's direction.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "core/channels.h"
#include "core/random.h"
#include "core/worst_error.h"
#include "jobs/ball_bench.h"

namespace livery {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kIrradiance = 0.03, kDirection_deg = 1.0;
constexpr int kMeasuredSize_px = 400;

const std::vector<glm::dvec3>& normals() {
    static const std::vector<glm::dvec3> directions = even_directions(60);
    return directions;
}

using Irradiance = std::vector<glm::dvec3>;

Irradiance irradiance_in(const std::function<glm::dvec3(const glm::dvec3&)>& light) {
    Irradiance values;
    for (const glm::dvec3& normal : normals()) values.push_back(irradiance_of(light, normal));
    return values;
}
const Irradiance& irradiance_of_the_room() {
    static const Irradiance irradiance = irradiance_in(room_rec709);
    return irradiance;
}

/// The room turned so that no lamp stands behind the ball, seen from the first camera.
glm::dvec3 turned_room_rec709(const glm::dvec3& d) { return room_rec709({-d.z, d.y, d.x}); }

/// The largest relative error of a channel's irradiance, over surfaces of all normals.
double irradiance_error(const ImageF& map,
                        const char* of,
                        const Irradiance& truth = irradiance_of_the_room()) {
    double worst = 0.0, sum = 0.0;
    const auto found = light_in(map);
    for (std::size_t k = 0; k < normals().size(); ++k) {
        const glm::dvec3 off = glm::abs(irradiance_of(found, normals()[k]) / truth[k] - 1.0);
        worst = worse_of({worst, off.x, off.y, off.z});
        sum += (off.x + off.y + off.z) / 3.0;
    }
    std::printf("%s: irradiance off by %.2f%% (mean), %.2f%% (worst of %zu normals)\n",
                of,
                100.0 * sum / static_cast<double>(normals().size()),
                100.0 * worst,
                normals().size());
    return worst;
}

void print(const EnvironmentMeasurement& report, const char* of) {
    std::printf("%s: covered %.1f%%, coarse %.1f%%, filled %.1f%%, %.1f stops\n",
                of,
                100.0 * report.coverage.covered,
                100.0 * report.coverage.coarse,
                100.0 * report.filled,
                report.dynamic_range_stops);
}

TEST(EnvironmentMeasurement, IrradianceIsTheRoomsFromTwoSides) {
    BallBench bench(kMeasuredSize_px, 2, in_working(room_rec709));
    const EnvironmentMeasurement both = bench.measure();
    print(both, "two sides");
    EXPECT_LT(irradiance_error(bench.map(), "two sides"), kIrradiance);
    EXPECT_EQ(both.saturated_texels, 0u);
    EXPECT_GT(both.coverage.covered, 0.999);
    EXPECT_EQ(both.filled, 0.0);
    // What a second side is for: a lamp that the first sees cut by the edge of what it does not
    // see.
    bench.manifest["views"].erase(1);
    bench.rewrite();
    const EnvironmentMeasurement one = bench.measure();
    print(one, "one side, a lamp behind the ball");
    EXPECT_GT(irradiance_error(bench.map(), "one side, a lamp behind the ball"), kIrradiance);
}

TEST(EnvironmentMeasurement, IrradianceIsTheRoomsFromOneSideWithoutALampBehindTheBall) {
    const BallBench bench(kMeasuredSize_px, 1, in_working(turned_room_rec709));
    const EnvironmentMeasurement report = bench.measure();
    print(report, "one side");
    EXPECT_LT(irradiance_error(bench.map(), "one side", irradiance_in(turned_room_rec709)),
              kIrradiance);
    EXPECT_NEAR(report.coverage.covered + report.coverage.coarse + report.filled, 1.0, 1e-6);
    EXPECT_GT(report.filled, 0.0);
    EXPECT_LT(report.filled, 0.05);
}

TEST(EnvironmentMeasurement, ASteelBallIsUndoneByItsReflectance) {
    // Iron's indices at 650, 550 and 450 nm; the manifest has what they are at normal incidence,
    // and Schlick's curve is what the program makes of it.
    const BallBench bench(
        kMeasuredSize_px, 2, in_working(room_rec709), [](SimulatedBallRequest& request) {
            request.stand.metal = MetalIndex{{2.91, 2.95, 2.55}, {3.29, 2.99, 2.68}};
        });
    bench.measure();
    EXPECT_LT(irradiance_error(bench.map(), "steel"), kIrradiance);
    // What the manifest says may be said on the command line instead.
    EnvironmentRequest request = bench.request();
    request.reflectance = glm::dvec3(1.0);
    const EnvironmentMeasurement darker = measure_environment(request);
    request.reflectance = glm::dvec3(0.5);
    EXPECT_GT(measure_environment(request).mean_luminance, 1.8 * darker.mean_luminance);
}

/// Forty lamps of 1.5 degrees, spread evenly, in dim light.
const std::vector<glm::dvec3>& lamps() {
    static const std::vector<glm::dvec3> directions = even_directions(40);
    return directions;
}
glm::dvec3 lamps_rec709(const glm::dvec3& d) {
    for (const glm::dvec3& lamp : lamps()) {
        if (glm::dot(d, lamp) > std::cos(1.5 * kDegree)) return glm::dvec3(300.0);
    }
    return glm::dvec3(0.1);
}

/// Degrees from a lamp to the middle of the light around it.
double off_by(const ImageF& map, const glm::dvec3& lamp) {
    glm::dvec3 middle(0.0);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const glm::dvec3 d = texel_direction(map, x, y);
            if (glm::dot(d, lamp) < std::cos(10.0 * kDegree)) continue;
            middle += texel_sr(map, y) * (map.at(x, y, 1) - 0.1) * d;
        }
    }
    return worst_if_nan(std::acos(std::min(glm::dot(glm::normalize(middle), lamp), 1.0)) / kDegree);
}

/// The worst of the lamps that are seen by pixels of 2 degrees or less, and how many those are.
std::pair<double, int> worst_lamp(const RadianceMap& map, const ImageF& file, const char* of) {
    double worst = 0.0;
    int seen = 0;
    for (const glm::dvec3& lamp : lamps()) {
        const glm::dvec2 uv = uv_from_direction(Environment{}, lamp);
        const int x = static_cast<int>(uv.x * file.width), y = static_cast<int>(uv.y * file.height);
        const float widest = map.widest_rad.at(x, y);
        if (map.seen.at(x, y) < 0.5f || widest > 2.0 * kDegree) continue;
        worst = worse_of(worst, off_by(file, lamp));
        ++seen;
    }
    std::printf(
        "%s: %d of %zu lamps, the worst off by %.2f degrees\n", of, seen, lamps().size(), worst);
    return {worst, seen};
}

TEST(EnvironmentMeasurement, LampsAreWhereTheyAre) {
    const BallBench bench(kMeasuredSize_px, 2, in_working(lamps_rec709));
    const EnvironmentMeasurement both = bench.measure(512);
    const auto [worst, seen] = worst_lamp(both.map, bench.map(), "two sides");
    EXPECT_EQ(seen, 40);
    EXPECT_LT(worst, kDirection_deg);
    // Four fifths of all directions and more from one side.
    Json manifest = bench.manifest;
    manifest["views"].erase(1);
    write_json_file(bench.captures() / "manifest.json", manifest);
    const EnvironmentMeasurement one = bench.measure(512);
    const auto [worst_of_one, seen_by_one] = worst_lamp(one.map, bench.map(), "one side");
    EXPECT_GE(seen_by_one, 32);
    EXPECT_LT(worst_of_one, kDirection_deg);

    // The ball's place unknown: points of its outline, clicked to half a pixel.
    manifest = bench.manifest;
    Random random(9);
    for (std::size_t k = 0; k < 2; ++k) {
        const View& view = bench.stand.cameras[k].view;
        const glm::dvec3 eye = centre_in_world(view), axis = glm::normalize(-eye);
        const glm::dvec3 side = glm::normalize(glm::cross(axis, glm::dvec3(0, 1, 0)));
        const glm::dvec3 up = glm::cross(side, axis);
        const double half = std::asin(0.5 * bench.stand.diameter_mm / glm::length(eye));
        Json points = Json::array();
        for (int j = 0; j < 40; ++j) {
            const double turn = 2.0 * std::numbers::pi * j / 40;
            const auto pixel = project(
                view,
                eye + 700.0 * (std::cos(half) * axis +
                               std::sin(half) * (std::cos(turn) * side + std::sin(turn) * up)));
            points.push_back(
                {pixel->x - 0.5 + 0.5 * random.normal(), pixel->y - 0.5 + 0.5 * random.normal()});
        }
        manifest["views"][k]["outline_px"] = points;
    }
    manifest["sphere"].erase("centre_mm");
    write_json_file(bench.captures() / "manifest.json", manifest);
    const EnvironmentMeasurement clicked = bench.measure(512);
    for (const EnvironmentView& view : clicked.views) {
        EXPECT_NEAR(view.outline->rms_px, 0.5, 0.2);
        EXPECT_LT(glm::length(view.ball->centre_mm), 5.0);
    }
    const auto [worst_clicked, seen_clicked] =
        worst_lamp(clicked.map, bench.map(), "outline to half a pixel");
    EXPECT_EQ(seen_clicked, 40);
    EXPECT_LT(worst_clicked, kDirection_deg);
}

TEST(EnvironmentMeasurement, TheOutlineIsFoundInThePhotographs) {
    // A ball of painted steel, darker than what is behind it, put three millimetres beside its
    // place.
    BallBench bench(
        kMeasuredSize_px, 2, in_working(room_rec709), [](SimulatedBallRequest& request) {
            request.stand.metal = MetalIndex{{2.91, 2.95, 2.55}, {3.29, 2.99, 2.68}};
        });
    bench.manifest["fit_outline"] = true;
    bench.manifest["sphere"]["centre_mm"] = {1.5, -1.0, 0.5};
    bench.rewrite();
    const EnvironmentMeasurement report = bench.measure();
    for (const EnvironmentView& view : report.views) {
        std::printf("outline: %.2f px over %.0f%%; the middle is off by %.2f mm\n",
                    view.outline->rms_px,
                    100.0 * view.outline->seen_fraction,
                    glm::length(view.ball->centre_mm));
        EXPECT_LT(view.outline->rms_px, 1.0);
        // Across the line of sight a pixel is 0.2 mm.
        const glm::dvec3 off = view.ball->centre_mm;
        const glm::dvec3 axis = glm::normalize(
            centre_in_world(bench.stand.cameras[&view == &report.views[0] ? 0 : 1].view));
        EXPECT_LT(glm::length(off - glm::dot(off, axis) * axis), 0.15);
        EXPECT_NEAR(*view.correction_mm, glm::length(glm::dvec3(1.5, -1.0, 0.5)), 6.0);
    }
    EXPECT_LT(irradiance_error(bench.map(), "outline found"), kIrradiance);
}

TEST(EnvironmentMeasurement, TheCameraIsLeftOutWhereAnotherSees) {
    BallBench bench(
        kMeasuredSize_px, 2, in_working(room_rec709), [](SimulatedBallRequest& request) {
            request.stand.camera_radius_mm = 90.0;
        });
    bench.measure();
    const glm::dvec3 ahead = glm::normalize(centre_in_world(bench.stand.cameras[0].view));
    const ImageF with_camera = bench.map();
    EXPECT_LT(light_in(with_camera)(ahead).y, 0.5 * room_rec709(ahead).y);
    // 90 mm at 800 is 6.5 degrees.
    bench.manifest["camera_deg"] = 8.0;
    bench.rewrite();
    const EnvironmentMeasurement report = bench.measure();
    EXPECT_EQ(report.filled, 0.0);
    EXPECT_LT(irradiance_error(bench.map(), "camera left out"), kIrradiance);
    const ImageF map = bench.map();
    const auto light = light_in(map);
    for (const CameraDescription& camera : bench.stand.cameras) {
        const glm::dvec3 toward = glm::normalize(centre_in_world(camera.view));
        EXPECT_NEAR(light(toward).y / room_rec709(toward).y, 1.0, 0.1);
    }
}

TEST(EnvironmentMeasurement, AMaskLeavesOutWhatItCovers) {
    BallBench bench(256, 1, in_working(room_rec709));
    Image8 mask(256, 256, 1, 0);
    for (int y = 128; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) mask.at(x, y) = 255;
    }
    write_png(bench.captures() / "mask.png", mask);
    bench.manifest["views"][0]["mask"] = "mask.png";
    bench.rewrite();
    EnvironmentRequest request = bench.request();
    request.mask = bench.folder / "seen.exr";
    const EnvironmentMeasurement report = measure_environment(request);
    EXPECT_NEAR(report.filled, 0.5, 0.03);
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes[0].find("% of all directions are filled"), std::string::npos);
    const ImageFile seen = read_image(bench.folder / "seen.exr");
    const int share = channel_named(seen, "mask.seen");
    const int pixel_deg = channel_named(seen, "mask.pixel_deg");
    ASSERT_TRUE(share >= 0 && pixel_deg >= 0 && channel_named(seen, "mask.saturated") >= 0);
    // Up is seen, down is not; what a renderer reads has light everywhere.
    EXPECT_EQ(seen.image.at(128, 20, share), 1.0f);
    EXPECT_GT(seen.image.at(128, 20, pixel_deg), 0.0f);
    EXPECT_EQ(seen.image.at(128, 110, share), 0.0f);
    EXPECT_TRUE(std::isnan(seen.image.at(128, 110, pixel_deg)));
    const Environment map = load_environment({bench.out().string(), 0.0, 1.0}, {});
    EXPECT_GT(map.radiance_working.at(128, 110, 1), 0.05f);
}

/// The panorama of a room whose camera was turned, as a 14-bit camera's file.
Image16 panorama(const glm::dmat3& world_from_panorama, double exposure_s) {
    Image16 picture(512, 256, 3);
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 512; ++x) {
            const double azimuth = 2.0 * std::numbers::pi * ((x + 0.5) / 512 - 0.5);
            const double polar = std::numbers::pi * (y + 0.5) / 256;
            const glm::dvec3 d(std::sin(polar) * std::sin(azimuth),
                               std::cos(polar),
                               -std::sin(polar) * std::cos(azimuth));
            const glm::dvec3 light = 20'000.0 * exposure_s * room_rec709(world_from_panorama * d);
            for (int c = 0; c < 3; ++c) {
                picture.at(x, y, c) =
                    static_cast<std::uint16_t>(std::clamp(1024.0 + light[c], 0.0, 16383.0) + 0.5);
            }
        }
    }
    return picture;
}

TEST(EnvironmentMeasurement, APanoramaIsMergedAndTurned) {
    const TemporaryFolder folder;
    // A camera that looks 40 degrees to the left and 10 up.
    const double yaw = 40.0 * kDegree, pitch = 10.0 * kDegree;
    const glm::dvec3 right(std::cos(yaw), 0.0, -std::sin(yaw));
    const glm::dvec3 forward(
        -std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch));
    const glm::dmat3 turn(right, glm::cross(-forward, right), -forward);
    Json captures = Json::array();
    for (const double exposure_s : {0.01, 0.08, 0.5}) {
        const std::string name = std::to_string(captures.size()) + ".png";
        write_png(folder / name, panorama(turn, exposure_s));
        captures.push_back({{"file", name}, {"exposure_s", exposure_s}});
    }
    Json manifest = {{"environment", "panorama"},
                     {"black_level", 1024},
                     {"saturates_at", 16383},
                     {"yaw_deg", 40},
                     {"pitch_deg", 10},
                     {"captures", captures}};
    EnvironmentRequest request;
    request.captures = folder.path();
    request.out = folder / "room.exr";
    request.width = 512;
    request.scale = 1.0 / 20'000.0;
    write_json_file(folder / "manifest.json", manifest);
    EnvironmentMeasurement report = measure_environment(request);
    EXPECT_EQ(report.filled, 0.0);
    EXPECT_EQ(report.saturated_texels, 0u);
    EXPECT_LT(irradiance_error(read_image(request.out).image, "panorama"), 0.01);

    // Two marks say the same: what lies ahead and what lies to the right.
    manifest.erase("yaw_deg");
    manifest.erase("pitch_deg");
    manifest["marks"] = {{{"pixel", {255.5, 127.5}}, {"direction", json_from(forward)}},
                         {{"pixel", {383.5, 127.5}}, {"direction", json_from(right)}}};
    write_json_file(folder / "manifest.json", manifest);
    report = measure_environment(request);
    EXPECT_LT(report.marks_residual_rad, 1e-6);
    EXPECT_LT(irradiance_error(read_image(request.out).image, "panorama by marks"), 0.01);
    request.reflectance = glm::dvec3(0.5);
    EXPECT_THROW(measure_environment(request), std::invalid_argument);
}

}  // namespace
}  // namespace livery
