// Pose, lenses and stereo pose from what the camera sees on the mesh, in projector pixels.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "calibration/geometry/solve_pair.h"
#include "calibration/scan/scan.h"
#include "core/progress.h"
#include "mesh/mesh.h"
#include "tracing/tracer.h"

namespace livery {

/// How well the calibration is known beforehand: standard deviations.
struct LensPrior {
    double focal = 0.01;         ///< relative, of camera and projector each
    double principal = 0.003;    ///< of the picture's width
    double distortion = 0.002;   ///< of k1, k2 and k3, camera and projector each
    double tangential = 0.0003;  ///< of p1 and p2
    double turn_rad = 0.005;     ///< of the camera against the projector
    double shift = 0.005;        ///< the same, of the distance to the mock-up
    /// From boards, one a sight (or one for all); in place of all above where there are any.
    std::vector<PairInformation> boards;
    bool scale_free = false;  ///< whether the mock-up is as large as its mesh says
    double scale = 0.05;      ///< relative, where it is free
    bool lens_fixed = false;  ///< nothing but the mock-up's pose (and scale) is sought
};

/// Whether it is symmetric and positive.
bool is_information(const PairInformation& values);

/// One thing that was sought besides the pose.
struct Refined {
    std::string name;     ///< "projector focal", "camera principal x", ...
    double change = 0.0;  ///< against what was given: relative, pixels, radians or millimetres
    double sigma = 0.0;   ///< afterwards, the same unit
    double prior = 0.0;   ///< beforehand
    /// Whether the photographs say more of it than was known before.
    bool is_identified() const { return sigma < 0.5 * prior; }
};

inline constexpr double kMisfitLimit_px = 5.0;

struct PixelRefinement {
    View projector;             ///< world: the mesh
    std::vector<View> cameras;  ///< one a sight, world: the mesh
    double mesh_scale = 1.0;    ///< mock-up over mesh
    double rms_px = 0.0;        ///< of the inliers, in projector pixels, a coordinate
    double median_px = 0.0;     ///< of their distances
    double rms_mm = 0.0;        ///< of the same on the mock-up
    /// Of all correspondences, root mean square of their distances, each at most kMisfitLimit_px.
    double misfit_px = 0.0;
    std::size_t inliers = 0, correspondences = 0;
    /// Of the pose projector_from_mesh: rotation vector (rad) and translation (mm), applied on the
    /// projector's side; row by row.
    std::array<double, 36> covariance{};
    std::vector<Refined> lens;
};

/// Each projector pixel p that falls on the mesh and is seen by a camera at c: the camera's ray
/// through c meets the mesh's tangent plane in a point, and that point's place in the projector's
/// picture, minus p, is the residual. Minimised over the pose, with Gaussian priors over focal
/// lengths, principal points, distortion and the camera's pose against the projector, with a Cauchy
/// loss (Ceres); planes are found anew until nothing changes. Neighbouring pixels err together and
/// weigh against the priors by as many as err on their own. `ignored` as for evidence_of(). Throws
/// Refused where fewer than 200 pixels fall on the mesh.
PixelRefinement refine_on_pixels(const Mesh& mesh,
                                 const Tracer& tracer,
                                 const View& projector,
                                 const std::vector<Sight>& sights,
                                 const Rigid3& world_from_mesh,
                                 const Image8& ignored,
                                 const LensPrior& prior,
                                 const Progress& progress = {});

}  // namespace livery
