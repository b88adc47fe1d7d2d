#include "studio/artwork/artwork_values.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/angles.h"
#include "core/error.h"
#include "session/naming.h"

namespace livery {

namespace {

/// Of its greater extent along the ground: what is lower than this is looked at from above.
constexpr double kFlat = 0.2;

/// Right, up and toward whoever stands at these angles, square to one another.
glm::dmat3 frame_at(const Angles& angles) {
    const double azimuth = angles.azimuth_deg / kDegreesPerRadian;
    const double elevation = angles.elevation_deg / kDegreesPerRadian;
    const glm::dvec3 toward = direction_of(angles);
    const glm::dvec3 up{-std::sin(elevation) * std::sin(azimuth),
                        std::cos(elevation),
                        std::sin(elevation) * std::cos(azimuth)};
    return {glm::cross(up, toward), up, toward};
}

/// 17.3 -> 17, 0.123 -> 0.12.
double two_digits(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return std::round(value / unit) * unit;
}

/// Width and height of the bounds as they are seen from a side.
glm::dvec2 face_of(const Bounds& bounds, Side side) {
    const glm::dvec3 size = bounds.high - bounds.low;
    switch (side) {
        case Side::left:
        case Side::right:
            return {size.z, size.y};
        case Side::front:
        case Side::back:
            return {size.x, size.y};
        case Side::above:
            return {size.x, size.z};
    }
    return {size.x, size.y};
}

Side side_seen_most(const Bounds& bounds, const glm::dvec3& eye_mm, bool flat_counts) {
    const glm::dvec3 toward_eye = eye_mm - 0.5 * (bounds.low + bounds.high);
    const glm::dvec3 size = bounds.high - bounds.low;
    const bool flat = flat_counts && size.y < kFlat * std::max(size.x, size.z);
    Side best = Side::front;
    double most = -1.0;
    for (const Side side : kSides) {
        if (side == Side::above && !flat) continue;
        const glm::dvec2 face = face_of(bounds, side);
        const double seen = face.x * face.y * glm::dot(-direction_from(side), toward_eye);
        if (seen > most) {
            most = seen;
            best = side;
        }
    }
    return best;
}

double first_size_mm(ArtworkShape shape, const glm::dvec2& face_mm, double aspect) {
    const double longest = std::max(face_mm.x, face_mm.y),
                 shortest = std::min(face_mm.x, face_mm.y);
    double size = longest / 8.0;
    if (shape == ArtworkShape::checks) size = longest / 16.0;
    if (shape == ArtworkShape::dots) size = longest / 16.0;
    if (shape == ArtworkShape::picture) {
        size = std::min(0.5 * face_mm.x, 0.8 * face_mm.y / std::max(aspect, 1e-3));
    }
    if (!(shortest > 0.0) && shape == ArtworkShape::picture) size = 0.5 * longest;
    return two_digits(std::clamp(size, 0.1, 1e4));
}

std::string name_for(const std::string& wanted, const std::vector<Artwork>& others) {
    return free_name(wanted, [&](const std::string& name) {
        return std::any_of(
            others.begin(), others.end(), [&](const Artwork& other) { return other.name == name; });
    });
}

void check_place(const std::vector<Artwork>& list, std::size_t at) {
    check_argument(at < list.size(),
                   fmt::format("place {} in a list of {} artworks", at, list.size()));
}

}  // namespace

Words words_of(ArtworkShape shape) {
    switch (shape) {
        case ArtworkShape::half:
            return {"Two tones",
                    "Everything above a line through its centre has the second paint."};
        case ArtworkShape::stripes:
            return {"Stripes", "Evenly spaced, along its up."};
        case ArtworkShape::checks:
            return {"Checks", "Squares, every other one painted."};
        case ArtworkShape::dots:
            return {"Dots", "Round, in rows and columns."};
        case ArtworkShape::picture:
            return {"Picture", "A file: a decal, a print, a stencil, or a map for the surface."};
    }
    return {};
}

Words words_of(PictureUse use) {
    struct Known {
        std::string_view name;
        Words words;
    };
    static const std::array known{
        Known{"cover",
              {"Stencil",
               "The picture's alpha, or its lightness if it has none, says how much of the paint "
               "there is."}},
        Known{
            "colours",
            {"Its own colours",
             "Printed in the picture's colours: opaque ink under the paint's clear coat, as glossy "
             "as the paint. Its alpha cuts it out."}},
        Known{"tint",
              {"Tint of the paint",
               "The paint itself takes the picture's colours: flakes and metal stay and shine "
               "through, so that colours come out as theirs mixed with the paint's."}},
        Known{"roughness",
              {"Map of roughness",
               "Only the gloss changes: white keeps the paint's, darker is smoother."}},
        Known{"relief",
              {"Relief",
               "Normals of the surface, as glTF has them: bumps and dents in whatever paint the "
               "part wears. A part has one at most."}}};
    const std::string name = kPictureUses[static_cast<std::size_t>(use)];
    for (const Known& one : known) {
        if (one.name == name) return one.words;
    }
    std::string label = name;
    label.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(label.front())));
    return {label, ""};
}

