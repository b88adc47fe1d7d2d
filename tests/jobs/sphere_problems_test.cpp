// What livery measure brdf says of folders that are not as they should be.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "core/paths.h"
#include "core/worst_error.h"
#include "jobs/file_check.h"
#include "jobs/sphere_bench.h"
#include "support/file_error.h"
#include "support/message_of.h"

namespace livery {
namespace {

void six_lamps(SphereStand& stand) {
    stand.lamps_mm = {{60.0, 0.0, 590.0},
                      {400.0, 0.0, 400.0},
                      {-400.0, 300.0, 300.0},
                      {-300.0, -400.0, 300.0},
                      {200.0, 550.0, 100.0},
                      {100.0, -580.0, 100.0}};
}

Material white_paint() {
    Material paint;
    paint.model = ReflectanceModel::lambert;
    paint.diffuse = glm::dvec3(0.95);
    return paint;
}

/// Six lamps around a small picture of a matte sphere.
class SphereProblems : public ::testing::Test {
  protected:
    SphereProblems() : bench_(lambert_paint(), 128, noisy_camera(), six_lamps) {}

    ::testing::AssertionResult fails(std::initializer_list<std::string_view> parts) const {
        bench_.rewrite();
        return fails_with([&] { bench_.measure(); }, parts);
    }
    std::string refusal() const {
        bench_.rewrite();
        return message_of([&] { bench_.measure(); });
    }
    Json& captures() { return bench_.manifest["captures"]; }
    std::filesystem::path picture(const char* name) const { return bench_.captures() / name; }
    View camera() const { return read_camera_file(bench_.captures() / "camera.json"); }

