// What is written over the stage's picture.
#pragma once

#include "studio/studio.h"

namespace livery {

/// While B is held everything else in the window is about A.
void draw_held_name(const Studio& studio, const StageFrame& stage);
/// Over the picture's upper edge, while the next click means something else than usual.
void draw_placing(const Studio& studio, const StageFrame& stage);

}  // namespace livery
