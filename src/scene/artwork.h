// What lies over a part's paint: a second tone, stripes, a pattern, a decal, a printed picture, a
// map of roughness. Each covers some of the part with a paint of its own.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace livery {

enum class ArtworkShape {
    half,     ///< everything above the line through the place's centre: two tones
    stripes,  ///< across the place's up
    checks,
    dots,
    picture
};

/// What a picture says.
enum class PictureUse {
    cover,    ///< its alpha, or without alpha its lightness, says how much is covered
    colours,  ///< the same of its alpha; printed in its colours: opaque ink under the paint's coat
    roughness,  ///< its values squared scale the paint's slope parameters, as glTF has it
    relief,     ///< normals of the surface: red to the right, green up, blue out, as glTF has them
    tint        ///< as `colours`, but of the paint's own pigment or metal: its flakes stay
};

/// How an artwork's plane, s to the right and t up in mm, lies on the product: projected along a
/// direction, or along the mesh's own texture coordinates.
struct ArtworkPlace {
    glm::dvec3 centre_mm{0.0};
    glm::dvec3 direction{
        0.0, 0.0, -1.0};           ///< in which it is projected; surfaces that face it wear it
    glm::dvec3 up{0.0, 1.0, 0.0};  ///< of it what is square to `direction`
    bool through = true;           ///< surfaces that face away wear it as well
    bool by_uv = false;            ///< pictures only: over u and v from 0 to 1

    bool operator==(const ArtworkPlace&) const = default;
};

struct Artwork {
    std::string name;
    std::string part = "*";  ///< "*": all of them
    std::string paint;       ///< by name or file; empty: the part's own
    ArtworkShape shape = ArtworkShape::stripes;
    double size_mm =
        20.0;  ///< from stripe to stripe, of a check, from dot to dot, of a picture's width
    double share = 0.5;        ///< of stripes and dots: how much of their line is covered
    double softness_mm = 0.0;  ///< of a half: how wide the change is
    std::string picture;       ///< file
    PictureUse use = PictureUse::cover;
    bool repeat = false;  ///< the picture again and again
    double depth = 1.0;   ///< of a relief: its slopes are so much steeper
    ArtworkPlace place;

    bool operator==(const Artwork&) const = default;
};

/// As files and the command line name them, in the order of the enumerations.
inline constexpr std::array kArtworkShapes{"half", "stripes", "checks", "dots", "picture"};
inline constexpr std::array kPictureUses{"cover", "colours", "roughness", "relief", "tint"};

/// A relief tilts what lies beneath it on its part and has no paint; a part has one at most.
bool is_relief(const Artwork& artwork);

/// Whether colours are read from its picture.
bool reads_colours(const Artwork& artwork);

/// Throws std::invalid_argument that names the field and the value: a size out of range, a
/// direction without a length, up along it, a picture without a file, too many.
void check_artwork(const Artwork& artwork);
inline constexpr std::size_t kMostArtworks = 32;  ///< of a look

/// The plane's axes and centre in the world: s = dot(s_axis, x - centre), mm.
struct ArtworkPlane {
    glm::dvec3 centre_mm{0.0}, s_axis{1.0, 0.0, 0.0}, t_axis{0.0, 1.0, 0.0};
    glm::dvec3 toward{0.0, 0.0, 1.0};  ///< unit, against the direction of projection

    glm::dvec2 operator*(const glm::dvec3& x_mm) const;
};
ArtworkPlane plane_of(const ArtworkPlace& place);

/// The place of an artwork that is put onto a point of the product: it faces the surface there, its
/// up is as close to the world's as can be.
ArtworkPlace place_on(const glm::dvec3& position_mm, const glm::dvec3& normal, bool through);

/// Why an artwork of a session, which names files by their whole paths, cannot be shown now.
std::optional<std::string> picture_problem(const Artwork& artwork);

/// The file that an artwork's picture means: as named, in the folder `beside`, or shipped. Throws
/// FileError.
std::filesystem::path find_artwork_picture(const std::string& name,
                                           const std::filesystem::path& beside);

}  // namespace livery
