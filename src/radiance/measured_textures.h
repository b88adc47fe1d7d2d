// The grids of measured paints as textures, each uploaded once for as long as its paint lives.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "appearance/measured/measured_paint.h"
#include "gl/handles.h"

namespace livery {

/// Needs a current context from the first use to its end.
class MeasuredTextures {
  public:
    void bind(const std::shared_ptr<const MeasuredPaint>& paint, unsigned unit);

  private:
    std::vector<std::pair<std::weak_ptr<const MeasuredPaint>, Texture2D>> textures_;
};

/// A layer for each theta_d (shaders/bsdf/measured.glsl).
Texture2D texture_of(const MeasuredGrid& grid);

}  // namespace livery
