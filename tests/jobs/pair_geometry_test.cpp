// `calibrate geometry` without its command line: real photographs of a board, and what is refused.
#include "jobs/pair_geometry.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "calibration/support/board_photographs.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "support/message_of.h"
#include "support/reference_data.h"
#include "support/temporary_folder.h"
#include "support/thorough.h"

namespace livery {
namespace {

PairGeometryRequest real_poses(const std::filesystem::path& data, int count) {
    PairGeometryRequest request;
    for (int pose = 0; pose < count; ++pose)
        request.captures.push_back(data / "procam" / ("capture_" + std::to_string(pose)));
    request.projector_px = {1024, 768};
    request.board = {9, 7, 75.0};
    return request;
}

// What plain OpenCV reaches on these is measured by test_geometry; 0.7 px is asked of every pose.
TEST(PairGeometry, NightlyOfRealPhotographsUsesAllPosesAndForetellsEach) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const PairGeometry found = find_pair_geometry(real_poses(data, 4));
    ASSERT_EQ(found.poses.size(), 4u);
    for (const BoardPose& pose : found.poses) {
        EXPECT_TRUE(pose.used) << pose.reason;
        EXPECT_EQ(pose.corners, 63u);
        EXPECT_LT(pose.rms_px, 0.7);
    }
    std::printf("    held out %.3f px, camera %.3f px, projector %.3f px\n",
                found.held_out_rms_px,
                found.camera_rms_px,
                found.projector_rms_px);
    // The lens is shifted: the axis lies below the projector's picture.
    EXPECT_GT(found.projector.principal_px.y, 768.0);

    // What is written says the same and can be read as what it is.
    const TemporaryFolder folder;
    write_pair_geometry(folder / "geometry", found);
    check_geometry_file(folder / "geometry" / "geometry.json");
    const View camera = read_camera_file(folder / "geometry" / "camera.json");
    const View projector = read_camera_file(folder / "geometry" / "projector.json");
    EXPECT_NEAR(camera.focal_px.x, found.camera.focal_px.x, 1e-6);
    EXPECT_NEAR(projector.view_from_world.translation.x,
                found.projector.view_from_world.translation.x,
                1e-6);
    EXPECT_EQ(lens_prior_of({folder / "geometry"}).boards.size(), 1u);
}

TEST(PairGeometry, SaysOfEachFolderWhyItIsNotUsed) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto why_of = [](const PairGeometryRequest& request) {
        try {
            find_pair_geometry(request);
        } catch (const Refused& refused) {
            EXPECT_FALSE(refused.fix().empty());
            return refused.why();
        }
        ADD_FAILURE() << "accepted";
        return std::string();
    };
    EXPECT_NE(why_of(real_poses(data, 1)).find("1 of 1 folders show the board"), std::string::npos);
    PairGeometryRequest another = real_poses(data, 1);
    another.board = {11, 6, 75.0};
    EXPECT_NE(why_of(another).find("has 9x7 inner corners, not 11x6"), std::string::npos);

    PairGeometryRequest missing = real_poses(data, 4);
    missing.captures[0] = data / "procam" / "capture_none";
    EXPECT_THROW(find_pair_geometry(missing), FileError);
    PairGeometryRequest flat = real_poses(data, 4);
    flat.board.square_mm = 0.0;
    EXPECT_THROW(find_pair_geometry(flat), std::invalid_argument);
    if (!thorough()) return;
    // The same pose four times: nothing tells the focal lengths.
    PairGeometryRequest same = real_poses(data, 1);
    for (int k = 0; k < 3; ++k) same.captures.push_back(same.captures.front());
    const std::string why = why_of(same);
    std::printf("    %s\n", why.c_str());
    EXPECT_FALSE(why.empty());
}

