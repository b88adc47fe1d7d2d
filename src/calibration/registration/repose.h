// Where a mock-up that was bumped stands now, from photographs of stripes and of their inverse.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "calibration/registration/stripes.h"
#include "core/progress.h"
#include "mesh/mesh.h"
#include "scene/view.h"
#include "tracing/tracer.h"

namespace livery {

/// What the calibration knew, and what is photographed now. Views have the product's frame of then
/// for their world.
struct ReposeInput {
    View projector, camera;
    StripeCode code;
    Photograph stripes, inverse;
    /// Turns that the product leaves open (RoomGeometry): they stay as they were.
    int free_turns = 0;
    /// Where the camera saw the projector's pixels off the mock-up (2 channels, NaN: unknown; may
    /// be empty): tells whether projector and camera still stand as they did.
    ImageF around;
};

/// What stands around the mock-up.
struct AroundEvidence {
    std::size_t places = 0;    ///< borders of stripes that were and should be seen there
    double still_share = 0.0;  ///< of them: seen where they were
};

struct Repose {
    View projector, camera;  ///< world: the product's frame, as it stands now
    Rigid3 then_from_now;    ///< x of the mock-up was at x, and is at then_from_now * x
    double moved_mm = 0.0;   ///< the middle of the mock-up's box
    double turned_rad = 0.0;
    double median_px = 0.0;      ///< of the residuals, across the stripes, projector pixels
    double agree_share = 0.0;    ///< of the crossings on the mesh, within kReposeAgrees_px
    std::size_t on_product = 0;  ///< crossings on the mesh
    /// Standard errors by the crossings' scatter, of what is not left open: along the product's
    /// axes, and of the turn about them. A mesh's own errors are not in them.
    glm::dvec3 shift_error_mm{0.0}, turn_error_rad{0.0};
    AroundEvidence around;
    std::vector<std::string> warnings;
};

/// Rounding, noise and a mesh that is off by a few tenths of a millimetre stay below it.
inline constexpr double kReposeAgrees_px = 1.5;

/// Each crossing's ray meets the mesh in a point, and that point's column (row) in the projector's
/// picture minus that of the nearest edge of its sign is the residual: minimised over the mock-up's
/// motion by Gauss and Newton with a Cauchy loss, points and edges found anew each round, from the
/// old place and from places around it. Directions that the surface slips along by less than 3% of
/// the way, as free_turns() has it, stay as they were. Throws Refused: too few crossings on the
/// mock-up, fewer than 60% of them agree, a median over 0.5 px, more left open than the product's
/// own turns, and what stands around shows that projector or camera moved; as see_stripes().
Repose find_mockup_again(const Mesh& mesh,
                         const Tracer& tracer,
                         const ReposeInput& input,
                         const Progress& progress = {});

}  // namespace livery
