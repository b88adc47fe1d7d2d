// A pose from points that somebody picked on the mesh and in a picture.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

struct MeshPick {
    glm::dvec3 mesh_mm{0.0};
    glm::dvec2 pixel{0.0};  ///< centres at half integers
    std::string name;       ///< for messages: "line 4"
};

/// CSV x_mm,y_mm,z_mm,u_px,v_px; pixel centres at integers, as OpenCV counts. Throws FileError.
std::vector<MeshPick> read_picked_points(const std::filesystem::path& file);
/// The same of its text.
std::vector<MeshPick> parse_picked_points(const std::string& text,
                                          const std::filesystem::path& file);

struct PickedPose {
    Rigid3 view_from_mesh;
    double rms_px = 0.0, rms_mm = 0.0;  ///< of the inliers' distances; mm at their depth
    std::vector<std::size_t> inliers;   ///< indices
    std::optional<std::size_t> bad;     ///< a click that was left out
    double bad_px = 0.0;                ///< how far it lies from its place in this pose
    /// Rotation vector (rad) and translation (mm), both applied after the pose, in the view's
    /// frame; row by row.
    std::array<double, 36> covariance{};
};

inline constexpr std::size_t kLeastPoints = 6;

/// Least squares of the distances in the picture of `view`, whose lens is known and whose pose is
/// not looked at, from 48 starting turns. One bad click among them is found by leaving each out in
/// turn. Throws Refused: fewer than six distinct points, points on a line, two poses that fit
/// alike, points that hold the pose worse than a hundredth of the picture over the mesh, clicks
/// that agree with no pose.
PickedPose pose_from_points(const View& view,
                            std::span<const MeshPick> points,
                            const Bounds& mesh_mm,
                            const Progress& progress = {});

/// What the pose's covariance comes to in the picture of a view, which may be another than that of
/// the points: the largest standard deviation of the place of a corner of the mesh's box, pixels.
/// Infinite where one lies behind the view.
double held_px(const View& lens,
               const Rigid3& view_from_picked,
               const PickedPose& pose,
               const Bounds& mesh_mm);

}  // namespace livery
