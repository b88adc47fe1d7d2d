// `calibrate geometry` without its command line: real photographs of a board, and what is refused.
#include "jobs/pair_geometry.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/paths.h"
#include "support/reference_data.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

PairGeometryRequest real_poses(const std::filesystem::path& data, int count) {
    PairGeometryRequest request;
    for (int pose = 0; pose < count; ++pose)
        request.captures.push_back(data / "procam" / ("capture_" + std::to_string(pose)));
    request.projector_px = {1024, 768};
    request.board_corners = {9, 7};
    request.square_mm = 75.0;
    return request;
}

// What plain OpenCV reaches on these is measured by test_geometry; 0.7 px is asked of every pose.
TEST(PairGeometry, OfRealPhotographsUsesAllPosesAndForetellsEach) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const PairGeometry found = find_pair_geometry(real_poses(data, 4));
    ASSERT_EQ(found.poses.size(), 4u);
    for (const BoardPose& pose : found.poses) {
        EXPECT_TRUE(pose.used) << pose.reason;
        EXPECT_EQ(pose.corners, 63u);
        EXPECT_LT(pose.rms_px, 0.7);
    }
    std::printf("    held out %.3f px, camera %.3f px, projector %.3f px, %s\n",
                found.held_out_rms_px,
                found.camera_rms_px,
                found.projector_rms_px,
                found.lens_model.c_str());
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
    EXPECT_EQ(lens_prior_of(folder / "geometry").principal, LensPrior{}.principal);
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
    EXPECT_NE(why_of(real_poses(data, 3)).find("3 of 3 folders show the board"), std::string::npos);
    PairGeometryRequest another = real_poses(data, 4);
    another.board_corners = {11, 6};
    EXPECT_NE(why_of(another).find("no board of 11x6 inner corners"), std::string::npos);

    PairGeometryRequest missing = real_poses(data, 4);
    missing.captures[2] = data / "procam" / "capture_none";
    EXPECT_THROW(find_pair_geometry(missing), FileError);
    PairGeometryRequest flat = real_poses(data, 4);
    flat.square_mm = 0.0;
    EXPECT_THROW(find_pair_geometry(flat), std::invalid_argument);
    // The same pose four times: nothing tells the focal lengths.
    PairGeometryRequest same = real_poses(data, 1);
    for (int k = 0; k < 3; ++k) same.captures.push_back(same.captures.front());
    const std::string why = why_of(same);
    std::printf("    %s\n", why.c_str());
    EXPECT_FALSE(why.empty());
}

TEST(PairGeometry, FilesThatAreNoneAreNamed) {
    const TemporaryFolder folder;
    EXPECT_EQ(lens_prior_of(folder / "nothing").distortion, LensPrior{}.distortion);
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
