// How camera and projector stand to each other, from what the camera sees of the projector's
// pixels alone: no board, no mesh.
#pragma once

#include "calibration/correspondence/gray_code.h"
#include "calibration/registration/pixel_refinement.h"
#include "core/progress.h"
#include "scene/view.h"

namespace livery {

struct PairPose {
    Rigid3 projector_from_camera;  ///< x_projector = R x_camera + t, millimetres
    double median_px = 0.0;  ///< distance of what is seen from its epipolar line, camera pixels
    double inlier_share = 0.0;
    double turn_sigma_rad = 0.0;   ///< standard deviation of the turn, lenses taken as right
    double shift_sigma_rad = 0.0;  ///< of the shift's direction
};

/// Both views give their lens, their poses are not looked at. Photographs alone leave the size of
/// everything open: `distance_mm` is that between the two lenses, by a tape. And they leave focal
/// lengths open, where camera and projector are aimed at one place: these must be known to a
/// percent or two, from data sheets.
///
/// Essential matrix by eight points (Hartley 1997) in random samples (Fischler and Bolles 1981),
/// the one of its four poses that has everything in front, then least squares of Sampson distances
/// under a Cauchy loss (Ceres). Throws Refused: hardly any pixel decoded, everything on one plane,
/// rays that do not meet.
PairPose pose_of_pair(const View& camera,
                      const View& projector,
                      const ProjectorToCamera& map,
                      double distance_mm,
                      std::uint64_t seed = 1,
                      const Progress& progress = {});

/// What registration may still change where lenses are those of data sheets, without distortion,
/// and the pair stands as pose_of_pair() found: that the tape is off by some percent is in `shift`.
inline LensPrior data_sheet_prior() {
    LensPrior prior;
    prior.principal = 0.01;
    prior.distortion = 0.1;
    prior.tangential = 0.001;
    prior.turn_rad = 0.02;
    prior.shift = 0.02;
    return prior;
}

}  // namespace livery
