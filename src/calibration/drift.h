// Whether a bench is as it was when it was calibrated, from two photographs.
#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/bench_ports.h"
#include "core/grade.h"
#include "core/image.h"
#include "core/progress.h"

namespace livery {

/// What white and black on the mock-up looked like at the end of a calibration.
struct DriftReference {
    ImageF white, black;      ///< camera pixels, mean of the channels, linear per second
    glm::dvec3 light{0.0};    ///< white - black, mean of the picture, each channel
    double exposure_s = 0.0;  ///< of white
    int late = 0;             ///< photographs until a picture is there
};
DriftReference drift_reference(const Photograph& white, const Photograph& black, int late);

struct Drift {
    /// How far what the camera sees has moved, camera pixels, over the blocks that can be followed.
    double shift_median_px = 0.0, shift_p95_px = 0.0;
    int blocks = 0;               ///< those
    int lost = 0;                 ///< blocks with detail that is not found again
    glm::dvec3 light_ratio{1.0};  ///< of the projector's light, now over then, each channel
    double room_light = 0.0;      ///< change of black over white, median of the lit pixels
};

/// Blocks of 32 pixels on what was lit are found again by Lucas and Kanade's least squares ("An
/// iterative image registration technique", 1981) from coarse to fine, to about 60 pixels. Throws
/// FileError when the photographs are of another size, Refused when nothing was lit or nothing on
/// it can be followed.
Drift drift_between(const DriftReference& then, const DriftReference& now);

/// The same where both were lit: one of them may have lit what stands around too.
Drift drift_where_both_lit(DriftReference then, const DriftReference& now);

/// Shows black, and white on the mock-up (`mockup`: one channel of the projector's size, non-zero:
/// lit), and photographs each at the exposure of then. Throws as the ports.
DriftReference photograph_ends(const BenchPorts& ports,
                               const DriftReference& then,
                               const Image8& mockup,
                               const Progress& progress = {});

/// The same, compared with then. Throws as drift_between() and the ports.
Drift look_for_drift(const BenchPorts& ports,
                     const DriftReference& then,
                     const Image8& mockup,
                     const Progress& progress = {});

/// What it is worth, with the way out.
std::vector<GradedFigure> grade_figures(const Drift& drift);

}  // namespace livery
