// Pictures of a glTF's textures, decoded by OpenImageIO.
#include <algorithm>

#include <fmt/format.h>

#include "core/colour.h"
#include "core/error.h"
#include "core/utf8.h"
#include "mesh/gltf/gltf_container.h"
#include "mesh/gltf/gltf_parts.h"

namespace livery {

namespace {

constexpr std::size_t kMostPixelsASide = 4096;
/// Of all pictures of a file as they are kept: half a gigabyte.
constexpr std::size_t kMostTexels = 1u << 25u;
constexpr std::size_t kFewestASide = 64;
/// Decoded of one file: a few seconds' work.
constexpr std::size_t kMostPixels = 1u << 27u;

/// Of whole numbers of 8 or 16 bits, exactly.
float decoded(float encoded) {
    static const std::vector<float> table = [] {
        std::vector<float> values(65536);
        for (std::size_t k = 0; k < values.size(); ++k) {
            values[k] = static_cast<float>(srgb_decode(static_cast<double>(k) / 65535.0));
        }
        return values;
    }();
    return table[static_cast<std::size_t>(encoded * 65535.0f + 0.5f)];
}

void make_linear(ArtworkPicture& picture) {
    if (!std::exchange(picture.linear, true)) {
        for (std::size_t i = 0; i < picture.rgba.values.size(); ++i) {
            if (i % 4 != 3) picture.rgba.values[i] = decoded(picture.rgba.values[i]);
        }
    }
}

}  // namespace

ImageF resampled(const ImageF& picture, int width, int height) {
    if (picture.width == width && picture.height == height) return picture;
    ImageF to(width, height, picture.channels);
    const auto begin_of = [](int k, int count, int from) {
        return static_cast<int>(std::int64_t{k} * from / count);
    };
    for (int y = 0; y < height; ++y) {
        const int y0 = begin_of(y, height, picture.height);
        const int y1 = std::max(begin_of(y + 1, height, picture.height), y0 + 1);
        for (int x = 0; x < width; ++x) {
            const int x0 = begin_of(x, width, picture.width);
            const int x1 = std::max(begin_of(x + 1, width, picture.width), x0 + 1);
            const float share = 1.0f / static_cast<float>((x1 - x0) * (y1 - y0));
            for (int row = y0; row < y1; ++row) {
                for (int column = x0; column < x1; ++column) {
                    for (int c = 0; c < picture.channels; ++c) {
                        to.at(x, y, c) += share * picture.at(column, row, c);
                    }
                }
            }
        }
    }
    return to;
}

GltfPictures::GltfPictures(const GltfFile& gltf) : gltf_(gltf), pixels_left_(kMostPixels) {
    const std::size_t count = gltf.root().has("images") ? gltf.root()["images"].size() : 0;
    for (most_a_side_ = kMostPixelsASide;
         count * most_a_side_ * most_a_side_ > kMostTexels && most_a_side_ > kFewestASide;) {
        most_a_side_ /= 2;
    }
}

const GltfPicture& GltfPictures::of_texture(int texture, bool colours) {
    const tinygltf::Texture& from = gltf_.model.textures[static_cast<std::size_t>(texture)];
    const int image = from.source >= 0 ? from.source : -1 - texture;
    const auto [known, is_new] = read_.try_emplace({image, colours});
    if (!is_new) return known->second;
    if (from.source >= 0) return known->second = read(image, colours);
    known->second.note = "a texture without a picture";
    for (const auto& [name, extension] : from.extensions) {
        if (extension.Has("source")) known->second.note = "a picture by " + name + " is not read";
    }
    return known->second;
}

GltfPicture GltfPictures::read(int index, bool colours) {
    const auto image = gltf_.root()["images"].at(static_cast<std::size_t>(index));
    const bool inside = !image.has("uri") || image["uri"].text().starts_with("data:");
    const std::string name =
        inside ? "an embedded picture"
               : fmt::format("the picture \"{}\"", printable(image["uri"].text(), 100));
    try {
        const std::size_t most = std::min(kMostPixelsASide * kMostPixelsASide, pixels_left_);
        ImageFile file;
        std::filesystem::path path = fmt::format("images[{}]", index);
        if (image.has("uri")) {
            const GltfUri uri = resolve_gltf_uri(image["uri"]);
            if (uri.inside) {
                file = read_image_bytes(*uri.inside, path, most);
            } else if (!uri.beside) {
                return {nullptr, name + " is not read: it is not beside the model"};
            } else if (std::error_code error; !std::filesystem::exists(*uri.beside, error)) {
                return {nullptr, name + " is missing"};
            } else {
                path = *uri.beside;
                file = read_image(path, most);
            }
        } else if (image.has("bufferView")) {
            const int view = image["bufferView"].integer(0, 0x7fffffff);
            file = read_image_bytes(gltf_.view(static_cast<std::size_t>(view)), path, most);
        } else {
            return {nullptr, name + " is not read: neither a uri nor a bufferView"};
        }
        pixels_left_ -= file.image.pixel_count();
        ArtworkPicture picture = artwork_picture_of(file, path);
        if (colours) make_linear(picture);
        int width = picture.rgba.width, height = picture.rgba.height;
        while (static_cast<std::size_t>(std::max(width, height)) > most_a_side_) {
            width = std::max(width / 2, 1);
            height = std::max(height / 2, 1);
        }
        std::string note;
        if (width != picture.rgba.width || height != picture.rgba.height) {
            note = fmt::format("{} is shrunk to {}x{}", name, width, height);
        }
        picture.rgba = resampled(picture.rgba, width, height);
        return {std::make_shared<const ArtworkPicture>(std::move(picture)), note};
    } catch (const FileError& error) {
        return {
            nullptr,
            fmt::format("{} is not read: {}; expected {}", name, error.found(), error.expected())};
    }
}

}  // namespace livery
