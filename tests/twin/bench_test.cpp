// The geometry of light and the promises of a bench without nuisances.
#include "twin/bench.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "core/error.h"
#include "small_bench.h"

namespace livery {
namespace {

using namespace livery::testing;

TEST(Bench, LightFallsWithCosineAndInverseSquareOnAWall) {
    const BenchDescription description = wall_bench();
    const Bench bench(description, product_of(make_wall()));
    const ImageF xyz = bench.observe_xyz(filled(description, 255, 255, 255));
    const View& view = description.projector.view;
    // A wall of reflectance 1/2 at 500 mm: Y = 1/2 cos^3 (cosine, and inverse square as cos^2).
    // Jittered samples over a pixel of 3.4 mrad: 1e-3 holds the curvature and the jitter.
    for (int y = 4; y < 116; y += 9) {
        for (int x = 4; x < 156; x += 9) {
            const double cosine = -ray_through(view, {x + 0.5, y + 0.5}).direction.z;
            EXPECT_NEAR(xyz.at(x, y, 1) / (0.5 * cosine * cosine * cosine), 1.0, 1e-3)
                << x << " " << y;
        }
    }
}

TEST(Bench, ATiltedWallIsDimmerByTheCosine) {
    // 40 degrees about y, through the origin: at the projector's axis only the cosine changes.
    const float c = std::cos(0.698132f), s = std::sin(0.698132f);
    const BenchDescription description = wall_bench();
    const Bench bench(description,
                      product_of(make_rectangle(
                          {-180 * c, -140, -180 * s}, {360 * c, 0, 360 * s}, {0, 280, 0}, "wall")));
    const ImageF xyz = bench.observe_xyz(filled(description, 255, 255, 255));
    // The mean of the four pixels around the axis: the distance changes evenly across it.
    const double y =
        0.25 * (xyz.at(79, 59, 1) + xyz.at(80, 59, 1) + xyz.at(79, 60, 1) + xyz.at(80, 60, 1));
    EXPECT_NEAR(y / 0.5, std::cos(0.698132), 1e-3);
}

TEST(Bench, AWhiteDiffuserFacingTheProjectorHasLuminanceOne) {
    BenchDescription description = wall_bench();
    description.mockup.surfaces["*"].reflectance = flat(1.0);
    const Bench bench(description, product_of(make_wall()));
    const ImageF xyz = bench.observe_xyz(filled(description, 255, 255, 255));
    EXPECT_NEAR(xyz.at(80, 60, 1), 1.0, 1e-4);  // half a pixel off the axis: cos^3 differs by 1e-5
}

TEST(Bench, AWhiteDiffuserFacingTheProjectorGivesTheCamerasSensitivity) {
    BenchDescription description = wall_bench();
    description.mockup.surfaces["*"].reflectance = flat(1.0);
    Bench bench(description, product_of(make_wall()));
    auto ports = bench.ports();
    ports.show(filled(description, 255, 255, 255));
    const Photograph photograph = ports.photograph(0.05);
    const glm::dvec2 at = project(description.camera.view, {0.0, 0.0, 0.0}).value();
    const double green = photograph.image.at(static_cast<int>(at.x), static_cast<int>(at.y), 1) -
                         photograph.black_level;
    // In whole units; a pixel off the axis is 1e-4 dimmer.
    EXPECT_NEAR(green / 0.05 / description.camera.sensitivity_units_per_s, 1.0, 1e-3);
}

TEST(Bench, PhotographsAreLinearInExposure) {
    const BenchDescription description = wall_bench();
    Bench bench(description, product_of(make_wall()));
    auto ports = bench.ports();
    ports.show(filled(description, 255, 255, 255));
    const double exposure = bench.default_exposure_s();
    const Photograph full = ports.photograph(exposure);
    const Photograph half = ports.photograph(0.5 * exposure);
    for (std::size_t k = 0; k < full.image.values.size(); k += 97) {
        // Rounding to whole units: half a unit in each.
        const double a = full.image.values[k] - full.black_level;
        const double b = half.image.values[k] - half.black_level;
        EXPECT_NEAR(b, 0.5 * a, 0.76);
    }
    EXPECT_EQ(ports.photograph(0.0).exposure_s, half.exposure_s);  // 0 keeps the last
    EXPECT_THROW(ports.photograph(-1.0), std::invalid_argument);
    EXPECT_THROW(ports.photograph(std::nan("")), std::invalid_argument);
}

TEST(Bench, FullWhiteIsMeteredToFourFifthsOfFullScale) {
    BenchDescription description = wall_bench();
    for (const double reflectance : {0.1, 0.5, 0.9}) {
        description.mockup.surfaces["*"].reflectance = flat(reflectance);
        Bench bench(description, product_of(make_wall()));
        auto ports = bench.ports();
        ports.show(filled(description, 255, 255, 255));
        const Photograph photograph = ports.photograph(0.0);
        const float peak =
            *std::max_element(photograph.image.values.begin(), photograph.image.values.end());
        EXPECT_NEAR(peak / photograph.saturates_at, 0.82, 1e-4) << reflectance;  // whole units
    }
}

TEST(Bench, ChannelsAddUpExactlyWithoutAWhiteSegment) {
    const BenchDescription description = wall_bench();
    const Bench bench(description, product_of(make_wall()));
    const ImageF red = bench.observe_xyz(filled(description, 200, 0, 0));
    const ImageF green = bench.observe_xyz(filled(description, 0, 90, 0));
    const ImageF blue = bench.observe_xyz(filled(description, 0, 0, 140));
    const ImageF all = bench.observe_xyz(filled(description, 200, 90, 140));
    for (std::size_t k = 0; k < all.values.size(); ++k) {
        // Float sums of 32 terms.
        EXPECT_NEAR(red.values[k] + green.values[k] + blue.values[k], all.values[k], 1e-6);
    }
}

TEST(Bench, GreyLevelsFollowTheResponse) {
    BenchDescription description = wall_bench();
    description.projector.gamma = {2.0, 2.2, 2.4};
    description.projector.s_curve = 0.3;
    Bench bench(description, product_of(make_wall()));
    auto ports = bench.ports();
    const auto measured = [&](int level) {
        ports.show(filled(description, level, level, level));
        return ports.measure_xyz({80.5, 60.5});
    };
    const auto primaries = [&] {
        glm::dmat3 xyz;
        for (int c = 0; c < 3; ++c) {
            for (int k = 0; k < 3; ++k) {
                xyz[k][c] = bench.truth().primary_xyz.at(80, 60, 3 * k + c);
            }
        }
        return xyz;
    }();
    for (int level = 0; level <= 255; level += 15) {
        const glm::dvec3 light = glm::inverse(primaries) * measured(level);
        const double x = level / 255.0;
        for (int c = 0; c < 3; ++c) {
            const double expected =
                0.7 * std::pow(x, description.projector.gamma[c]) + 0.3 * x * x * (3.0 - 2.0 * x);
            EXPECT_NEAR(light[c], expected, 1e-5) << level << " " << c;
        }
    }
}

TEST(Bench, TheColorimeterReadsWhatTheObserverSees) {
    BenchDescription description = wall_bench();
    description.ambient = 0.05;
    Bench bench(description, product_of(make_wall()));
    auto ports = bench.ports();
    Image8 picture = filled(description, 0, 0, 0);
    for (std::size_t k = 0; k < picture.values.size(); ++k) {
        picture.values[k] = static_cast<std::uint8_t>((k * 37) % 256);
    }
    ports.show(picture);
    const ImageF xyz = bench.observe_xyz(picture);
    for (const auto& [x, y] : {std::pair(3, 7), std::pair(80, 60), std::pair(151, 110)}) {
        const glm::dvec3 reading = ports.measure_xyz({x + 0.5, y + 0.5});
        for (int c = 0; c < 3; ++c) EXPECT_EQ(static_cast<float>(reading[c]), xyz.at(x, y, c));
    }
    EXPECT_THROW(ports.measure_xyz({-1.0, 5.0}), std::invalid_argument);
    EXPECT_THROW(ports.measure_xyz({160.0, 5.0}), std::invalid_argument);
    EXPECT_THROW(ports.measure_xyz({std::nan(""), 5.0}), std::invalid_argument);
}

TEST(Bench, PhotographsOfASmallSquareStandWhereOpenCvProjectsIt) {
    BenchDescription description = wall_bench();
    description.camera.view.distortion = {-0.25, 0.12, 0.003, -0.002, 0.02};
    description.samples_a_side = 8;
    Bench bench(description, product_of(make_wall()));
    auto ports = bench.ports();
    const View& projector = description.projector.view;
    const View& camera = description.camera.view;

    // OpenCV's description of the same camera, whose pixel centres are at integers.
    const glm::dmat3& r = camera.view_from_world.rotation;
    const glm::dvec3& t = camera.view_from_world.translation;
    const cv::Matx33d rotation(
        r[0][0], r[1][0], r[2][0], r[0][1], r[1][1], r[2][1], r[0][2], r[1][2], r[2][2]);
    cv::Mat rodrigues;
    cv::Rodrigues(rotation, rodrigues);
    const cv::Matx33d matrix(camera.focal_px.x,
                             0,
                             camera.principal_px.x - 0.5,
                             0,
                             camera.focal_px.y,
                             camera.principal_px.y - 0.5,
                             0,
                             0,
                             1);
    const std::vector<double> lens(camera.distortion.begin(), camera.distortion.end());

    for (const auto& [x0, y0] : {std::pair(12, 12), std::pair(76, 56), std::pair(142, 96)}) {
        constexpr int kSide = 6;
        Image8 picture(projector.width, projector.height, 3);
        for (int y = y0; y < y0 + kSide; ++y) {
            for (int x = x0; x < x0 + kSide; ++x) picture.at(x, y, 1) = 255;
        }
        ports.show(picture);
        const Photograph photograph = ports.photograph(0.0);
        double sum = 0.0, sum_x = 0.0, sum_y = 0.0;
        for (int y = 0; y < photograph.image.height; ++y) {
            for (int x = 0; x < photograph.image.width; ++x) {
                const double light = photograph.image.at(x, y, 1) - photograph.black_level;
                sum += light;
                sum_x += light * x;
                sum_y += light * y;
            }
        }
        ASSERT_GT(sum, 0.0);

        // Centroid of the square's image: fine points of it, each weighed with its brightness on
        // the wall and the area that it covers in the photograph.
        constexpr int kFine = 48;
        const double step = static_cast<double>(kSide) / kFine;
        std::vector<cv::Point3d> points;
        std::vector<double> brightness;
        for (int j = 0; j <= kFine; ++j) {
            for (int i = 0; i <= kFine; ++i) {
                const Ray ray = ray_through(projector, {x0 + i * step, y0 + j * step});
                const glm::dvec3 p = ray.origin - ray.direction * (ray.origin.z / ray.direction.z);
                points.emplace_back(p.x, p.y, p.z);
                brightness.push_back(std::pow(-ray.direction.z, 3.0));
            }
        }
        std::vector<cv::Point2d> image;
        cv::projectPoints(points, rodrigues, cv::Vec3d(t.x, t.y, t.z), matrix, lens, image);
        double weight = 0.0, mean_x = 0.0, mean_y = 0.0;
        for (int j = 0; j < kFine; ++j) {
            for (int i = 0; i < kFine; ++i) {
                const auto k = static_cast<std::size_t>(j * (kFine + 1) + i);
                const cv::Point2d a = image[k], b = image[k + 1], c = image[k + kFine + 1];
                const double area = std::abs((b - a).cross(c - a)) * brightness[k];
                const cv::Point2d middle = 0.5 * (b + c);
                weight += area;
                mean_x += area * middle.x;
                mean_y += area * middle.y;
            }
        }
        // The square's edge crosses some 30 pixels, each known to 1/64 of its area or so: .01 px.
        // The lens moves the corner squares by pixels.
        EXPECT_NEAR(sum_x / sum, mean_x / weight, 0.015) << x0;
        EXPECT_NEAR(sum_y / sum, mean_y / weight, 0.015) << y0;
    }
}

TEST(Bench, ASmallPlateCastsAShadowOnTheWall) {
    // A plate of 20 x 20 mm halfway to the projector shades 40 x 40 mm of the wall.
    Mesh mesh = make_wall();
    append(mesh, make_rectangle({-10, -10, 250}, {20, 0, 0}, {0, 20, 0}, "plate"), "");
    const BenchDescription description = wall_bench();
    Bench bench(description, product_of(mesh));
    auto ports = bench.ports();
    ports.show(filled(description, 255, 255, 255));
    const Photograph photograph = ports.photograph(0.0);
    const auto green_at = [&](const glm::dvec3& place) {
        const auto pixel = project(description.camera.view, place);
        return photograph.image.at(static_cast<int>(pixel->x), static_cast<int>(pixel->y), 1) -
               photograph.black_level;
    };
    // Seen past the plate from the camera's side: the right half of the shadow.
    EXPECT_EQ(green_at({-17, 0, 0}), 0.0);
    EXPECT_EQ(green_at({-17, 17, 0}), 0.0);
    EXPECT_GT(green_at({-24, 0, 0}), 1000.0);
    EXPECT_GT(green_at({-17, 24, 0}), 1000.0);

    // The outline of the plate is an edge in the truth, the middle of the wall is not.
    const auto& truth = bench.truth();
    const auto corner = project(description.projector.view, {-10, 0, 250});
    EXPECT_EQ(truth.edge.at(static_cast<int>(corner->x), static_cast<int>(corner->y)), 255);
    EXPECT_EQ(truth.edge.at(20, 20), 0);
    EXPECT_EQ(truth.edge.at(80, 60), 0);
}

// A plate as the mock-up, the wall behind it as its surroundings.
TEST(Bench, WhatStandsAroundTheMockupIsSeenAndNotJudged) {
    const Mesh plate = make_rectangle({-40, -30, 60}, {80, 0, 0}, {0, 60, 0}, "plate");
    BenchDescription description = wall_bench();
    const Bench alone(description, product_of(plate));
    SurroundingDescription& wall = description.surroundings["wall"];
    wall.corner_mm = {-180, -140, 0};
    wall.side_a_mm = {360, 0, 0};
    wall.side_b_mm = {0, 280, 0};
    wall.surface.reflectance = flat(0.25);
    Bench bench(description, product_of(plate));

    // What counts is the plate, as without a wall.
    EXPECT_EQ(bench.truth().lit.values, alone.truth().lit.values);
    const ImageF with = bench.observe_xyz(filled(description, 255, 255, 255));
    const ImageF without = alone.observe_xyz(filled(description, 255, 255, 255));
    EXPECT_EQ(with.at(80, 60, 1), without.at(80, 60, 1));
    // The wall is lit: a quarter at 500 mm, in units of white at the plate's 440 mm
    EXPECT_EQ(without.at(8, 60, 1), 0.0f);
    const double cosine = -ray_through(description.projector.view, {8.5, 60.5}).direction.z;
    EXPECT_NEAR(with.at(8, 60, 1), 0.25 * std::pow(cosine, 3) * 440 * 440 / (500.0 * 500.0), 2e-4);

    // The camera sees the wall, and the plate's shadow on it.
    const BenchPorts ports = bench.ports();
    ports.show(filled(description, 255, 255, 255));
    const Photograph photograph = ports.photograph(0.0);
    const auto light_at = [&](const glm::dvec3& x_mm) {
        const glm::dvec2 pixel = *project(description.camera.view, x_mm);
        return photograph.image.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y), 1) -
               static_cast<float>(photograph.black_level);
    };
    EXPECT_GT(light_at({-80, 0, 0}), 500.0f);
    EXPECT_LT(light_at({38, 0, 0}), 10.0f) << "the shadow's border lies at 45.5 mm";

