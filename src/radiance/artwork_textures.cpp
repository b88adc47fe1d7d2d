#include "radiance/artwork_textures.h"

#include <algorithm>
#include <bit>

#include "scene/artwork_cover.h"

namespace livery {

namespace {

constexpr int kMostTexels = 2048;  // a side
/// Above all units that a sample's other inputs take.
constexpr unsigned kPictureUnit = 6;

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
    const ArtworkPlane plane = plane_of(how.place);
    program.set("u_shape", static_cast<int>(how.shape));
    program.set("u_size", glm::vec3(how.size_mm, how.share, how.softness_mm));
    program.set("u_plane_centre_mm", glm::vec3(plane.centre_mm));
    program.set("u_plane_s", glm::vec3(plane.s_axis));
    program.set("u_plane_t", glm::vec3(plane.t_axis));
    program.set("u_plane_toward", glm::vec3(plane.toward));
    program.set("u_through", how.place.through || how.place.by_uv ? 1 : 0);
    program.set("u_by_uv", how.place.by_uv ? 1 : 0);
    program.set("u_repeat", how.repeat ? 1 : 0);
    program.set("u_artwork", static_cast<int>(kPictureUnit));
    if (!artwork.picture) return;
    const PictureFrame frame = picture_frame(artwork);
    program.set("u_picture_frame", glm::vec4(frame.scale, frame.offset));
    layers_of(artwork).bind(kPictureUnit);
}

void ArtworkTextures::keep(const Scene& scene) {
    std::erase_if(pictures_, [&](const Picture& picture) {
        return std::none_of(scene.artwork.begin(), scene.artwork.end(), [&](const auto& artwork) {
            return artwork.picture == picture.of;
        });
    });
}

}  // namespace livery
