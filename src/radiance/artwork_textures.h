// Artwork as the preview's programs read it (shaders/artwork/inputs_raster.glsl).
#pragma once

#include <memory>
#include <vector>

#include "gl/handles.h"
#include "gl/program.h"
#include "scene/scene.h"

namespace livery {

/// Pictures of artwork in OpenGL, of at most 2048 texels a side.
class ArtworkTextures {
  public:
    /// Uniforms and the picture of an artwork, but not its paint; the picture is made when it is
    /// first asked for.
    void set(Program& program, const PartArtwork& artwork);
    /// The same of a part's relief.
    void set_relief(Program& program, const PartArtwork& relief);
    /// Frees the pictures that a scene does not have.
    void keep(const Scene& scene);

  private:
    struct Picture {
        std::shared_ptr<const ArtworkPicture> of;
        PictureUse use = PictureUse::cover;
        bool repeat = false;
        std::vector<float> pigment_response;
        Texture2D layers;
    };
    const Texture2D& layers_of(const PartArtwork& artwork);

    std::vector<Picture> pictures_;
};

}  // namespace livery