    description.surroundings["plate"] = wall;
    EXPECT_THROW(Bench(description, product_of(plate)), std::invalid_argument);
}

TEST(Bench, TruthSaysWhatTheEyeSees) {
    // The eye looks at the wall from behind the plate's shadow side: the plate hides some of it.
    Mesh mesh = make_wall();
    append(mesh, make_rectangle({-40, -40, 100}, {80, 0, 0}, {0, 80, 0}, "plate"), "");
    BenchDescription description = wall_bench();
    description.eye_mm = {300, 0, 400};
    const Bench bench(description, product_of(mesh));
    const auto seen_at = [&](const glm::dvec3& place) {
        const auto pixel = project(description.projector.view, place);
        return bench.truth().seen_by_eye.at(static_cast<int>(pixel->x), static_cast<int>(pixel->y));
    };
    EXPECT_EQ(seen_at({-100, 0, 0}), 0);     // the line to the eye meets z = 100 at x = 0
    EXPECT_EQ(seen_at({-100, 70, 0}), 255);  // and here above the plate
    EXPECT_EQ(seen_at({100, 0, 0}), 255);
}

TEST(Bench, TheSameCallsGiveTheSamePhotographsAndEachHasItsOwnNoise) {
    BenchDescription description = wall_bench();
    description.camera.electrons_per_unit = 5.0;
    description.camera.read_noise_units = 4.0;
    const auto first_two = [&] {
        Bench bench(description, product_of(make_wall()));
        auto ports = bench.ports();
        ports.show(filled(description, 128, 128, 128));
        const auto a = ports.photograph(0.0).image.values;
        return std::pair(a, ports.photograph(0.0).image.values);
    };
    const auto one = first_two(), other = first_two();
    EXPECT_EQ(one.first, other.first);
    EXPECT_EQ(one.second, other.second);
    EXPECT_NE(one.first, one.second);
    description.seed = 2;
    EXPECT_NE(one.first, first_two().first);
}

