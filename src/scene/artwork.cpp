#include "scene/artwork.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "mesh/beside.h"
#include "scene/artwork_picture.h"

namespace livery {

namespace {

void check_between(double value, double low, double high, const char* what) {
    if (value >= low && value <= high) return;
    throw std::invalid_argument(fmt::format(
        "an artwork's {} is {}; expected a number from {} to {}", what, value, low, high));
}

void check_vector(const glm::dvec3& v, const char* what) {
    for (int c = 0; c < 3; ++c) check_between(v[c], -1e6, 1e6, what);
}

/// Some direction square to a unit one, the same for the same one.
glm::dvec3 square_to(const glm::dvec3& d) {
    const glm::dvec3 aside = std::abs(d.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    return glm::normalize(aside - glm::dot(aside, d) * d);
}

}  // namespace

bool is_relief(const Artwork& artwork) {
    return artwork.shape == ArtworkShape::picture && artwork.use == PictureUse::relief;
}

bool reads_colours(const Artwork& artwork) {
    return artwork.shape == ArtworkShape::picture &&
           (artwork.use == PictureUse::colours || artwork.use == PictureUse::tint);
}

void check_artwork(const Artwork& artwork) {
    check_between(artwork.size_mm, 0.1, 1e5, "size_mm");
    check_between(artwork.share, 0.0, 1.0, "share");
    check_between(artwork.softness_mm, 0.0, 1e5, "softness_mm");
    check_between(artwork.depth, -10.0, 10.0, "depth");
    const ArtworkPlace& place = artwork.place;
    check_vector(place.centre_mm, "centre_mm");
    check_vector(place.direction, "direction");
    check_vector(place.up, "up");
    const double length = glm::length(place.direction), up = glm::length(place.up);
    if (!(length > 1e-9) || !(up > 1e-9)) {
        throw std::invalid_argument("an artwork's direction or up is a vector of no length");
    }
    if (glm::length(glm::cross(place.direction, place.up)) < 1e-6 * length * up) {
        throw std::invalid_argument("an artwork's up lies along its direction; expected it across");
    }
    const bool picture = artwork.shape == ArtworkShape::picture;
    if (picture && artwork.picture.empty()) {
        throw std::invalid_argument("an artwork's picture is missing; expected a file");
    }
    if (is_relief(artwork) && !artwork.paint.empty()) {
        throw std::invalid_argument(
            fmt::format("an artwork's relief has the paint {}; expected none", artwork.paint));
    }
    if (!picture && place.by_uv) {
        throw std::invalid_argument(
            fmt::format("an artwork's place is by uv and its shape {}; only pictures lie there",
                        kArtworkShapes[static_cast<std::size_t>(artwork.shape)]));
    }
    if (!picture && !artwork.picture.empty()) {
        throw std::invalid_argument(
            fmt::format("an artwork has the picture {} and the shape {}; expected \"picture\"",
                        artwork.picture,
                        kArtworkShapes[static_cast<std::size_t>(artwork.shape)]));
    }
}

glm::dvec2 ArtworkPlane::operator*(const glm::dvec3& x_mm) const {
    const glm::dvec3 from = x_mm - centre_mm;
    return {glm::dot(s_axis, from), glm::dot(t_axis, from)};
}

ArtworkPlane plane_of(const ArtworkPlace& place) {
    ArtworkPlane plane;
    plane.centre_mm = place.centre_mm;
    plane.toward = -glm::normalize(place.direction);
    plane.t_axis = glm::normalize(place.up - glm::dot(place.up, plane.toward) * plane.toward);
    plane.s_axis = glm::cross(plane.t_axis, plane.toward);
    return plane;
}

ArtworkPlace place_on(const glm::dvec3& position_mm, const glm::dvec3& normal, bool through) {
    ArtworkPlace place;
    place.centre_mm = position_mm;
    place.direction = -glm::normalize(normal);
    place.up = square_to(place.direction);
    place.through = through;
    return place;
}

std::optional<std::string> picture_problem(const Artwork& artwork) {
    if (artwork.picture.empty()) return std::nullopt;
    try {
        load_artwork_picture(find_artwork_picture(artwork.picture, {}));
    } catch (const FileError& error) {
        return error.what();
    }
    return std::nullopt;
}

std::filesystem::path find_artwork_picture(const std::string& name,
                                           const std::filesystem::path& beside) {
    return find_beside_or_shipped(name, beside, "picture", "a picture");
}

}  // namespace livery
