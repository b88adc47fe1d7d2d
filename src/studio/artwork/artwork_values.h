// Artwork as people think of it: in plain words, from which side, how much turned, and how a new
// one begins. Pure functions.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "scene/artwork.h"
#include "studio/light/light_values.h"

namespace livery {

struct Words {
    std::string label;
    std::string meaning;  ///< a sentence or two; may be empty
};
Words words_of(ArtworkShape shape);
/// One that has no words here goes by its name in files.
Words words_of(PictureUse use);

/// What is read of an artwork by its shape, beside what all have.
struct ShapeFields {
    bool size = false, share = false, softness = false, picture = false;
    const char* size_meaning = "";
};
ShapeFields fields_of(ArtworkShape shape);

/// Where an artwork comes from, as the light panel counts: for somebody at +z, who sees the front,
/// the right is +x.
enum class Side { left, right, front, back, above };
inline constexpr std::array kSides{Side::left, Side::right, Side::front, Side::back, Side::above};
glm::dvec3 direction_from(Side side);
/// None when it comes from between them.
std::optional<Side> side_of(const ArtworkPlace& place);
/// From another side, at the same centre and as much turned.
ArtworkPlace from_side(const ArtworkPlace& place, Side side);

/// A side as people call it.
struct NamedSide {
    Side side = Side::front;
    const char *label = "", *name = "", *meaning = "";
};
/// Left, right, front, back and above of a product whose front points there ("+x", "-x", "+z",
/// "-z"): its own left, as one has it who sits in a car. Without a front: as seen from +z.
std::array<NamedSide, kSides.size()> named_sides(const std::string& front);

/// Of the way back along the projection: where one stands who sees the artwork as it is.
Angles angles_of(const ArtworkPlace& place);
/// From there, turned with the way: steadily, while an angle is dragged.
ArtworkPlace from_angles(const ArtworkPlace& place, const Angles& angles);

/// Counter-clockwise from where place_on() would leave it, for somebody who looks along the
/// projection; degrees in (-180, 180].
double turn_deg_of(const ArtworkPlace& place);
ArtworkPlace with_turn(const ArtworkPlace& place, double turn_deg);

/// Of one part, or "*": of all.
Bounds bounds_of_part(const Mesh& mesh, const std::string& part);

/// Onto the middle of these bounds, from the side on which somebody at `eye_mm` sees most of them.
/// `aspect` is a picture's height over its width. Named by its shape, with the first free number
/// behind it. Has neither paint nor picture.
Artwork new_artwork(ArtworkShape shape,
                    const std::string& part,
                    const Bounds& bounds,
                    const glm::dvec3& eye_mm,
                    const std::vector<Artwork>& others,
                    double aspect = 1.0);

/// A paint of the library that is told from what has this L*.
std::string paint_over(double lightness);

/// A copy under a free name, right over the original. Throws std::invalid_argument for a place that
/// is not there, as does moved().
std::vector<Artwork> with_copy(const std::vector<Artwork>& list, std::size_t at);
std::vector<Artwork> moved(std::vector<Artwork> list, std::size_t at, std::size_t to);

/// The same with another shape; what the new one does not read is as in a new artwork.
Artwork with_shape(const Artwork& artwork, ArtworkShape shape);

/// The same picture with another use; what the new one does not read is as in a new artwork.
Artwork with_use(const Artwork& artwork, PictureUse use);

/// Put onto a point of the surface, as much turned as before; on its part, unless it is on all.
Artwork put_on(const Artwork& artwork,
               const std::string& part,
               const glm::dvec3& position_mm,
               const glm::dvec3& normal);

/// Its name, or what it is.
std::string shown_name(const Artwork& artwork);

}  // namespace livery
