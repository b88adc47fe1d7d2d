// What artwork does to fragments: how much of each it covers, and with what, and how pictures of
// normals tilt them. Solved on the processor once a pose, and again when artwork moves or its
// picture changes, never for another paint.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "radiance/lanes/input_layers.h"
#include "radiance/packed_fragments.h"
#include "radiance/surface_map.h"
#include "scene/artwork_coats.h"
#include "scene/artwork_cover.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

/// Sides of a pixel where its rays meet the surface's tangent plane, in mm. Where the surface turns
/// away from the view they grow no further than to thirty times a pixel that faces it.
struct Footprint {
    glm::dvec3 a{0.0}, b{0.0};
};
Footprint footprint_of(const View& view,
                       std::uint32_t pixel,
                       const glm::dvec3& position_mm,
                       const glm::dvec3& normal);
/// Of every fragment of a part.
std::vector<Footprint> footprints_of(const View& view, const SurfaceMap& map, std::size_t part);

/// A footprint in an artwork's plane, or along the mesh's texture coordinates.
struct FlatFootprint {
    glm::dvec2 at{0.0}, a{0.0}, b{0.0};
};
/// `plane` is plane_of() the artwork's place.
FlatFootprint flat_footprint(const Mesh& mesh,
                             const SurfaceMap& map,
                             std::size_t fragment,
                             const Footprint& footprint,
                             const PartArtwork& artwork,
                             const ArtworkPlane& plane);

/// The map with the scene's reliefs: mean normals tilted by the mean slope over the pixel, their
/// variance larger by the slopes'. `map` is without any.
SurfaceMap relieved(const SurfaceMap& map, const Scene& scene, const View& view);

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
    /// Grows when what lies over the part lies in another way than before.
    int version(std::size_t part) const { return versions_[part]; }

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
    std::vector<int> versions_;                       ///< of each part
    int layers_made_ = 0;
};

}  // namespace livery
