// How much of a footprint an artwork covers, and with what of its picture; relief, a picture of
// normals that tilts the surface of a part.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/image.h"
#include "scene/artwork.h"
#include "scene/artwork_coats.h"

namespace livery {

/// shaders/artwork/cover.glsl in double and in float: the shape's share of a parallelogram of sides
/// `a` and `b` in mm around `at`, both in the artwork's plane. Not of pictures.
double shape_cover(const Artwork& artwork,
                   const glm::dvec2& at,
                   const glm::dvec2& a,
                   const glm::dvec2& b);
float shape_cover(const Artwork& artwork,
                  const glm::vec2& at,
                  const glm::vec2& a,
                  const glm::vec2& b);
/// What a surface that is turned so much toward the projection wears of it; 1 of one that goes
/// through.
double facing_cover(const ArtworkPlace& place, double cosine);

/// A picture in halved sizes, to take means over footprints of any size and proportion: an elliptic
/// Gaussian (Heckbert 1989) of the variance that a parallelogram has.
class FilteredPicture {
  public:
    /// Any number of channels, `repeat`ed or nothing (0 in each) around it. Repeated pictures whose
    /// sides are no powers of two are resampled to the next.
    FilteredPicture(const ImageF& picture, bool repeat);

    /// Mean around uv (0 to 1, rows down) over a footprint of sides `a` and `b` in the same units;
    /// `channels` values at `out`.
    void mean(const glm::dvec2& uv, const glm::dvec2& a, const glm::dvec2& b, float* out) const;
    int channels() const { return levels_.front().channels; }
    /// The finest of its sizes with so many texels a side at most.
    const ImageF& level_within(int side) const;
    bool repeats() const { return repeat_; }

  private:
    const float* texel(const ImageF& level, int x, int y) const;

    bool repeat_;
    std::vector<ImageF> levels_;
    glm::dvec2 size_{0.0};  ///< of the finest, in texels
};

/// Along which a relief's slopes count, on the surface: unit, square to its normal and to each
/// other.
struct ReliefFrame {
    glm::dvec3 right{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0};
};
/// `tangent` as in Mesh: of a relief along the mesh's texture coordinates.
ReliefFrame relief_frame(const PartArtwork& relief,
                         const glm::dvec3& normal,
                         const glm::dvec4& tangent);

/// The tilt of normals in a footprint: mean slopes (a normal is x / z, y / z of its picture's) and
/// their mean square around that mean. Linear in what is averaged, so it holds at every distance
/// (Olano and Baker, LEAN mapping, 2010).
struct ReliefTilt {
    glm::dvec2 slope{0.0};
    double variance = 0.0;  ///< both directions together
};
/// Of a mean of picture_layers(): slopes, their squares together, cover.
ReliefTilt tilt_of(const PartArtwork& relief, const glm::dvec4& mean);
/// At a single point of the picture.
ReliefTilt tilt_at(const PartArtwork& relief, const ArtworkPoint& point);

/// A unit normal with those slopes on it.
glm::dvec3 tilted(const glm::dvec3& normal, const ReliefFrame& frame, const glm::dvec2& slope);

}  // namespace livery
