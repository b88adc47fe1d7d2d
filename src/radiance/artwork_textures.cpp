#include "radiance/artwork_textures.h"

#include <algorithm>
#include <bit>
#include <string>

#include "scene/artwork_cover.h"

namespace livery {

namespace {

constexpr int kMostTexels = 2048;  // a side
/// Above all units that a sample's other inputs take.
constexpr unsigned kPictureUnit = 6, kReliefUnit = 7;

Texture2D texture_of(const FilteredPicture& picture) {
    const ImageF& image = picture.level_within(kMostTexels);
    const auto channels = static_cast<std::size_t>(image.channels);
    const TexelWrap wrap = picture.repeats() ? TexelWrap::repeat : TexelWrap::clamp;
    const auto longer = static_cast<unsigned>(std::max(image.width, image.height));
    Texture2D texture(
        {image.width, image.height, image.channels / 4, static_cast<int>(std::bit_width(longer))},
        TexelFormat::rgba16f,
        TexelFilter::mipmapped,
        wrap,
        wrap);
    std::vector<float> texels(4 * image.pixel_count());
    for (std::size_t layer = 0; layer < channels / 4; ++layer) {
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
            std::copy_n(&image.values[channels * i + 4 * layer], 4, &texels[4 * i]);
        }
        texture.upload(std::span<const float>(texels), 0, static_cast<int>(layer));
    }
    texture.make_mipmaps();
    return texture;
}

void set_place(Program& program, const std::string& name, const PartArtwork& artwork) {
    const ArtworkPlace& place = artwork.artwork.place;
    const ArtworkPlane plane = plane_of(place);
    const PictureFrame picture = artwork.picture ? picture_frame(artwork) : PictureFrame();
    program.set(name + ".centre_mm", glm::vec3(plane.centre_mm));
    program.set(name + ".s", glm::vec3(plane.s_axis));
    program.set(name + ".t", glm::vec3(plane.t_axis));
    program.set(name + ".toward", glm::vec3(plane.toward));
    program.set(name + ".through", place.through ? 1 : 0);
    program.set(name + ".by_uv", place.by_uv ? 1 : 0);
    program.set(name + ".repeat", artwork.artwork.repeat ? 1 : 0);
    program.set(name + ".picture", glm::vec4(picture.scale, picture.offset));
}

}  // namespace

const Texture2D& ArtworkTextures::layers_of(const PartArtwork& artwork) {
    const Artwork& how = artwork.artwork;
    for (const Picture& known : pictures_) {
        if (known.of == artwork.picture && known.use == how.use && known.repeat == how.repeat &&
            known.pigment_response == artwork.pigment_response) {
            return known.layers;
        }
    }
    const FilteredPicture filtered(
        picture_layers(*artwork.picture, how.use, artwork.pigment_response), how.repeat);
    pictures_.push_back(
        {artwork.picture, how.use, how.repeat, artwork.pigment_response, texture_of(filtered)});
    return pictures_.back().layers;
}

void ArtworkTextures::set(Program& program, const PartArtwork& artwork) {
    const Artwork& how = artwork.artwork;
    program.set("u_shape", static_cast<int>(how.shape));
    program.set("u_size", glm::vec3(how.size_mm, how.share, how.softness_mm));
    set_place(program, "u_place", artwork);
    program.set("u_artwork", static_cast<int>(kPictureUnit));
    if (artwork.picture) layers_of(artwork).bind(kPictureUnit);
}

void ArtworkTextures::set_relief(Program& program, const PartArtwork& relief) {
    set_place(program, "u_relief_place", relief);
    program.set("u_relief_depth", static_cast<float>(relief.artwork.depth));
    program.set("u_relief", static_cast<int>(kReliefUnit));
    layers_of(relief).bind(kReliefUnit);
}

void ArtworkTextures::keep(const Scene& scene) {
    std::erase_if(pictures_, [&](const Picture& picture) {
        const auto has_it = [&](const PartArtwork& one) { return one.picture == picture.of; };
        return std::none_of(scene.artwork.begin(), scene.artwork.end(), has_it) &&
               std::none_of(scene.relief.begin(), scene.relief.end(), has_it);
    });
}

}  // namespace livery
