// Where a product may stand in a scan, from no starting value; how much of the scan a pose
// explains, and what in it contradicts the pose.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "calibration/registration/surface_samples.h"
#include "calibration/scan/scan.h"
#include "mesh/mesh.h"
#include "scene/view.h"
#include "tracing/tracer.h"

namespace livery {

struct PoseGuess {
    Rigid3 scan_from_mesh;
    double votes = 0.0;
};

/// Poses by voting of oriented point pairs (Drost, Ulrich, Navab, Ilic: "Model globally, match
/// locally", CVPR 2010): each pair of scan samples whose distance and angles are those of a pair
/// of the mesh votes for the pose that lays one over the other. Both sides about `spacing_mm`
/// apart. Poses alike (15 degrees, 3 spacings) are one; the best `most`, by votes. What is not of
/// the product (a table, a hand) makes votes that do not add up.
std::vector<PoseGuess> poses_by_pairs(const SurfaceSamples& mesh,
                                      const SurfaceSamples& scan,
                                      double spacing_mm,
                                      std::size_t most);

/// Counts of projector pixels, of those looked at.
struct PoseEvidence {
    int expected =
        0;            ///< where the mesh would be lit, faces a camera, and nothing hides it from it
    int agree = 0;    ///< of these: the scan has a point there, where the mesh is
    int through = 0;  ///< where the scan has a point well behind the mesh: light cannot get there
    int hidden = 0;   ///< where the scan has a point before the mesh: something else stands there
    double agreement() const { return expected > 0 ? static_cast<double>(agree) / expected : 0.0; }
    /// What poses are ordered by.
    double score() const { return agree - 2.0 * through - 0.5 * (expected - agree); }
};

/// A mesh laid into a table or a wall agrees with it, but its outline is nowhere to be seen.
struct OutlineEvidence {
    int looked_at = 0;  ///< places at the border of the mesh's picture with a scan's point inside
    int runs_on = 0;    ///< of these: the scan's surface goes on as a plane beyond the border
    bool is_seen() const { return 2 * runs_on <= looked_at; }
};

/// Every how manieth pixel is looked at so that about `count` of the projector's are.
int stride_for(const View& projector, int count);

/// Traces the mesh from the projector. "Where the mesh is" means within `within_mm` along the ray,
/// on a spot that `ignored` (one a projector pixel, empty: none) does not rule out.
PoseEvidence evidence_of(const Tracer& tracer,
                         const Mesh& mesh,
                         const Rigid3& scan_from_mesh,
                         const Scan& scan,
                         std::span<const Sight> sights,
                         const Image8& ignored,
                         double within_mm,
                         int stride);

/// Looks from `projector`, whose world is the mesh, over its picture's border.
OutlineEvidence outline_of(const Tracer& tracer,
                           const View& projector,
                           const Scan& scan,
                           int stride);

}  // namespace livery
