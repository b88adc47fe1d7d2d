// What each pass of a frame has to do: what its cost is linear in.
#pragma once

#include <vector>

#include "scene/frame_plan.h"
#include "scene/scene.h"

namespace livery {

/// Of a picture, drawn or only estimated.
struct FrameCounts {
    double covered_pixels = 0.0;
    int samples_per_pixel = 1;                 ///< of the surface map
    std::vector<double> fragments_of_part;     ///< as the product's parts
    std::vector<double> fragments_of_artwork;  ///< that it covers, as the scene's; empty: not known
};

/// Fills work_items of all passes but the correction's: rays, nodes, fragments or pixels.
void count_work(const Scene& scene, const FrameCounts& counts, FramePlan& plan);

}  // namespace livery
