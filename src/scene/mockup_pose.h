// Where the mock-up was found, with what that is worth, and its file.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace livery
