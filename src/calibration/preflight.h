// Is the bench fit for a long capture? A score of photographs that find out before, each figure
// Good, Usable or Bad with what helps.
#pragma once

#include <functional>
#include <vector>

#include "core/bench_ports.h"
#include "core/grade.h"
#include "core/image.h"
#include "core/progress.h"

namespace livery {

struct PreflightOptions {
    int width = 0, height = 0;  ///< projector pixels
    /// Projector pixels that the mock-up takes (non-zero), where its pose is known; else empty.
    Image8 mockup;
};

struct Preflight {
    std::vector<GradedFigure> figures;
    double exposure_s = 0.0;  ///< found; 0: none fits
    int latency_photographs = 0;
};

/// Shows, photographs and measures, in this order: the projector's light in the camera's picture
/// and how large it is, how late a picture arrives, the exposure, clipping, whether half the
/// exposure gives half the light, native pixels (a projector or a cable that scales turns a fine
/// checkerboard's light into another amount, since drives are mixed and not light), focus, white
/// against the sum of its channels, dynamic modes, room light, flicker, and the lamp's drift from
/// the first white to the last. What makes the rest pointless (no light, no exposure) ends the list
/// with a bad figure. `on_figure` is called with each as it comes. Throws std::invalid_argument for
/// photographs that were taken before
/// (`turn_to`), and what the ports throw but Refused.
Preflight preflight(const BenchPorts& bench,
                    const PreflightOptions& options,
                    const Progress& progress = {},
                    const std::function<void(const GradedFigure&)>& on_figure = {});

}  // namespace livery
