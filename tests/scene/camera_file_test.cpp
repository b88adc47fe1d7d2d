#include <fstream>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "core/json.h"
#include "scene/broken.h"
#include "scene/view.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// As another program writes it: OpenCV's numbers and no version.
Json some_camera() {
    return Json::parse(R"({"width": 1280, "height": 800,
        "matrix": [2000, 0, 639.5, 0, 2010, 1100.25, 0, 0, 1],
        "distortion": [-0.05, 0.1, 0.001, -0.002, 0.01],
        "rotation": [1, 0, 0, 0, -1, 0, 0, 0, -1], "translation_mm": [10, -20, 1500]})");
}

TEST(CameraFile, MeansWhatOpenCvMeans) {
    const TemporaryFolder folder;
    const View view = read_camera_file(folder.write("camera.json", some_camera().dump()));
    EXPECT_EQ(view.width, 1280);
    EXPECT_EQ(view.principal_px, glm::dvec2(640.0, 1100.75));
    const glm::dvec3 x_in_world(120.0, 300.0, -40.0);
    std::vector<cv::Point2d> pixel;
    cv::Vec3d rotation;
    cv::Rodrigues(cv::Matx33d(1, 0, 0, 0, -1, 0, 0, 0, -1), rotation);
    cv::projectPoints(std::vector<cv::Point3d>{{120, 300, -40}},
                      rotation,
                      cv::Vec3d(10, -20, 1500),
                      cv::Matx33d(2000, 0, 639.5, 0, 2010, 1100.25, 0, 0, 1),
                      std::vector<double>{-0.05, 0.1, 0.001, -0.002, 0.01},
                      pixel);
    const auto ours = project(view, x_in_world);
    ASSERT_TRUE(ours);
    // A file's integer centres are half a pixel less than ours.
    EXPECT_LT(glm::distance(*ours - 0.5, {pixel[0].x, pixel[0].y}), 1e-6);
}

TEST(CameraFile, ComesBackAsItWas) {
    const TemporaryFolder folder;
    View view = look_at({400, 300, 900}, {10, 20, 30}, 0.7, 1920, 1080);
    view.distortion = {-0.1, 0.02, 1e-3, -2e-3, 1.0 / 3.0};
    view.principal_px.y = 1500.0;
    write_camera_file(folder / "view.json", view);
    const View back = read_camera_file(folder / "view.json");
    EXPECT_EQ(back.focal_px, view.focal_px);
    EXPECT_EQ(back.principal_px, view.principal_px);
    EXPECT_EQ(back.distortion, view.distortion);
    EXPECT_EQ(back.view_from_world.rotation, view.view_from_world.rotation);
    EXPECT_EQ(back.view_from_world.translation, view.view_from_world.translation);
}

const Broken kBrokenCameras[] = {
    {"width missing", [](Json& c) { c.erase("width"); }, "width: found nothing"},
    {"width zero", [](Json& c) { c["width"] = 0; }, "width: found 0"},
    {"width huge",
     [](Json& c) { c["width"] = 1e9; },
     "width: found 1000000000.0, expected a whole"},
    {"half a pixel", [](Json& c) { c["height"] = 800.5; }, "height: found 800.5"},
    {"short matrix",
     [](Json& c) {
         c["matrix"] = {1, 2};
     },
     "matrix: found 2 elements, expected 9"},
    {"infinite focal length", [](Json& c) { c["matrix"][0] = nullptr; }, "matrix[0]: found null"},
    {"negative focal length",
     [](Json& c) { c["matrix"][4] = -2010; },
     "matrix[4]: found -2010, expected a number between 0.1 and 1e+06"},
    {"endless focal length",
     [](Json& c) { c["matrix"][0] = 3.67e6; },
     "matrix[0]: found 3670000.0, expected a number between"},
    {"endless lens shift", [](Json& c) { c["matrix"][2] = -1e7; }, "matrix[2]: found -10000000.0"},
    {"endless distortion",
     [](Json& c) {
         c["distortion"] = {0, 1e12, 0, 0, 0};
     },
     "distortion[1]: found 1000000000000.0, expected a number between -1e+06 and 1e+06"},
    {"endless translation",
     [](Json& c) { c["translation_mm"][2] = 1e20; },
     "translation_mm[2]: found 1e+20, expected a number between -1e+"},
    {"skew", [](Json& c) { c["matrix"][1] = 3; }, "expected fx, 0, cx, 0, fy, cy, 0, 0, 1"},
    {"transposed matrix",
     [](Json& c) {
         c["matrix"] = {2000, 0, 0, 0, 2010, 0, 639.5, 1100, 1};
     },
     "expected fx, 0, cx, 0, fy, cy, 0, 0, 1"},
    {"eight lens terms",
     [](Json& c) {
         c["distortion"] = {0, 0, 0, 0, 0, 0, 0, 0};
     },
     "distortion: found 8 elements, expected 5 numbers"},
    {"text as a number", [](Json& c) { c["distortion"][2] = "0"; }, "distortion[2]: found \"0\""},
    {"mirror",
     [](Json& c) {
         c["rotation"] = {1, 0, 0, 0, 1, 0, 0, 0, -1};
     },
     "rotation: found a mirror (determinant -1), expected a rotation"},
    {"scale", [](Json& c) { c["rotation"][0] = 1.01; }, "rotation: found rows that are not"},
    {"no translation", [](Json& c) { c.erase("translation_mm"); }, "translation_mm: found nothing"},
    {"newer version",
     [](Json& c) { c["format_version"] = 2; },
     "format_version: found 2 (written by"},
    {"misspelt field", [](Json& c) { c["distorsion"] = 0; }, "the unknown field \"distorsion\""},
};

TEST(CameraFile, EachMistakeIsNamed) {
    const TemporaryFolder folder;
    for (const auto& broken : kBrokenCameras) {
        Json json = some_camera();
        broken.damage(json);
        const auto file = folder.write("camera.json", json.dump());
        EXPECT_TRUE(fails_with([&] { read_camera_file(file); }, {"camera.json", broken.message}))
            << broken.what;
    }
    const std::string good = some_camera().dump();
    EXPECT_TRUE(fails_with([&] { read_camera_file(folder / "gone.json"); }, {"no such file"}));
    EXPECT_TRUE(fails_with([&] { read_camera_file(folder.write("a.json", "")); }, {"empty file"}));
    EXPECT_TRUE(fails_with(
        [&] { read_camera_file(folder.write("a.json", good.substr(0, good.size() / 2))); },
        {"text that is not JSON"}));
    EXPECT_TRUE(fails_with([&] { read_camera_file(folder.write("a.json", "\x89PNG\r\n")); },
                           {"text that is not JSON"}));
}

}  // namespace
}  // namespace livery