    SphereBench bench_;
};

TEST_F(SphereProblems, NoneAsItWasPhotographed) {
    const SphereMeasurement report = bench_.measure();
    EXPECT_GT(report.samples, 500u);
    EXPECT_LT(report.reflectance.coverage, 0.8);  // six lamps
    const FileCheck check = check_file(bench_.captures());
    EXPECT_EQ(check.kind, "sphere captures");
    EXPECT_TRUE(check.problems.empty()) << check.problems.front();
    EXPECT_TRUE(check_file(bench_.out()).problems.empty());
    EXPECT_EQ(message_of([&] {
                  measure_sphere({bench_.captures(), {}, "paint.binary"});
              }),
              "--out: found \"paint.binary\", expected a name that ends in .csv");
}

TEST_F(SphereProblems, ASphereOutsideOfThePicture) {
    bench_.manifest["sphere"]["centre_mm"] = {150.0, 0.0, 0.0};
    EXPECT_TRUE(fails({"manifest.json: sphere.centre_mm", "outside of the picture"}));
    bench_.manifest["sphere"]["centre_mm"] = {0.0, 0.0, 1100.0};
    EXPECT_TRUE(fails({"sphere.centre_mm", "not before the camera"}));
    bench_.manifest["sphere"] = {{"centre_mm", {0, 0, 0}}, {"diameter_mm", 10}};
    EXPECT_TRUE(fails({"sphere.diameter_mm", "px in the picture", "40 px or more"}));
    // Half of it: there is no outline to trust.
    bench_.manifest["sphere"] = {{"centre_mm", {45, 0, 0}}, {"diameter_mm", 60}};
    EXPECT_NE(refusal().find("outline does not show"), std::string::npos) << refusal();
}

TEST_F(SphereProblems, LampsThatDoNotReachOrBlind) {
    for (Json& capture : captures()) capture["light_position_mm"] = {0, 0, -600};
    EXPECT_NE(refusal().find("no light shines on the side"), std::string::npos) << refusal();
}

TEST_F(SphereProblems, SaturatedEverywhere) {
    bench_.manifest["saturates_at"] = 1030;
    EXPECT_NE(refusal().find("saturated in every photograph"), std::string::npos) << refusal();
}

TEST_F(SphereProblems, ASaturatedOrUnlitWhite) {
    bench_.manifest["white_reference"]["saturates_at"] = 1500;
    EXPECT_NE(refusal().find("white sphere is saturated"), std::string::npos) << refusal();
    bench_.manifest["white_reference"].erase("saturates_at");
    bench_.manifest["white_reference"]["light_position_mm"] = {0, 100, -600};
    EXPECT_NE(refusal().find("stands near the camera"), std::string::npos) << refusal();
    bench_.manifest["white_reference"].erase("light_position_mm");
    write_exr(picture("fog.exr"), ImageF(128, 128, 3, 2000.0f));
    bench_.manifest["white_reference"]["file"] = "fog.exr";
    EXPECT_NE(refusal().find("not brighter than the cloth"), std::string::npos) << refusal();
}

TEST_F(SphereProblems, DamagedPictures) {
    const std::string whole = read_text_file(picture("003.png"));
    write_text_file(picture("003.png"), whole.substr(0, whole.size() / 2));
    EXPECT_TRUE(fails({"003.png", "cut-off"}));
    write_text_file(picture("003.png"), "");
    EXPECT_TRUE(fails({"003.png", "an empty file"}));
    write_text_file(picture("003.png"), "a poem");
    EXPECT_TRUE(fails({"003.png", "content of another kind"}));
    ImageF image(128, 128, 3, 2000.0f);
    image.at(5, 6, 1) = std::numeric_limits<float>::quiet_NaN();
    write_exr(picture("nan.exr"), image);
    captures()[3]["file"] = "nan.exr";
    EXPECT_TRUE(fails({"nan.exr", "pixel 5,6", "NaN"}));
    write_exr(picture("small.exr"), ImageF(64, 128, 3, 2000.0f));
    captures()[3]["file"] = "small.exr";
    EXPECT_TRUE(fails({"small.exr", "size", "64x128", "the camera's 128x128"}));
    captures()[3]["file"] = "missing.exr";
    EXPECT_TRUE(fails({"captures[3].file", "missing.exr"}));
    const FileCheck check = check_file(bench_.captures());
    ASSERT_EQ(check.problems.size(), 1u);
    EXPECT_NE(check.problems[0].find("missing.exr"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(bench_.out()));
}

TEST_F(SphereProblems, BadCamerasAndMatrices) {
    bench_.manifest["camera"] = {{"width", 128}, {"height", 128}};
    EXPECT_TRUE(fails({"manifest.json: camera: matrix", "nothing"}));
    bench_.manifest["camera"] = "camera.json";
    bench_.manifest["camera_to_xyz"] = "no.json";
    EXPECT_TRUE(fails({"no.json"}));
    const auto matrix = [&](const char* text) {
        write_text_file(bench_.captures() / "colours.json", text);
        bench_.manifest["camera_to_xyz"] = "colours.json";
    };
    matrix(R"({"format_version": 7, "matrix": [1, 0, 0, 0, 1, 0, 0, 0, 1]})");
    EXPECT_TRUE(fails({"colours.json", "newer Livery"}));
    matrix(R"({"matrix": [1, 0, 0, 0, 1, 0, 0, 0, -1]})");
    EXPECT_TRUE(fails({"colours.json: matrix", "sees white as"}));
    matrix(R"({"primaries_xyz": {"red": [1, 0, 0], "green": [0, 1, 0], "blue": [0, 0, 1],
               "black": [0, 0, 0]}})");
    EXPECT_TRUE(fails({"colours.json: primaries_xyz", "a projector's primaries"}));
}

TEST_F(SphereProblems, AFolderThatCannotBeWritten) {
    EXPECT_TRUE(fails_with(
        [&] {
            measure_sphere({bench_.captures(), {}, bench_.folder / "no/paint.csv"});
        },
        {"no/paint.csv"}));
}

TEST_F(SphereProblems, WhiteWithoutALightIsRecognised) {
    const double right = bench_.measure().white_rms;
    bench_.manifest["white_reference"].erase("light_position_mm");
    bench_.rewrite();
    EXPECT_DOUBLE_EQ(bench_.measure().white_rms, right);
    EXPECT_LT(right, 0.05);
}

TEST_F(SphereProblems, DoubtsAreNoted) {
    bench_.manifest["white_reference"]["light_position_mm"] = {-400.0, 0.0, 400.0};
    bench_.manifest["sphere"]["centre_mm"] = {2.5, 0.0, 0.0};
    bench_.manifest.erase("camera_to_xyz");
    bench_.rewrite();
    const SphereMeasurement report = bench_.measure();
    EXPECT_EQ(report.camera_colours, "assumed Rec.709");
    ASSERT_EQ(report.notes.size(), 2u);
    EXPECT_NE(report.notes[0].find("the outline lies 2.5"), std::string::npos) << report.notes[0];
    EXPECT_NE(report.notes[1].find("the white sphere differs"), std::string::npos);
}

TEST_F(SphereProblems, ALampOfItsOwnStrengthIsKnownByItsOwnWhite) {
    // What was photographed under the second lamp counts for half the time: it is twice as bright.
    const auto brighten_second = [](Json& list) {
        for (Json& capture : list) {
            if (capture["light_position_mm"] != Json({400.0, 0.0, 400.0})) continue;
            capture["exposure_s"] = 0.5 * capture["exposure_s"].get<double>();
        }
    };
    /// The 10th and 90th percentile of green, over the paint's.
    const auto spread = [&](const SphereMeasurement& report) {
        std::vector<double> values;
        for (const glm::dvec3& value : report.reflectance.values) {
            values.push_back(worst_if_nan(value.y * std::numbers::pi / lambert_paint().diffuse.y));
        }
        std::sort(values.begin(), values.end());
        return glm::dvec2(values[values.size() / 10], values[values.size() * 9 / 10]);
    };
    brighten_second(captures());
    bench_.rewrite();
    EXPECT_GT(spread(bench_.measure()).y, 1.9);

    const SphereBench white(white_paint(), 128, noisy_camera(), six_lamps);
    Json whites = white.manifest["captures"];
    for (Json& capture : whites) {
        const auto file = white.captures() / capture["file"].get<std::string>();
        capture["file"] = std::filesystem::relative(file, bench_.captures()).string();
    }
    brighten_second(whites);
    bench_.manifest["white_reference"] = {{"reflectance", 0.95}, {"captures", whites}};
    bench_.rewrite();
    const SphereMeasurement told = bench_.measure();
    EXPECT_NEAR(told.lamp_spread, 5.0 / 7.0, 0.01);  // five of 1 and one of 2 around 7/6
    EXPECT_EQ(told.white_photographs, whites.size());
    EXPECT_NEAR(spread(told).x, 1.0, 0.05);
    EXPECT_NEAR(spread(told).y, 1.0, 0.05);
}

TEST_F(SphereProblems, StopsWhenAsked) {
    const std::atomic<bool> stop = true;
    EXPECT_THROW(measure_sphere({bench_.captures(), {}, bench_.out()}, {{}, &stop}), Cancelled);
    SimulatedSphereRequest request;
    request.stand = usual_sphere_stand(noisy_camera(), 64, 64);
    request.out = bench_.folder / "other";
    EXPECT_THROW(photograph_sphere(request, {{}, &stop}), Cancelled);
    EXPECT_FALSE(std::filesystem::exists(bench_.folder / "other/manifest.json"));
}

}  // namespace
}  // namespace livery
