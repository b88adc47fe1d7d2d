// Structured light as a scan: where in space each projector pixel's light falls.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibration/correspondence/gray_code.h"
#include "core/image.h"
#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

/// One position of the camera: its lens and pose, and where it sees each projector pixel.
struct Sight {
    View camera;
    ProjectorToCamera map;
};

struct ScanOptions {
    /// A ray of the camera that passes the projector's farther away than this, and farther than
    /// four times what the others do, belongs to another spot.
    double largest_gap_px = 3.0;
    /// Median over which camera and projector no longer stand where the calibration says, in
    /// widths of the camera's picture. A focal length that is 1% off makes a third of it.
    double refused_gap = 0.01;
    /// Median in camera pixels, and in deviations of the places, from which it is said.
    double told_gap_px = 0.5, told_gap_sigmas = 2.0;
    double least_angle_rad = 0.02;  ///< between the two rays
    /// Steepest surface against the projector's ray that is still one surface.
    double steepest_rad = 1.40;
    int least_patch_px = 40;  ///< smaller pieces, in projector pixels, are left out
};

/// A point a projector pixel, in the frame of the views' world. NaN where nothing is known.
struct Scan {
    View projector;
    ImageF points_mm;  ///< 3 channels
    ImageF normals;    ///< 3 channels, unit, toward the projector
    ImageF sigma_mm;   ///< 1 channel: standard deviation along the projector's ray
    double gap_px =
        0.0;  ///< median distance at which the two rays pass, camera pixels; of the worst sight
    double known_fraction = 0.0;  ///< of the projector's pixels
    std::vector<std::string> warnings;
};

/// Triangulates every projector pixel: the point of its ray that is nearest to the camera's. A
/// point's deviation along the ray is sigma_px of its map * (camera distance / focal) / sin(angle
/// of the rays). Several sights are averaged with their deviations as weights; where they differ by
/// more than 1% of the distance, nothing is known. Edges, rays that pass each other, spikes and
/// small patches are left out. Throws std::invalid_argument (no sight, a map of another size),
/// Refused: mirrored photographs, rays that do not meet, hardly any point.
Scan scan_of(const View& projector, std::span<const Sight> sights, const ScanOptions& options = {});

/// Whether light that falls on two neighbouring pixels, at such distances along their rays, falls
/// on one surface.
bool on_one_surface(double range_a_mm,
                    double range_b_mm,
                    double pixel_angle_rad,
                    double sigma_mm,
                    double steepest_rad);

/// The scan as a surface with one part, "scan", in the same frame: neighbouring points joined, cut
/// where the depth jumps; what was not seen stays open. Every `step`-th pixel counts. Throws
/// Refused where nothing hangs together.
Mesh mesh_of_scan(const Scan& scan, int step = 1, double steepest_rad = 1.40);

/// Median distance of neighbouring points, millimetres.
double point_spacing(const Scan& scan);

}  // namespace livery
