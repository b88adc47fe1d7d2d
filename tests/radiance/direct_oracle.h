// Direct light by brute force in double precision: what a frame should be.
#pragma once

#include "core/image.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

struct OracleOptions {
    int side = 16;        ///< side^2 rays a pixel
    int sky_samples = 4;  ///< of the environment for each ray
};

/// R, G, B, coverage; shares only the reflectance source with the renderer. Each ray through a
/// pixel takes its own stratified point of each light's disc and its own shadow ray.
ImageF direct_light(const Scene& scene, const View& view, const OracleOptions& options = {});
/// The same from a file: support/kept_truth.h. Of scenes without artwork.
ImageF kept_direct_light(const Scene& scene, const View& view, const OracleOptions& options);

}  // namespace livery
