// `livery bench --suite geometry`: what a wrong pose, lens, mesh or size costs the audience.
// docs/geometry-errors.md holds its table.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "gl/context.h"
#include "jobs/comparison.h"
#include "ledger/level.h"

namespace livery {

/// One error of what the program believes of the room, by itself.
struct GeometryErrorRow {
    std::string effect;  ///< "pose: turned"
    std::string level;   ///< "0.1 degrees"
    /// How far from its place on the mock-up the picture lies, in projector pixels.
    double off_median_px = 0.0, off_p95_px = 0.0;
    ErrorStatistics seen;       ///< CIEDE2000 in the eye's picture, further than 2 px from edges
    ErrorStatistics edge_band;  ///< within 2 px
    double ms = 0.0;            ///< that measuring it took
};

struct GeometryErrorLedger {
    std::string renderer, bench, look;
    std::vector<GeometryErrorRow> rows;  ///< "none" first
};

/// Calibrates the default bench's colours once, from its photographs, and then draws a look for
/// views and meshes that are off by known amounts. `quick`: the largest and smallest of each.
GeometryErrorLedger measure_geometry_errors(GlDevice device,
                                            bool quick,
                                            std::uint64_t seed,
                                            const Progress& progress = {});

std::vector<LedgerEffect> effects_of(const GeometryErrorLedger& result);
std::string markdown_of(const GeometryErrorLedger& result);

}  // namespace livery
