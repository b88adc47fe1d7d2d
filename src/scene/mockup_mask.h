// Which of a view's pixels the mock-up itself takes: a projector also lights what it stands on.
#pragma once

#include "core/image.h"
#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

/// 255 where the pixel's centre looks at the mesh, whichever part is in front; one channel.
Image8 mockup_mask(const Mesh& mesh, const View& view);

/// 255 where a picture with coverage in its fourth channel is covered by half or more.
Image8 coverage_mask(const ImageF& picture);

}  // namespace livery
