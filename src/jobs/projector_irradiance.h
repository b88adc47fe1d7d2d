// How strongly a projector's light falls on each spot of a product, by the pose alone.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

/// cos(theta) / distance^2 (1/mm^2) of the surface that each projector pixel lights, its mean over
/// the lit part of the pixel; one channel, 0 where the mesh covers less than half of the pixel.
ImageF projector_irradiance(const Mesh& mesh, const View& projector, const Progress& progress = {});

}  // namespace livery
