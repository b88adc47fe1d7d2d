// The paper's Fig. 10: a painted sphere beside the grey one that carries its picture.
#pragma once

#include "jobs/demo.h"
#include "jobs/demo_stages.h"

namespace livery {

/// For each spectrally painted sample: its spectral colour at the eye under the looks' lights is
/// the truth, the render of its RGB material is what is projected.
void judge_painted_spheres(DemoResult& result,
                           const CalibratedBench& calibrated,
                           const DemoOptions& options,
                           StageTimes& times,
                           const Progress& progress);

}  // namespace livery
