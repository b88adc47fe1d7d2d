#include "gl/read_back.h"

#include <algorithm>
#include <array>
#include <string>

#include <epoxy/gl.h>

#include "core/error.h"
#include "gl/program.h"

namespace livery {
namespace {

GLenum external_format(int channels) {
    constexpr std::array<GLenum, 4> kFormats = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    check_argument(channels >= 1 && channels <= 4,
                   std::to_string(channels) + " channels to read back, 1 to 4 exist");
    return kFormats[static_cast<std::size_t>(channels - 1)];
}

template <typename T>
void read(unsigned name, int level, int layer, GLenum format, GLenum type, Image<T>* out) {
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureSubImage(name,
                         level,
                         0,
                         0,
                         layer,
                         out->width,
                         out->height,
                         1,
                         format,
                         type,
                         static_cast<GLsizei>(out->values.size() * sizeof(T)),
                         out->values.data());
    throw_on_gl_error("reading a texture back");
}

}  // namespace

ImageF read_floats(const Texture2D& texture, int level, int layer) {
    const int channels = channel_count(texture.format());
    ImageF image(
        std::max(texture.width() >> level, 1), std::max(texture.height() >> level, 1), channels);
    const GLenum format =
        texture.format() == TexelFormat::depth32f ? GL_DEPTH_COMPONENT : external_format(channels);
    read(texture.name(), level, layer, format, GL_FLOAT, &image);
    return image;
}

void read_floats_into(const Texture2D& texture, ImageF* picture) {
    const int channels = channel_count(texture.format());
    if (picture->width != texture.width() || picture->height != texture.height() ||
        picture->channels != channels) {
        *picture = ImageF(texture.width(), texture.height(), channels);
    }
    read(texture.name(), 0, 0, external_format(channels), GL_FLOAT, picture);
}

Image8 read_bytes(const Texture2D& texture, int channels) {
    Image8 image(texture.width(), texture.height(), channels);
    read(texture.name(), 0, 0, external_format(channels), GL_UNSIGNED_BYTE, &image);
    return image;
}

Image<std::uint32_t> read_integers(const Texture2D& texture) {
    constexpr std::array<GLenum, 4> kFormats = {
        GL_RED_INTEGER, GL_RG_INTEGER, GL_RGB_INTEGER, GL_RGBA_INTEGER};
    const int channels = channel_count(texture.format());
    Image<std::uint32_t> image(texture.width(), texture.height(), channels);
    read(texture.name(),
         0,
         0,
         kFormats[static_cast<std::size_t>(channels - 1)],
         GL_UNSIGNED_INT,
         &image);
    return image;
}

ImageF read_floats(unsigned texture_name, int width, int height, int channels) {
    ImageF image(width, height, channels);
    read(texture_name, 0, 0, external_format(channels), GL_FLOAT, &image);
    return image;
}

}  // namespace livery
