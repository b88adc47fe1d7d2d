// How well the lenses of a camera and a projector and the pose between them are known, together.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/progress.h"
#include "scene/view.h"

namespace livery {

/// A lens changes in its relative focal length, its principal point (pixels) and its distortion k1,
/// k2, p1, p2, k3; the pose between the two in a small turn (rad), then a shift (mm), of
/// camera_from_projector.
inline constexpr int kLensTerms = 8, kPoseTerms = 6;
inline constexpr int kPairTerms = 2 * kLensTerms + kPoseTerms;

/// Inverse covariance of those changes, row by row: projector's lens, camera's lens, pose between
/// them.
using PairInformation = std::array<double, static_cast<std::size_t>(kPairTerms* kPairTerms)>;

/// One pose of the board: point for point on the board's plane, in the camera's picture and in the
/// projector's (pixel centres at halves).
struct BoardSight {
    std::vector<glm::dvec2> board_mm;
    std::vector<glm::dvec2> camera_px;
    std::vector<glm::dvec2> projector_px;
};

struct PairSolution {
    View camera;     ///< the world is its frame
    View projector;  ///< view_from_world is projector_from_camera
    std::vector<Rigid3> camera_from_board;
    double camera_rms_px = 0.0, projector_rms_px = 0.0;
    /// Of fx, fy, cx, cy, in pixels, at the spread of the residuals.
    std::array<double, 4> camera_standard_error_px{}, projector_standard_error_px{};
    /// Of the projector's pose from the camera: a small turn on the projector's side, and the
    /// shift.
    std::array<double, 3> turn_standard_error_rad{}, shift_standard_error_mm{};
    PairInformation information{};  ///< of all of these together, distortion too
};

struct PictureSize {
    int width = 0, height = 0;
};

/// Bundle adjustment of both lenses, the pose between them and the board's poses together, with a
/// Huber loss. Distortion has a prior (k1, k2, k3: 0.5, p1, p2: 0.003), which says what real lenses
/// have: terms that the boards do not tell stay near 0, and their uncertainty is in that of the
/// others. From several starts, because the projector's principal point may lie outside its
/// picture. Throws Refused for fewer than three poses, for boards that are all parallel and where
/// a focal length's standard error exceeds 5% of it. `near`: a solution for the
/// same sights together with others, to begin at in place of the several starts.
PairSolution solve_pair(std::span<const BoardSight> sights,
                        PictureSize camera,
                        PictureSize projector,
                        const PairSolution* near = nullptr,
                        const Progress& progress = {});

/// RMS distance in the projector of a sight that was not fitted: the camera finds the board's pose
/// alone, its points are projected. Nothing where a point falls behind a lens.
std::optional<double> held_out_px(const PairSolution& solution, const BoardSight& sight);

struct CheckedPair {
    PairSolution solution;            ///< of all sights
    std::vector<double> held_out_px;  ///< a sight, by the solution of the others
    double held_out_rms_px = 0.0;     ///< over the sights
};

/// solve_pair(), then once more without each sight (leave-one-out). Throws Refused as solve_pair(),
/// for fewer than four sights, and where the others do not determine the lenses. Cancelled ends it
/// at the next iteration of the fit it is in.
CheckedPair solve_leaving_each_out(std::span<const BoardSight> sights,
                                   PictureSize camera,
                                   PictureSize projector,
                                   const Progress& progress = {});

}  // namespace livery