ShapeFields fields_of(ArtworkShape shape) {
    switch (shape) {
        case ArtworkShape::half:
            return {false, false, true, false, ""};
        case ArtworkShape::stripes:
            return {true, true, false, false, "From the middle of one stripe to that of the next."};
        case ArtworkShape::checks:
            return {true, false, false, false, "The side of a check."};
        case ArtworkShape::dots:
            return {true, true, false, false, "From the middle of one dot to that of the next."};
        case ArtworkShape::picture:
            return {true, false, false, true, "The picture's width."};
    }
    return {};
}

glm::dvec3 direction_from(Side side) {
    switch (side) {
        case Side::left:
            return {1.0, 0.0, 0.0};
        case Side::right:
            return {-1.0, 0.0, 0.0};
        case Side::front:
            return {0.0, 0.0, -1.0};
        case Side::back:
            return {0.0, 0.0, 1.0};
        case Side::above:
            return {0.0, -1.0, 0.0};
    }
    return {0.0, 0.0, -1.0};
}

std::optional<Side> side_of(const ArtworkPlace& place) {
    const glm::dvec3 direction = glm::normalize(place.direction);
    for (const Side side : kSides) {
        if (glm::distance(direction, direction_from(side)) < 1e-6) return side;
    }
    return std::nullopt;
}

std::array<NamedSide, kSides.size()> named_sides(const std::string& front) {
    // Of front, back, its own left and its own right, in this order.
    std::array<Side, 4> there{Side::front, Side::back, Side::left, Side::right};
    if (front == "+z") there = {Side::front, Side::back, Side::right, Side::left};
    if (front == "-z") there = {Side::back, Side::front, Side::left, Side::right};
    if (front == "+x") there = {Side::right, Side::left, Side::back, Side::front};
    if (front == "-x") there = {Side::left, Side::right, Side::front, Side::back};
    const bool own = !front.empty();
    return {{{there[2], "Left", "left", own ? "Onto the product's own left." : "From -x."},
             {there[3], "Right", "right", own ? "Onto the product's own right." : "From +x."},
             {there[0], "Front", "front", own ? "Onto its front." : "From +z."},
             {there[1], "Back", "back", own ? "Onto its back." : "From -z."},
             {Side::above, "Above", "above", "From above (+y)."}}};
}

ArtworkPlace from_side(const ArtworkPlace& place, Side side) {
    ArtworkPlace there = place_on(place.centre_mm, -direction_from(side), place.through);
    there.by_uv = place.by_uv;
    return with_turn(there, turn_deg_of(place));
}

Angles angles_of(const ArtworkPlace& place) {
    // No negative zeros, which would turn 180 degrees into -180.
    return angles_of(glm::dvec3(0.0) - place.direction);
}

ArtworkPlace from_angles(const ArtworkPlace& place, const Angles& angles) {
    const glm::dmat3 rotation = frame_at(angles) * glm::transpose(frame_at(angles_of(place)));
    ArtworkPlace there = place;
    there.direction = -direction_of(angles);
    there.up = rotation * plane_of(place).t_axis;
    return there;
}

double turn_deg_of(const ArtworkPlace& place) {
    const ArtworkPlane plane = plane_of(place);
    const ArtworkPlane level = plane_of(place_on(place.centre_mm, plane.toward, place.through));
    const double turn =
        std::atan2(-glm::dot(plane.t_axis, level.s_axis), glm::dot(plane.t_axis, level.t_axis));
    return std::abs(turn) < 1e-9 ? 0.0 : kDegreesPerRadian * turn;
}

