// The curve of a camera that gives no RAW: linear light from the numbers in its files.
#pragma once

#include <vector>

#include "core/bench_ports.h"
#include "core/progress.h"

namespace livery {

struct CameraResponse {
    /// For equally spaced file values from 0 to full scale, both as fractions of it; never falls.
    std::vector<double> linear_from_file;
    /// What a photograph says of a place's light against all the others, after the fit: root mean
    /// square, as a share of the light.
    double residual = 0.0;
};

/// From photographs of one unchanging scene at different exposures, 8-bit file values from 0 to
/// 255 as they are, all channels alike: one linear least-squares problem in logarithms, of the
/// curve at each level and the light of each place (Debevec and Malik 1997), here of blocks' means,
/// with a curve that is smooth over the logarithm of the value and exposures that may be 2% from
/// what they say. Throws Refused where the photographs differ by less than a factor of four, show
/// nothing, or do not follow their exposures.
CameraResponse fit_camera_response(const std::vector<Photograph>& photographs);

/// Shows white and photographs it at exposures from a sixteenth of the camera's own to four times
/// it. Throws what the ports throw.
std::vector<Photograph> photograph_exposures(const BenchPorts& bench,
                                             int width,
                                             int height,
                                             const Progress& progress = {});

}  // namespace livery
