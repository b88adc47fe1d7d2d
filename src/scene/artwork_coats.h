// An artwork on a part, as paints whose weighted sum is what is seen: reflected light is linear in
// what reflects it, so means of weights over a footprint are means of light, whatever the paints.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <glm/vec4.hpp>

#include "appearance/material.h"
#include "scene/artwork.h"
#include "scene/artwork_picture.h"

namespace livery {

/// One artwork on one part of a product.
struct PartArtwork {
    std::size_t part = 0;
    Artwork artwork;
    Material material;  ///< what it is painted with; of a print: white ink in that paint's gloss
    std::shared_ptr<const ArtworkPicture> picture;
    /// For a picture's colours: what pigments of reflectance 0 to 1 return, of what a white one
    /// does. The coat's inner reflections darken middle tones: taken before the mean, as they are.
    std::vector<float> pigment_response;
};

/// Both cover the same in the same way, whatever they are called and painted with.
bool covers_alike(const PartArtwork& a, const PartArtwork& b);

/// Both are seen the same.
bool looks_alike(const PartArtwork& a, const PartArtwork& b);

/// Adds what the paint says. Throws std::invalid_argument: a paint that has no pigment or no gloss
/// for what the picture says.
PartArtwork make_part_artwork(std::size_t part,
                              const Artwork& artwork,
                              const Material& material,
                              std::shared_ptr<const ArtworkPicture> picture);

/// One paint of an artwork. Of a layer's mean (R, G, B, A) it is seen by
/// of_colour * (R, G, B) + of_alpha * A, and hides of_cover * A of what lies beneath.
struct ArtworkCoat {
    Material material;
    std::size_t layer = 0;
    float of_colour = 1.0f, of_alpha = 0.0f, of_cover = 1.0f;
};
std::vector<ArtworkCoat> coats_of(const PartArtwork& artwork);

/// From the artwork's plane, or from the mesh's texture coordinates, to its picture's: 0 to 1, rows
/// down.
struct PictureFrame {
    glm::dvec2 scale{1.0}, offset{0.0};
    glm::dvec2 uv(const glm::dvec2& at) const { return scale * at + offset; }
    glm::dvec2 turned(const glm::dvec2& side) const { return scale * side; }
};
PictureFrame picture_frame(const PartArtwork& artwork);

/// At a single point of the surface, not filtered: how much is covered, and with what.
struct ArtworkPoint {
    double cover = 0.0;
    glm::vec4 rgba{1.0f};  ///< of the picture, as it holds them
};
ArtworkPoint artwork_at(const PartArtwork& artwork,
                        const glm::dvec3& position_mm,
                        const glm::dvec3& normal,
                        const glm::dvec2& uv);
/// Its paint there.
Material material_at(const PartArtwork& artwork, const glm::vec4& rgba);

}  // namespace livery
