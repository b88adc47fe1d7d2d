// Where the mock-up was found, with what that is worth, its file, and the mock-up moved a little as
// it looks from the projector.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

struct MockupPose {
    std::string product;         ///< the file or name that was given
    Rigid3 camera_from_product;  ///< of the product at the mock-up's size: times mesh_scale
    double mesh_scale = 1.0;     ///< mock-up over mesh
    std::string method;          ///< "scan" or "points"
    double rms_px = 0.0, rms_mm = 0.0;
    std::size_t inliers = 0;
    /// Rotation vector (rad) and translation (mm) of the view that it was found in, row by row.
    std::array<double, 36> covariance{};
    std::vector<std::string> warnings;
};

/// `pose.json`. Throws FileError.
MockupPose read_pose_file(const std::filesystem::path& file);
/// The same of its text.
MockupPose parse_mockup_pose(const std::string& text, const std::filesystem::path& file);
void write_pose_file(const std::filesystem::path& file, const MockupPose& pose);

/// In pixels of the projector's picture, so that a step is one that can be seen: how far the
/// mock-up's middle moves, or its rim where it turns or comes nearer.
struct Nudge {
    double right_px = 0.0, down_px = 0.0, nearer_px = 0.0;
    double yaw_px = 0.0;    ///< what faces the projector goes to the right
    double pitch_px = 0.0;  ///< what faces the projector goes down
    double roll_px = 0.0;   ///< clockwise
};

/// The projector's view after the mock-up, which is within `mockup`, was moved by that; the turns
/// are about its middle, one after the other: yaw, pitch, roll. Throws std::invalid_argument when
/// the projector does not see the middle, before or after.
View nudged(const View& projector, const Bounds& mockup, const Nudge& by);

/// How the mock-up was moved between two views of one projector, along and about its axes.
struct MockupMotion {
    glm::dvec3 moved_mm{0.0};  ///< its middle: right, down, away
    double turned_deg = 0.0;
    glm::dvec2 moved_px{0.0};  ///< its middle's picture: right, down
};
MockupMotion motion_between(const View& before, const View& after, const Bounds& mockup);
/// "3.0 px to the right (1.2 mm), 0.8 mm nearer, turned by 0.31 degrees"; "not moved".
std::string in_words(const MockupMotion& motion);

}  // namespace livery
