#include "scene/artwork_coats.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "appearance/model_table.h"
#include "appearance/paint_bsdf.h"
#include "core/colour.h"
#include "scene/artwork_cover.h"

namespace livery {

namespace {

/// The reflectance that a metal's dark end keeps, so that it stays a metal's: between the two ends
/// its light is a straight line.
constexpr double kDarkMetal = 0.1;
/// Of ink's binder, of index 1.5.
constexpr double kBinderReflectance = 0.04;
/// Above it a reflectance is a metal's or a flake's.
constexpr double kMostOfABinder = 0.12;
constexpr std::size_t kResponses = 257;

bool has(const Material& material, const char* parameter) {
    return model_info(material.model).has(parameter);
}

/// A paint without pigment has its colour in the reflectance of its metal.
bool is_metal(const Material& material) {
    return has(material, "f0") && material.diffuse == glm::dvec3(0.0);
}

Material with_pigment(Material material, const glm::dvec3& rec709) {
    if (is_metal(material)) {
        material.f0 *= rec709;
    } else {
        material.diffuse = rec709;
    }
    return material;
}

void hide_metal(glm::dvec3& reflectance) {
    if (std::max({reflectance.x, reflectance.y, reflectance.z}) > kMostOfABinder) {
        reflectance = glm::dvec3(kBinderReflectance);
    }
}

/// White opaque ink in the paint's gloss. Under a coat it lies on the flakes and on what tints the
/// coat, and its binder has the coat's index; on bare metal it is as glossy as the metal.
Material ink_on(Material material) {
    if (has(material, "coat_f0")) {
        material.name = "ink under the coat of " + material.name;
        material.model = ReflectanceModel::clearcoat;
        material.coat_transmittance = glm::dvec3(1.0);
        material.f0 = glm::dvec3(0.0);
    } else {
        material.name = "ink on " + material.name;
        if (has(material, "f0")) hide_metal(material.f0);
        if (has(material, "specular")) hide_metal(material.specular);
    }
    material.diffuse = glm::dvec3(1.0);
    return material;
}

/// Under a coat the coat's, the interface that the light meets first.
Material with_roughness(Material material, double scale) {
    const auto scaled = [&](double alpha) { return glm::clamp(alpha * scale, 1e-3, 1.0); };
    if (has(material, "coat_alpha")) {
        material.coat_alpha = scaled(material.coat_alpha);
    } else if (has(material, "alpha")) {
        for (int c = 0; c < 2; ++c) material.alpha[c] = scaled(material.alpha[c]);
    } else {
        for (int c = 0; c < 2; ++c) {
            // alpha^2 = 2 / (n + 2)
            const double n = (material.exponent[c] + 2.0) / (scale * scale) - 2.0;
            material.exponent[c] = glm::clamp(n, 1.0, 1e6);
        }
    }
    return material;
}

std::vector<float> pigment_response(const Material& material) {
    std::vector<float> response(kResponses);
    const auto returned = [&](double reflectance) {
        const Material grey = with_pigment(material, glm::dvec3(reflectance));
        return environment_weights(bsdf_of(grey), 0.5f).diffuse.x;
    };
    const float white = returned(1.0);
    for (std::size_t k = 0; k < kResponses; ++k) {
        const double reflectance = static_cast<double>(k) / static_cast<double>(kResponses - 1);
        response[k] = returned(reflectance) / white;
    }
    return response;
}

void check_paint(const Artwork& artwork, const Material& material) {
    if (artwork.shape != ArtworkShape::picture) return;
    const bool has_gloss =
        has(material, "alpha") || has(material, "coat_alpha") || has(material, "exponent");
    if (reads_colours(artwork) && !has(material, "diffuse") && !has(material, "f0")) {
        throw std::invalid_argument(
            fmt::format("{} is {}: a picture cannot give it colours; expected a paint with a "
                        "colour of its own, or the use \"cover\"",
                        material.name,
                        model_info(material.model).in_words));
    }
    if (artwork.use == PictureUse::roughness && !has_gloss) {
        throw std::invalid_argument(
            fmt::format("{} is {}: a map of roughness changes nothing on it; expected a paint with "
                        "gloss",
                        material.name,
                        model_info(material.model).in_words));
    }
}

}  // namespace

bool covers_alike(const PartArtwork& a, const PartArtwork& b) {
    Artwork one = a.artwork, other = b.artwork;
    one.name = other.name;
    one.paint = other.paint;
    one.part = other.part;
    return a.part == b.part && one == other && a.picture == b.picture &&
           a.pigment_response == b.pigment_response;
}

bool looks_alike(const PartArtwork& a, const PartArtwork& b) {
    return covers_alike(a, b) && same_reflectance(a.material, b.material);
}

PartArtwork make_part_artwork(std::size_t part,
                              const Artwork& artwork,
                              const Material& material,
                              std::shared_ptr<const ArtworkPicture> picture) {
    check_artwork(artwork);
    check_paint(artwork, material);
    PartArtwork result{part, artwork, material, std::move(picture), {}};
    if (!reads_colours(artwork)) return result;
    if (artwork.use == PictureUse::colours) result.material = ink_on(material);
    if (is_metal(result.material)) {
        result.pigment_response = {0.0f, 1.0f};
    } else {
        result.pigment_response = pigment_response(result.material);
    }
    return result;
}

std::vector<ArtworkCoat> coats_of(const PartArtwork& artwork) {
    const Material& material = artwork.material;
    const bool picture = artwork.artwork.shape == ArtworkShape::picture;
    if (!picture || artwork.artwork.use == PictureUse::cover) return {{material}};
    std::vector<ArtworkCoat> coats;
    if (reads_colours(artwork.artwork)) {
        const double dark = is_metal(material) ? kDarkMetal : 0.0;
        const auto scale = static_cast<float>(1.0 / (1.0 - dark));
        const auto offset = static_cast<float>(dark / (1.0 - dark));
        coats.push_back({with_pigment(material, glm::dvec3(dark)), 0, -scale, 1.0f + offset, 1.0f});
        coats.push_back({with_pigment(material, glm::dvec3(1.0)), 0, scale, -offset, 0.0f});
        return coats;
    }
    const std::vector<double> steps = roughness_steps(*artwork.picture);
    for (std::size_t k = 0; k < steps.size(); ++k) {
        coats.push_back({with_roughness(material, steps[k]), k, 1.0f, 0.0f, k == 0 ? 1.0f : 0.0f});
    }
    return coats;
}

PictureFrame picture_frame(const PartArtwork& artwork) {
    if (artwork.artwork.place.by_uv) return {};
    const double width = artwork.artwork.size_mm, height = width * artwork.picture->aspect();
    return {{1.0 / width, -1.0 / height}, {0.5, 0.5}};
}

ArtworkPoint artwork_at(const PartArtwork& artwork,
                        const glm::dvec3& position_mm,
                        const glm::dvec3& normal,
                        const glm::dvec2& uv) {
    const ArtworkPlace& place = artwork.artwork.place;
    const ArtworkPlane plane = plane_of(place);
    const double facing = facing_cover(place, glm::dot(normal, plane.toward));
    if (facing <= 0.0) return {};
    const glm::dvec2 at = place.by_uv ? uv : plane * position_mm;
    if (!artwork.picture) {
        const glm::dvec2 none(0.0);
        return {facing * shape_cover(artwork.artwork, at, none, none), glm::vec4(1.0f)};
    }
    const ArtworkPicture& picture = *artwork.picture;
    glm::dvec2 on = picture_frame(artwork).uv(at);
    if (artwork.artwork.repeat) on -= glm::floor(on);
    const glm::dvec2 size(picture.rgba.width, picture.rgba.height);
    const glm::dvec2 texel = artwork.artwork.repeat ? glm::min(glm::floor(on * size), size - 1.0)
                                                    : glm::floor(on * size);
    if (!(texel.x >= 0.0 && texel.y >= 0.0 && texel.x < size.x && texel.y < size.y)) return {};
    const float* rgba = picture.rgba.pixel(static_cast<int>(texel.x), static_cast<int>(texel.y));
    double cover = static_cast<double>(rgba[3]);
    if (artwork.artwork.use == PictureUse::cover) cover = picture_cover(picture, rgba);
    return {facing * cover, {rgba[0], rgba[1], rgba[2], rgba[3]}};
}

Material material_at(const PartArtwork& artwork, const glm::vec4& rgba) {
    if (artwork.artwork.shape != ArtworkShape::picture) return artwork.material;
    glm::dvec3 colour(rgba);
    switch (artwork.artwork.use) {
        case PictureUse::cover:
        case PictureUse::relief:
            return artwork.material;
        case PictureUse::colours:
        case PictureUse::tint:
            if (!artwork.picture->linear) {
                for (int c = 0; c < 3; ++c) colour[c] = srgb_decode(colour[c]);
            }
            return with_pigment(artwork.material, colour);
        case PictureUse::roughness:
            return with_roughness(artwork.material, slope_scale(rgba.y));
    }
    return artwork.material;
}

}  // namespace livery