ArtworkPlace with_turn(const ArtworkPlace& place, double turn_deg) {
    const ArtworkPlane level =
        plane_of(place_on(place.centre_mm, plane_of(place).toward, place.through));
    const double turn = turn_deg / kDegreesPerRadian;
    ArtworkPlace turned = place;
    turned.up = std::cos(turn) * level.t_axis - std::sin(turn) * level.s_axis;
    return turned;
}

Bounds bounds_of_part(const Mesh& mesh, const std::string& part) {
    if (part == "*") return bounds_of(mesh);
    glm::vec3 low(std::numeric_limits<float>::max()), high = -low;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.parts[mesh.triangle_part[t]].name != part) continue;
        for (int c = 0; c < 3; ++c) {
            const glm::vec3& x = mesh.positions_mm[mesh.triangles[t][c]];
            low = glm::min(low, x);
            high = glm::max(high, x);
        }
    }
    if (low.x > high.x) return bounds_of(mesh);
    return {glm::dvec3(low), glm::dvec3(high)};
}

Artwork new_artwork(ArtworkShape shape,
                    const std::string& part,
                    const Bounds& bounds,
                    const glm::dvec3& eye_mm,
                    const std::vector<Artwork>& others,
                    double aspect) {
    Artwork artwork;
    artwork.shape = shape;
    std::string name = words_of(shape).label;
    name.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(name.front())));
    artwork.name = name_for(name, others);
    artwork.part = part;
    // The line between two tones lies level around the product.
    const Side side = side_seen_most(bounds, eye_mm, shape != ArtworkShape::half);
    artwork.place = place_on(
        0.5 * (bounds.low + bounds.high), -direction_from(side), shape != ArtworkShape::picture);
    artwork.size_mm = first_size_mm(shape, face_of(bounds, side), aspect);
    if (shape == ArtworkShape::picture) artwork.use = PictureUse::colours;
    return artwork;
}

std::string paint_over(double lightness) {
    return lightness > 55.0 ? "solid black" : "solid ivory";
}

std::vector<Artwork> with_copy(const std::vector<Artwork>& list, std::size_t at) {
    check_place(list, at);
    Artwork copy = list[at];
    copy.name = name_for(shown_name(copy), list);
    std::vector<Artwork> more = list;
    more.insert(more.begin() + static_cast<std::ptrdiff_t>(at) + 1, std::move(copy));
    return more;
}

std::vector<Artwork> moved(std::vector<Artwork> list, std::size_t at, std::size_t to) {
    check_place(list, at);
    check_place(list, to);
    Artwork one = std::move(list[at]);
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(at));
    list.insert(list.begin() + static_cast<std::ptrdiff_t>(to), std::move(one));
    return list;
}

Artwork with_shape(const Artwork& artwork, ArtworkShape shape) {
    const Artwork fresh;
    const ShapeFields fields = fields_of(shape);
    Artwork other = artwork;
    other.shape = shape;
    if (!fields.size) other.size_mm = fresh.size_mm;
    if (!fields.share) other.share = fresh.share;
    if (!fields.softness) other.softness_mm = fresh.softness_mm;
    if (!fields.picture) {
        other.picture.clear();
        other.use = fresh.use;
        other.depth = fresh.depth;
        other.repeat = fresh.repeat;
        other.place.by_uv = fresh.place.by_uv;
    }
    return other;
}

Artwork with_use(const Artwork& artwork, PictureUse use) {
    Artwork other = artwork;
    other.use = use;
    if (is_relief(other)) {
        other.paint.clear();
    } else {
        other.depth = Artwork{}.depth;
    }
    return other;
}

Artwork put_on(const Artwork& artwork,
               const std::string& part,
               const glm::dvec3& position_mm,
               const glm::dvec3& normal) {
    Artwork there = artwork;
    if (there.part != "*") there.part = part;
    there.place =
        with_turn(place_on(position_mm, normal, artwork.place.through), turn_deg_of(artwork.place));
    return there;
}

std::string shown_name(const Artwork& artwork) {
    return artwork.name.empty() ? words_of(artwork.shape).label : artwork.name;
}

}  // namespace livery
