// How much of each fragment an artwork covers, and with what: solved on the CPU once a pose, and
// again when the artwork moves or its picture changes, never for another paint.
#pragma once

#include <memory>
#include <vector>

#include "radiance/artwork_footprint.h"
#include "radiance/lanes/input_layers.h"
#include "radiance/packed_fragments.h"
#include "radiance/surface_map.h"
#include "scene/artwork_cover.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

class ArtworkInputs {
  public:
    ArtworkInputs(const Mesh& mesh,
                  const View& view,
                  const SurfaceMap& map,
                  const PackedLayout& layout,
                  ShadingDevice device);

    /// Solves what changed, without OpenGL; what the scene does not have is freed. True when
    /// something was solved.
    bool solve(const Scene& scene);
    bool stands(const Scene& scene) const;
    /// Hands what was solved to the device that shades.
    void upload();

    /// Of the scene's k-th artwork: its layers' means (R, G, B, A) at each fragment of its part.
    const InputLayers& layers(std::size_t artwork) const { return solved_[artwork]->layers; }
    /// How many fragments it covers any of.
    std::size_t covered(std::size_t artwork) const { return solved_[artwork]->covered; }
    /// The parts over which what was solved last lies in another way than before.
    std::vector<bool> take_changed_parts();

    int layers_made() const { return layers_made_; }

  private:
    struct Picture {
        std::shared_ptr<const ArtworkPicture> of;
        PictureUse use = PictureUse::cover;
        bool repeat = false;
        std::vector<float> pigment_response;
        std::shared_ptr<const FilteredPicture> filtered;
    };
    struct Solved {
        PartArtwork of;
        std::shared_ptr<const FilteredPicture> filtered;
        std::vector<std::vector<float>> texels;  ///< a layer each, not yet uploaded
        InputLayers layers;
        std::size_t covered = 0;
    };
    std::shared_ptr<const FilteredPicture> filtered_of(const PartArtwork& artwork);
    void solve_one(Solved& solved);

    const Mesh& mesh_;
    const View& view_;
    const SurfaceMap& map_;
    const PackedLayout& layout_;
    const ShadingDevice device_;
    std::vector<std::shared_ptr<Solved>> solved_;  ///< one for each of the scene's
    std::vector<Picture> pictures_;
    std::vector<std::vector<Footprint>> footprints_;  ///< of parts that wore artwork
    std::vector<bool> changed_parts_;
    int layers_made_ = 0;
};

}  // namespace livery