/// A captures folder of one pose.
void write_pose(const std::filesystem::path& folder, const testing::BoardScene& scene) {
    make_output_folder(folder);
    Json captures = Json::array();
    for (const RoledPhotograph& one : testing::photographs_of(scene)) {
        const ImageF& image = one.photograph.image;
        Image16 file(image.width, image.height, 1);
        for (std::size_t i = 0; i < image.values.size(); ++i)
            file.values[i] = static_cast<std::uint16_t>(
                std::lround(40'000.0 * std::clamp(image.values[i] + 0.05, 0.0, 1.5)));
        write_png(folder / (one.role + ".png"), file);
        captures.push_back({{"file", one.role + ".png"},
                            {"pattern", one.role + ".png"},
                            {"role", one.role},
                            {"exposure_s", 1.0},
                            {"black_level", 2000}});
    }
    write_json_file(folder / "manifest.json", {{"projector", {256, 192}}, {"captures", captures}});
}

// Five poses of a board of 75 mm, and one with squares of 60 mm. Corners lie within .2 px (the
// camera's edges) and a third of a pixel (the projector's whole pixels), sixty of them a pose: lens
// and distance to a percent, a pose left out to half a pixel.
TEST(PairGeometry, NightlyOfSimulatedBoardsLeavesOutTheOneOfAnotherSize) {
    const TemporaryFolder folder;
    PairGeometryRequest request;
    request.projector_px = {256, 192};
    request.board = {9, 7, 75.0};
    const std::vector<glm::dvec3> turns = {{0.5, 0, 0},
                                           {-0.45, 0.1, 0},
                                           {0.1, 0.5, 3.1},
                                           {0, -0.5, 0},
                                           {0.3, 0.35, 0.2},
                                           {-0.3, 0.3, 0}};
    testing::BoardScene scene;
    for (std::size_t k = 0; k < turns.size(); ++k) {
        scene = testing::board_scene(turns[k]);
        if (k == 4) scene.reflectance = testing::chessboard(9, 7, 60.0);
        request.captures.push_back(folder / ("pose-" + std::to_string(k)));
        write_pose(request.captures.back(), scene);
    }
    const PairGeometry found = find_pair_geometry(request);
    for (std::size_t k = 0; k < turns.size(); ++k) {
        const BoardPose& pose = found.poses[k];
        std::printf("    pose %zu: %s%.2f px\n", k, (pose.reason + " ").c_str(), pose.rms_px);
        EXPECT_EQ(pose.used, k != 4) << pose.reason;
    }
    EXPECT_NE(found.poses[4].reason.find("another board or a bent one"), std::string::npos);
    EXPECT_LT(found.held_out_rms_px, 0.5);
    EXPECT_NEAR(found.camera.focal_px.x, scene.camera.focal_px.x, 0.01 * scene.camera.focal_px.x);
    EXPECT_NEAR(
        found.projector.focal_px.x, scene.projector.focal_px.x, 0.01 * scene.projector.focal_px.x);
    const double apart_mm = glm::length(inverse(scene.projector.view_from_world).translation);
    EXPECT_NEAR(glm::length(inverse(found.projector.view_from_world).translation),
                apart_mm,
                0.01 * apart_mm);

    // All squares of another size than was said: only the tape tells.
    request.captures.erase(request.captures.begin() + 4);
    request.board.square_mm = 60.0;
    request.lens_distance_mm = apart_mm;
    try {
        find_pair_geometry(request);
        ADD_FAILURE() << "accepted";
    } catch (const Refused& refused) {
        std::printf("    %s\n", refused.what());
        EXPECT_NE(refused.why().find("by the tape"), std::string::npos);
        EXPECT_NE(refused.fix().find("its side is 7"), std::string::npos) << refused.fix();
        EXPECT_NE(refused.fix().find("--square-mm"), std::string::npos);
    }
}

TEST(PairGeometry, InformationOfBoardsIsReadAndChecked) {
    PairGeometry geometry;
    geometry.from_boards = true;
    geometry.camera = geometry.projector = View{640, 480, {800, 800}, {320, 240}, {}, {}};
    for (std::size_t k = 0; k < kPairTerms; ++k) geometry.information[(kPairTerms + 1) * k] = 4.0;
    const TemporaryFolder folder;
    write_pair_geometry(folder.path(), geometry);
    ASSERT_EQ(lens_prior_of({folder.path()}).boards.size(), 1u);
    EXPECT_EQ(lens_prior_of({folder.path()}).boards[0], geometry.information);
    // A second folder that says nothing of it: nobody's information is taken for another's
    EXPECT_TRUE(lens_prior_of({folder.path(), folder / "nothing"}).boards.empty());
    for (const double bad : {-1.0, 9.0}) {
        PairGeometry spoilt = geometry;
        spoilt.information[1] = spoilt.information[kPairTerms] = bad < 0.0 ? 0.0 : bad;
        if (bad < 0.0) spoilt.information[0] = bad;
        write_pair_geometry(folder.path(), spoilt);
        EXPECT_NE(message_of([&] { lens_prior_of({folder.path()}); }).find("information"),
                  std::string::npos);
    }
}

TEST(PairGeometry, FilesThatAreNoneAreNamed) {
    const TemporaryFolder folder;
    EXPECT_EQ(lens_prior_of({folder / "nothing"}).distortion, LensPrior{}.distortion);
    for (const char* text :
         {"{",
          "{}",
          R"({"format_version": 9})",
          R"({"format_version": 1, "kind": "pose"})",
          R"({"format_version": 1, "kind": "geometry", "camera_matrix": [1]})"}) {
        write_text_file(folder / "geometry.json", text);
        EXPECT_THROW(check_geometry_file(folder / "geometry.json"), FileError) << text;
    }
}

}  // namespace
}  // namespace livery