TEST(Bench, RefusesWhatItCannotSimulate) {
    const auto message = [](const BenchDescription& bench, std::shared_ptr<const Product> product) {
        try {
            const Bench made(bench, product);
        } catch (const std::invalid_argument& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    const auto wall = product_of(make_wall());
    BenchDescription bench = wall_bench();
    EXPECT_EQ(message(bench, nullptr), "bench: no mock-up");
    bench.mockup.surfaces["door"] = bench.mockup.surfaces["*"];
    EXPECT_EQ(message(bench, wall), "bench: no part 'door' in the mock-up; it has wall");
    bench = wall_bench();
    bench.mockup.surfaces.clear();
    EXPECT_EQ(message(bench, wall), "bench: no reflectance for part 'wall' and none for \"*\"");
    bench = wall_bench();
    bench.camera.view.width = 0;
    EXPECT_EQ(message(bench, wall), "bench: a camera of 0 x 180 pixels");
    bench = wall_bench();
    for (auto& curve : bench.camera.sensitivities) curve.fill(0.0);
    EXPECT_EQ(message(bench, wall), "bench: a camera that is blind to the projector");
    bench = wall_bench();
    bench.camera.view = look_at({0, 0, 500}, {0, 0, 900}, 0.4, 240, 180);
    EXPECT_EQ(message(bench, wall), "bench: the camera sees nothing that the projector lights");

    Bench made(wall_bench(), wall);
    EXPECT_THROW(made.ports().show(Image8(80, 60, 3)), std::invalid_argument);
    EXPECT_THROW(made.reachable(ImageF(80, 60, 3)), std::invalid_argument);
}

}  // namespace
}  // namespace livery
