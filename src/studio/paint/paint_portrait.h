// How a paint looks, beside its parameters: sphere, lobe, colour at five angles, flop and gloss,
// held against another paint or a measurement.
#pragma once

#include "studio/studio.h"

namespace livery {

/// `material` is what is being edited. Works the figures out in the background; what was there
/// before stays until then.
void draw_paint_portrait(Studio& studio, const Material& material);

}  // namespace livery
