// One picture that becomes another little by little, so that what only got better does not jump.
#pragma once

#include <glm/vec2.hpp>

#include "gl/draw.h"
#include "gl/handles.h"
#include "gl/program.h"

namespace livery {

/// One per context, with it current from the first use to the end.
class PictureFade {
  public:
    /// An RGBA8 texture with `share` (0 to 1) of the second picture and the rest of the first, both
    /// of that size; good until the next call.
    unsigned between(unsigned from, unsigned to, float share, glm::ivec2 size_px);

  private:
    Program program_;
    ScreenPass pass_;
    Texture2D mixed_;
    Framebuffer target_;
};

}  // namespace livery
