// The picture of an artwork, and what of it shading takes means of.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>

#include "core/image.h"
#include "mesh/part_picture.h"
#include "scene/artwork.h"

namespace livery {

/// Reads a picture of at most 8192 pixels a side, or takes the one that was read before and still
/// is somebody's, while the file has not changed. Throws FileError (as of read_image, values that
/// are not finite, a number of channels other than 1 to 4).
std::shared_ptr<const ArtworkPicture> load_artwork_picture(const std::filesystem::path& file);

/// Slope parameters of a map of roughness come in steps of at most this ratio: in between, what
/// the two next ones reflect is mixed.
inline constexpr double kRoughnessStep = 1.5;
inline constexpr std::size_t kMostRoughnessSteps = 12;

/// What PictureUse::cover reads of a texel.
float picture_cover(const ArtworkPicture& picture, const float* rgba);

/// A texel's normal as a slope to the right and up; one that lies almost in the surface counts as
/// 84 degrees.
glm::dvec2 relief_slope(const float* rgba);

/// What a value of the map scales them by: its square, no less than a four hundredth.
double slope_scale(float value);

/// The scales of the slope parameter that a map of roughness needs, rising; one when it is even.
std::vector<double> roughness_steps(const ArtworkPicture& picture);

/// What means are taken of, four channels a layer, alpha last and the others multiplied by it:
/// `cover`: one layer of alpha; `colours`: one of what pigments of these colours return, each
/// channel by `pigment_response` (a table from 0 to 1, of what a white pigment returns) in the
/// working space; `roughness`: one of each step's share; `relief`: slopes, their squares
/// together and alpha.
ImageF picture_layers(const ArtworkPicture& picture,
                      PictureUse use,
                      const std::vector<float>& pigment_response);

}  // namespace livery
