// What livery measure environment says of photographs that are not as they should be.

#include <atomic>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "core/worst_error.h"
#include "jobs/ball_bench.h"
#include "jobs/file_check.h"
#include "support/file_error.h"
#include "support/message_of.h"

namespace livery {
namespace {

constexpr int kSmallSize_px = 192;

class EnvironmentProblems : public ::testing::Test {
  protected:
    EnvironmentProblems() : bench_(kSmallSize_px, 1, in_working(room_rec709)) {}

    ::testing::AssertionResult fails(std::initializer_list<std::string_view> parts) const {
        bench_.rewrite();
        return fails_with([&] { bench_.measure(64); }, parts);
    }
    std::string refusal() const {
        bench_.rewrite();
        return message_of([&] { bench_.measure(64); });
    }
    Json& view() { return bench_.manifest["views"][0]; }
    Json& captures() { return view()["captures"]; }
    /// Every photograph as floating-point light, units a second times its exposure.
    void photograph_again(const ImageF& light) {
        Json list = Json::array();
        write_exr(bench_.captures() / "light.exr", light);
        list.push_back({{"file", "light.exr"},
                        {"exposure_s", 1.0},
                        {"saturates_at", 1e9},
                        {"black_level", 0}});
        captures() = list;
    }

    BallBench bench_;
};

TEST_F(EnvironmentProblems, ABallHalfOutOfThePicture) {
    // The left half of every photograph, by a camera file that says so.
    const View& whole = bench_.stand.cameras[0].view;
    const View half = cropped(whole, 0, 0, kSmallSize_px / 2, kSmallSize_px);
    write_camera_file(bench_.captures() / "camera-1.json", half);
    for (const Json& capture : captures()) {
        const auto file = bench_.captures() / capture["file"].get<std::string>();
        const ImageF picture =
            crop(read_image(file).image, {0, 0, kSmallSize_px / 2, kSmallSize_px});
        Image16 out(picture.width, picture.height, 3);
        for (std::size_t k = 0; k < out.values.size(); ++k) {
            out.values[k] = static_cast<std::uint16_t>(picture.values[k]);
        }
        write_png(file, out);
    }
    const EnvironmentMeasurement report = bench_.measure(128);
    // The ball's middle is 2.3 px of 72 beyond the cut, and what no picture shows is behind the
    // ball.
    EXPECT_NEAR(report.filled, 0.53, 0.04);
    EXPECT_NE(report.notes.back().find("% of all directions are filled"), std::string::npos);
    // The half that is seen is right: from the camera's left, -x.
    const ImageF map = bench_.map();
    for (const glm::dvec3 d : {glm::dvec3(-1, 0, 0), glm::dvec3(-0.8, 0.5, 0.0)}) {
        const glm::dvec3 toward = glm::normalize(d);
        EXPECT_NEAR(light_in(map)(toward).y / room_rec709(toward).y, 1.0, 0.05);
    }
    // The whole beside the half.
    bench_.manifest["sphere"]["centre_mm"] = {300.0, 0.0, 0.0};
    EXPECT_TRUE(fails({"manifest.json: sphere.centre_mm", "outside of the picture"}));
}

TEST_F(EnvironmentProblems, ABallSaturatedInEveryPhotograph) {
    captures().erase(captures().begin(), captures().end() - 1);
    captures()[0]["saturates_at"] = 1030;  // five units over black
    captures()[0]["black_level"] = 1024;
    EXPECT_NE(refusal().find("saturated in every photograph"), std::string::npos) << refusal();
}

TEST_F(EnvironmentProblems, AClippedLampIsNamedWithWhatItGives) {
    // Only the longest but one is left: what is bright is clipped, what is not is right.
    captures() = Json::array({captures()[captures().size() - 2]});
    bench_.rewrite();
    const EnvironmentMeasurement report = bench_.measure(256);
    EXPECT_GT(report.saturated_texels, 10u);
    ASSERT_FALSE(report.clipped.empty());
    // The lamp at (0.3, 0.2, -1) is behind the ball, coarse; the strip and the window are clear.
    bool strip = false;
    for (const ClippedLamp& lamp : report.clipped) {
        strip =
            strip || glm::dot(lamp.direction, glm::normalize(glm::dvec3(0.5, 0.9, -0.3))) > 0.99;
        EXPECT_GT(lamp.irradiance_share, 0.0);
        EXPECT_LE(lamp.irradiance_share, 1.0);
    }
    EXPECT_TRUE(strip);
    ASSERT_GE(report.notes.size(), 2u);
    EXPECT_NE(report.notes[0].find("view 1 has one exposure"), std::string::npos);
    EXPECT_NE(report.notes[1].find("is clipped in the shortest exposure"), std::string::npos);
    EXPECT_NE(report.notes[1].find("% more light"), std::string::npos);
    const ImageF map = bench_.map();
    const glm::dvec3 wall = glm::normalize(glm::dvec3(0.9, -0.3, 0.3));
    EXPECT_NEAR(light_in(map)(wall).y / room_rec709(wall).y, 1.0, 0.05);
}

TEST_F(EnvironmentProblems, PixelsThatAreNoNumbers) {
    ImageF light(kSmallSize_px, kSmallSize_px, 3, 100.0f);
    light.at(90, 80, 1) = std::numeric_limits<float>::quiet_NaN();
    photograph_again(light);
    EXPECT_TRUE(fails({"light.exr: pixel 90,80: found NaN"}));
    light.at(90, 80, 1) = std::numeric_limits<float>::infinity();
    photograph_again(light);
    EXPECT_TRUE(fails({"light.exr: pixel 90,80: found infinity"}));
    // Dark everywhere.
    photograph_again(ImageF(kSmallSize_px, kSmallSize_px, 3));
    EXPECT_NE(refusal().find("show no light"), std::string::npos) << refusal();
}

TEST_F(EnvironmentProblems, FilesThatAreDamaged) {
    const auto file = bench_.captures() / "000.png";
    const std::string bytes = read_text_file(file);
    bench_.folder.write("captures/000.png", bytes.substr(0, bytes.size() / 2));
    EXPECT_TRUE(fails({"000.png"}));
    const FileCheck check = check_file(bench_.captures());
    EXPECT_EQ(check.kind, "environment captures");
    ASSERT_EQ(check.problems.size(), 1u);
    EXPECT_NE(check.problems[0].find("000.png"), std::string::npos);
    bench_.folder.write("captures/000.png", bytes);
    EXPECT_TRUE(check_file(bench_.captures()).problems.empty());
    bench_.folder.write("captures/manifest.json", "{\"environment\": \"ball\"");
    EXPECT_TRUE(fails_with([&] { bench_.measure(64); }, {"manifest.json", "line 1"}));
}

TEST_F(EnvironmentProblems, ABallThatCannotBe) {
    bench_.manifest["sphere"]["diameter_mm"] = 0.0;
    EXPECT_TRUE(fails({"sphere.diameter_mm: found 0"}));
    bench_.manifest["sphere"]["diameter_mm"] = 1700.0;
    EXPECT_TRUE(fails({"manifest.json", "a camera inside the ball, 800.0 mm from its middle"}));
    bench_.manifest["sphere"]["diameter_mm"] = 5.0;
    EXPECT_TRUE(fails({"sphere.diameter_mm: found a sphere of", "40 px or more"}));
    bench_.manifest["sphere"] = {{"diameter_mm", 80.0}, {"centre_mm", {0, 0, 1600}}};
    EXPECT_TRUE(fails({"sphere.centre_mm: found a sphere that is not before the camera"}));
}

TEST_F(EnvironmentProblems, PicturesOfAnotherSize) {
    write_png(bench_.captures() / "000.png", Image16(100, 100, 3, 5000));
    EXPECT_TRUE(fails({"000.png: size: found 100x100, expected the camera's 192x192"}));
    write_png(bench_.captures() / "000.png", Image16(kSmallSize_px, kSmallSize_px, 3, 5000));
    write_png(bench_.captures() / "mask.png", Image8(100, 100, 1, 0));
    view()["mask"] = "mask.png";
    EXPECT_TRUE(fails({"mask.png: size: found 100x100, expected the photographs' 192x192"}));
    // Everything is left out.
    write_png(bench_.captures() / "mask.png", Image8(kSmallSize_px, kSmallSize_px, 1, 255));
    EXPECT_NE(refusal().find("no direction's light"), std::string::npos) << refusal();
}

TEST_F(EnvironmentProblems, ArgumentsThatCannotBe) {
    const auto wrong = [&](const std::function<void(EnvironmentRequest&)>& change) {
        EnvironmentRequest request = bench_.request(64);
        change(request);
        return message_of([&] { measure_environment(request); });
    };
    EXPECT_NE(wrong([](auto& r) { r.out = "a.hdr"; }).find("--out: found \"a.hdr\""),
              std::string::npos);
    EXPECT_NE(wrong([](auto& r) { r.mask = "a.png"; }).find("--mask"), std::string::npos);
    EXPECT_NE(wrong([](auto& r) { r.width = 101; }).find("--width: found 101"), std::string::npos);
    EXPECT_NE(wrong([](auto& r) { r.width = 100'000; }).find("--width"), std::string::npos);
    EXPECT_NE(wrong([](auto& r) { r.scale = -1.0; }).find("--scale: found -1"), std::string::npos);
    EXPECT_NE(wrong([](auto& r) {
                  r.reflectance = glm::dvec3(0.5, 0.0, 1.0);
              }).find("--ball-reflectance: found 0"),
              std::string::npos);
    EXPECT_NE(wrong([](auto& r) { r.captures = "/nowhere"; }).find("no such folder"),
              std::string::npos);
    EXPECT_TRUE(fails_with(
        [&] {
            EnvironmentRequest request = bench_.request(64);
            request.out = bench_.folder / "no/room.exr";
            measure_environment(request);
        },
        {"no/room.exr"}));
}

TEST_F(EnvironmentProblems, WhiteThatFacesTheLightHasLuminanceOne) {
    EnvironmentRequest request = bench_.request(128);
    const EnvironmentMeasurement told = measure_environment(request);
    request.scale.reset();
    const EnvironmentMeasurement own = measure_environment(request);
    const ImageF map = bench_.map();
    double brightest = 0.0;
    for (const glm::dvec3& normal : even_directions(120)) {
        const glm::dvec3 light = irradiance_of(light_in(map), normal);
        brightest = worse_of(brightest, (xyz_from_rec709() * light).y / std::numbers::pi);
    }
    EXPECT_NEAR(brightest, 1.0, 0.02);
    EXPECT_NEAR(own.mean_luminance / told.mean_luminance, own.scale / told.scale, 1e-6);
}

TEST_F(EnvironmentProblems, StopsWhenAsked) {
    const std::atomic<bool> stop = true;
    EXPECT_THROW(measure_environment(bench_.request(64), {{}, &stop}), Cancelled);
    EXPECT_FALSE(std::filesystem::exists(bench_.out()));
    SimulatedBallRequest request;
    request.stand = usual_mirror_ball_stand(noisy_ball_camera(), 64, 1);
    request.light_from = in_working(room_rec709);
    request.out = bench_.folder / "other";
    EXPECT_THROW(photograph_ball(request, {{}, &stop}), Cancelled);
    EXPECT_FALSE(std::filesystem::exists(bench_.folder / "other/manifest.json"));
}

}  // namespace
}  // namespace livery
