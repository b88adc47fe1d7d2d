// What the correction and its modes make of colours, on a simulated bench.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "gl/context.h"
#include "jobs/comparison.h"
#include "ledger/accuracy/chain.h"
#include "scene/effects.h"
#include "twin/description.h"

namespace livery {

/// CIEDE2000 of a comparison inside the mock-up, off edges, where pixels carry a correction; those
/// whose wanted colour some drive shows, or the others.
std::vector<float> interior_errors(const Comparison& comparison,
                                   const ComparisonMasks& masks,
                                   bool reachable);

/// Rows of one bench, not measured yet, in the order of measure_corrections().
std::vector<ChainRow> correction_rows(const std::string& bench_name);

/// Calibrates the bench's colours in each mode and with each number of photographs, told where
/// everything stands, and compares the spectral light of its mock-up with that of `looks` drawn in
/// `quality`, at each projector pixel. One design white, and the pixels that all calibrations
/// correct, serve all rows. Needs a current OpenGL context. Throws as calibrate_through_ports().
void measure_corrections(const BenchDescription& description,
                         const std::vector<std::string>& looks,
                         Quality quality,
                         std::vector<ChainRow>& rows,
                         const Progress& progress = {});

}  // namespace livery
