// A surface map whose normals a relief tilts: light is solved on it as on any other.
#pragma once

#include "radiance/surface_map.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

/// The map with the scene's reliefs: mean normals tilted by the mean slope over the pixel, their
/// variance larger by the slopes'. `map` is without any.
SurfaceMap relieved(const SurfaceMap& map, const Scene& scene, const View& view);

}  // namespace livery
