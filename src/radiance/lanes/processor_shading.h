// Shading and mixing of fragments on the processor: where OpenGL is software, several times quicker
// than OpenGL, because nothing is clamped, converted or drawn that no fragment needs.
#pragma once

#include <vector>

#include "core/image.h"
#include "radiance/lanes/lane_functions.h"
#include "radiance/packed_fragments.h"
#include "radiance/shading.h"

namespace livery {

class ProcessorShading {
  public:
    ProcessorShading(const SurfaceMap& map, const PackedLayout& layout);

    void shade(const Material& material,
               const ShadingInputs& inputs,
               double exposure_ev,
               std::size_t part,
               const LaneFunctions& functions = best_lanes());
    /// Adds one paint of an artwork over what the part was shaded with; `means` are its layers'.
    void shade(const ArtworkCoat& coat,
               const InputLayers& means,
               const ShadingInputs& inputs,
               double exposure_ev,
               std::size_t part,
               const LaneFunctions& functions = best_lanes());
    /// Into a picture of the map's size, R, G, B, coverage: only the pixels that the product covers
    /// are written.
    void resolve(ImageF* picture) const;

  private:
    void shade(const Material& material,
               const ShadingInputs& inputs,
               double exposure_ev,
               std::size_t part,
               const LaneFunctions& functions,
               LaneJob job);

    const PackedLayout& layout_;
    FragmentIndex index_;
    std::vector<float> shaded_;  ///< R, G, B, 1 of each place of the layout
};

}  // namespace livery
