// Pictures for artwork: tiles that go on without a seam, and a number in its disc.
#pragma once

#include "core/image.h"

namespace livery::assets {

/// Flowers and leaves on an off-white ground, sRGB; repeats.
Image8 blossoms(int size);

/// White where the disc is, black around it and where the number is cut out; to be used as cover.
Image8 roundel(int size);

/// Normals of a plain weave as carbon fibre has it, red to the right and green up; repeats.
Image8 weave(int size);

}  // namespace livery::assets
