// What is written over the stage's picture.
#pragma once

#include "studio/studio.h"

namespace livery {

/// A rectangle of the window, in its pixels.
struct StageFrame {
    float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;
};

/// While B is held everything else in the window is about A.
void draw_held_name(const Studio& studio, const StageFrame& stage);
/// Over the picture's upper edge, while the next click means something else than usual.
void draw_placing(const Studio& studio, const StageFrame& stage);

}  // namespace livery
