// The shading source on the processor for models that are not taken apart for eight fragments at a
// time: any model of model_table.h, one fragment after another.
#pragma once

#include "appearance/model_table.h"
#include "radiance/lanes/lane_shading.h"
#include "radiance/shading.h"

namespace livery {

/// Shades the blocks of `job`, whose own uniforms are not read. Without job.sky or job.mirror no
/// light comes from there.
void shade_any_model(const LaneJob& job, const ModelInfo& model, const AnyModelUniforms& uniforms);

}  // namespace livery
