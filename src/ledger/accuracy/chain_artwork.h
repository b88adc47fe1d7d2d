// How an artwork's share of a pixel is found, against what many samples say.
#pragma once

#include <memory>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "radiance/renderer.h"
#include "scene/scene.h"

namespace livery {

/// One artwork over its part's paint, both plain colours (their `diffuse`) in even light: R, G, B
/// in the working space, and how much of the pixel the part covers.
struct ArtworkPictures {
    ImageF by_footprint;  ///< as frames have it: means over the pixel's footprint (ArtworkInputs)
    ImageF by_sample;     ///< at each fragment's middle alone
    ImageF by_many;       ///< mean of rays all over the pixel
    double footprint_ms = 0.0, sample_ms = 0.0;  ///< all fragments of the part
};

/// Of each of the scene's artworks by itself; `rays` a pixel, a power of two. Throws
/// std::invalid_argument for one that no fragment wears or whose picture has colours of its own.
std::vector<ArtworkPictures> artwork_pictures(const Scene& scene,
                                              const FrameGeometry& geometry,
                                              int rays,
                                              const Progress& progress = {});

/// How wide a pixel is across an artwork's stripes: the median over its part's fragments, mm.
double pixel_across_mm(const FrameGeometry& geometry, std::size_t part, const ArtworkPlace& place);

}  // namespace livery
