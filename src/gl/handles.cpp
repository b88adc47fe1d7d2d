#include "gl/handles.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include <epoxy/gl.h>

#include "core/error.h"
#include "gl/program.h"
#include "gl/timer.h"

namespace livery {
namespace gl_detail {

void delete_texture(unsigned name) { glDeleteTextures(1, &name); }
void delete_buffer(unsigned name) { glDeleteBuffers(1, &name); }
void delete_vertex_array(unsigned name) { glDeleteVertexArrays(1, &name); }
void delete_framebuffer(unsigned name) { glDeleteFramebuffers(1, &name); }

}  // namespace gl_detail

namespace {

enum class TexelKind { normalised, floating, integer, depth };

struct FormatFacts {
    TexelFormat format;
    GLenum internal;
    GLenum external;
    int channels;
    std::size_t channel_bytes;  ///< on the device
    TexelKind kind;
    GLenum integer_type = 0;  ///< the one external type of integer formats
};

const FormatFacts& facts(TexelFormat format) {
    using enum TexelFormat;
    using enum TexelKind;
    static constexpr std::array kFormats{
        FormatFacts{r8, GL_R8, GL_RED, 1, 1, normalised},
        FormatFacts{rg8, GL_RG8, GL_RG, 2, 1, normalised},
        FormatFacts{rgba8, GL_RGBA8, GL_RGBA, 4, 1, normalised},
        FormatFacts{r16f, GL_R16F, GL_RED, 1, 2, floating},
        FormatFacts{rg16f, GL_RG16F, GL_RG, 2, 2, floating},
        FormatFacts{rgba16f, GL_RGBA16F, GL_RGBA, 4, 2, floating},
        FormatFacts{r32f, GL_R32F, GL_RED, 1, 4, floating},
        FormatFacts{rg32f, GL_RG32F, GL_RG, 2, 4, floating},
        FormatFacts{rgba32f, GL_RGBA32F, GL_RGBA, 4, 4, floating},
        FormatFacts{r8ui, GL_R8UI, GL_RED_INTEGER, 1, 1, integer, GL_UNSIGNED_BYTE},
        FormatFacts{r16ui, GL_R16UI, GL_RED_INTEGER, 1, 2, integer, GL_UNSIGNED_SHORT},
        FormatFacts{r32ui, GL_R32UI, GL_RED_INTEGER, 1, 4, integer, GL_UNSIGNED_INT},
        FormatFacts{rg32ui, GL_RG32UI, GL_RG_INTEGER, 2, 4, integer, GL_UNSIGNED_INT},
        FormatFacts{rgba32ui, GL_RGBA32UI, GL_RGBA_INTEGER, 4, 4, integer, GL_UNSIGNED_INT},
        FormatFacts{depth32f, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, 1, 4, depth}};
    for (const FormatFacts& known : kFormats) {
        if (known.format == format) return known;
    }
    throw std::invalid_argument("unknown texel format");
}

std::size_t bytes_of(const TextureShape& shape, TexelFormat format) {
    std::size_t texels = 0;
    for (int level = 0; level < shape.levels; ++level) {
        texels += static_cast<std::size_t>(std::max(shape.width >> level, 1)) *
                  static_cast<std::size_t>(std::max(shape.height >> level, 1));
    }
    return texels * static_cast<std::size_t>(std::max(shape.layers, 1)) *
           static_cast<std::size_t>(facts(format).channels) * facts(format).channel_bytes;
}

bool accepts(const FormatFacts& format, GLenum type) {
    switch (format.kind) {
        case TexelKind::normalised:
            return type == GL_UNSIGNED_BYTE || type == GL_FLOAT;
        case TexelKind::floating:
            return type == GL_FLOAT || type == GL_HALF_FLOAT;
        case TexelKind::integer:
            return type == format.integer_type;
        case TexelKind::depth:
            return type == GL_FLOAT;
    }
    return false;
}

GLint wrap_of(TexelWrap wrap) { return wrap == TexelWrap::clamp ? GL_CLAMP_TO_EDGE : GL_REPEAT; }

std::string size_text(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

int channel_count(TexelFormat format) { return facts(format).channels; }

Texture2D::Texture2D(int width, int height, TexelFormat format)
    : Texture2D(TextureShape{width, height, 0, 1}, format) {}

Texture2D::Texture2D(TextureShape shape,
                     TexelFormat format,
                     TexelFilter filter,
                     TexelWrap wrap_horizontal,
                     TexelWrap wrap_vertical)
    : shape_(shape), format_(format) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    check_argument(shape.width > 0 && shape.height > 0 && shape.width <= largest &&
                       shape.height <= largest && shape.layers >= 0 && shape.levels >= 1,
                   "texture of " + size_text(shape.width, shape.height) + ", " +
                       std::to_string(shape.layers) + " layers, " + std::to_string(shape.levels) +
                       " levels; this OpenGL has up to " + std::to_string(largest) + " a side");
    const GLenum target = shape.layers > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    name_ = GlName<gl_detail::delete_texture>(name);
    const FormatFacts f = facts(format);
    if (shape.layers > 0) {
        glTextureStorage3D(name, shape.levels, f.internal, shape.width, shape.height, shape.layers);
    } else {
        glTextureStorage2D(name, shape.levels, f.internal, shape.width, shape.height);
    }
    const GLint near_filter = filter == TexelFilter::nearest ? GL_NEAREST : GL_LINEAR;
    const GLint far_filter =
        filter == TexelFilter::mipmapped ? GL_LINEAR_MIPMAP_LINEAR : near_filter;
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, near_filter);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, far_filter);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, wrap_of(wrap_horizontal));
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, wrap_of(wrap_vertical));
    throw_on_gl_error("creating a texture of " + size_text(shape.width, shape.height));
    GlCounters& counted = gl_detail::counted();
    ++counted.textures;
    counted.texture_bytes += bytes_of(shape, format);
}

void Texture2D::upload_any(
    const void* data, std::size_t count, unsigned type, PixelRect rect, int level, int layer) {
    const FormatFacts f = facts(format_);
    check_argument(accepts(f, type), "texels of a type that the texture's format does not take");
    check_argument(
        level >= 0 && level < shape_.levels && layer >= 0 && layer < std::max(shape_.layers, 1),
        "level " + std::to_string(level) + ", layer " + std::to_string(layer) +
            " of a texture with " + std::to_string(shape_.levels) + " levels, " +
            std::to_string(shape_.layers) + " layers");
    const int level_width = std::max(shape_.width >> level, 1);
    const int level_height = std::max(shape_.height >> level, 1);
    if (rect.width == 0) rect = {0, 0, level_width, level_height};
    check_argument(rect.x >= 0 && rect.y >= 0 && rect.width > 0 && rect.height > 0 &&
                       rect.x + rect.width <= level_width && rect.y + rect.height <= level_height,
                   "texels for a rectangle outside the texture");
    const std::size_t expected = static_cast<std::size_t>(rect.width) *
                                 static_cast<std::size_t>(rect.height) *
                                 static_cast<std::size_t>(f.channels);
    check_argument(count == expected,
                   std::to_string(count) + " values for " + size_text(rect.width, rect.height) +
                       " texels of " + std::to_string(f.channels) + " channels, expected " +
                       std::to_string(expected));
    const std::size_t type_bytes = type == GL_UNSIGNED_BYTE                             ? 1
                                   : type == GL_UNSIGNED_SHORT || type == GL_HALF_FLOAT ? 2
                                                                                        : 4;
    gl_detail::counted().upload_bytes += count * type_bytes;
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (shape_.layers > 0) {
        glTextureSubImage3D(name_.get(),
                            level,
                            rect.x,
                            rect.y,
                            layer,
                            rect.width,
                            rect.height,
                            1,
                            f.external,
                            type,
                            data);
    } else {
        glTextureSubImage2D(
            name_.get(), level, rect.x, rect.y, rect.width, rect.height, f.external, type, data);
    }
    check_gl("uploading texels");
}

void Texture2D::upload(std::span<const float> texels, int level, int layer) {
    upload_any(texels.data(), texels.size(), GL_FLOAT, {}, level, layer);
}

void Texture2D::upload(std::span<const std::uint8_t> texels, int level, int layer) {
    upload_any(texels.data(), texels.size(), GL_UNSIGNED_BYTE, {}, level, layer);
}

void Texture2D::upload(std::span<const std::uint16_t> texels, int level, int layer) {
    const bool integer = facts(format_).kind == TexelKind::integer;
    upload_any(texels.data(),
               texels.size(),
               integer ? GL_UNSIGNED_SHORT : GL_HALF_FLOAT,
               {},
               level,
               layer);
}

void Texture2D::upload(std::span<const std::uint32_t> texels, int level, int layer) {
    upload_any(texels.data(), texels.size(), GL_UNSIGNED_INT, {}, level, layer);
}

void Texture2D::upload(std::span<const float> texels, const PixelRect& rect, int layer) {
    check_argument(rect.width > 0 && rect.height > 0, "an empty rectangle of texels");
    upload_any(texels.data(), texels.size(), GL_FLOAT, rect, 0, layer);
}

void Texture2D::make_mipmaps() {
    glGenerateTextureMipmap(name_.get());
    check_gl("making mipmaps");
}

void Texture2D::clear(float value) { clear({value, value, value, value}); }

void Texture2D::clear(const std::array<float, 4>& rgba) {
    const FormatFacts f = facts(format_);
    check_argument(f.kind != TexelKind::integer, "floats to clear an integer texture with");
    glClearTexImage(name_.get(), 0, f.external, GL_FLOAT, rgba.data());
    check_gl("clearing a texture");
}

void Texture2D::bind(unsigned unit) const { bind_texture(unit, name_.get()); }

void Texture2D::bind_image(unsigned unit) const {
    glBindImageTexture(unit, name_.get(), 0, GL_FALSE, 0, GL_WRITE_ONLY, facts(format_).internal);
    check_gl("binding an image");
}

void copy_texels(unsigned from_texture_name, const Texture2D& to, const PixelRect& rect) {
    if (rect.width <= 0 || rect.height <= 0) return;
    glCopyImageSubData(from_texture_name,
                       GL_TEXTURE_2D,
                       0,
                       rect.x,
                       rect.y,
                       0,
                       to.name(),
                       GL_TEXTURE_2D,
                       0,
                       rect.x,
                       rect.y,
                       0,
                       rect.width,
                       rect.height,
                       1);
    check_gl("copying texels");
}

void copy_layers(const Texture2D& from, const Texture2D& to) {
    check_argument(from.format() == to.format() && from.width() == to.width() &&
                       from.height() == to.height() && from.shape().layers > 0 &&
                       from.shape().layers <= to.shape().layers,
                   "layers copied between textures of " + size_text(from.width(), from.height()) +
                       " and " + size_text(to.width(), to.height()));
    glCopyImageSubData(from.name(),
                       GL_TEXTURE_2D_ARRAY,
                       0,
                       0,
                       0,
                       0,
                       to.name(),
                       GL_TEXTURE_2D_ARRAY,
                       0,
                       0,
                       0,
                       0,
                       from.width(),
                       from.height(),
                       from.shape().layers);
    check_gl("copying layers");
}

void bind_texture(unsigned unit, unsigned texture_name) {
    glBindTextureUnit(unit, texture_name);
    check_gl("binding a texture");
}

Buffer::Buffer(std::size_t bytes) : Buffer(nullptr, bytes) {}

Buffer::Buffer(const void* data, std::size_t bytes) : bytes_(bytes) {
    check_argument(bytes > 0, "an empty buffer");
    GLuint name = 0;
    glCreateBuffers(1, &name);
    name_ = GlName<gl_detail::delete_buffer>(name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_STORAGE_BIT);
    throw_on_gl_error("creating a buffer of " + std::to_string(bytes) + " bytes");
    GlCounters& counted = gl_detail::counted();
    ++counted.buffers;
    counted.buffer_bytes += bytes;
    if (data) counted.upload_bytes += bytes;
}

void Buffer::update(const void* data, std::size_t bytes, std::size_t byte_offset) {
    check_argument(byte_offset <= bytes_ && bytes <= bytes_ - byte_offset,
                   std::to_string(bytes) + " bytes at " + std::to_string(byte_offset) +
                       " for a buffer of " + std::to_string(bytes_));
    gl_detail::counted().upload_bytes += bytes;
    glNamedBufferSubData(
        name_.get(), static_cast<GLintptr>(byte_offset), static_cast<GLsizeiptr>(bytes), data);
    check_gl("updating a buffer");
}

void Buffer::clear() {
    glClearNamedBufferData(name_.get(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    check_gl("clearing a buffer");
}

void Buffer::read(void* data, std::size_t bytes) const {
    check_argument(bytes <= bytes_,
                   std::to_string(bytes) + " bytes from a buffer of " + std::to_string(bytes_));
    glGetNamedBufferSubData(name_.get(), 0, static_cast<GLsizeiptr>(bytes), data);
    throw_on_gl_error("reading a buffer");
}

void Buffer::bind_uniform_block(unsigned index) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, index, name_.get());
    check_gl("binding a uniform block");
}

void Buffer::bind_storage_block(unsigned index) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, index, name_.get());
    check_gl("binding a storage block");
}

std::size_t largest_storage_block() {
    GLint64 bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    return static_cast<std::size_t>(bytes);
}

VertexArray::VertexArray() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    name_ = GlName<gl_detail::delete_vertex_array>(name);
}

void VertexArray::floats(unsigned location,
                         const Buffer& buffer,
                         int components,
                         int stride,
                         std::size_t byte_offset,
                         unsigned divisor) {
    const GLuint vao = name_.get();
    glVertexArrayVertexBuffer(
        vao, location, buffer.name(), static_cast<GLintptr>(byte_offset), stride);
    glVertexArrayAttribFormat(vao, location, components, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(vao, location, location);
    glVertexArrayBindingDivisor(vao, location, divisor);
    glEnableVertexArrayAttrib(vao, location);
    throw_on_gl_error("describing vertex input " + std::to_string(location));
}

void VertexArray::integers(unsigned location,
                           const Buffer& buffer,
                           int components,
                           int component_bytes,
                           int stride,
                           std::size_t byte_offset,
                           unsigned divisor) {
    check_argument(component_bytes == 1 || component_bytes == 2 || component_bytes == 4,
                   "vertex integers of " + std::to_string(component_bytes) + " bytes");
    const GLenum type = component_bytes == 1   ? GL_UNSIGNED_BYTE
                        : component_bytes == 2 ? GL_UNSIGNED_SHORT
                                               : GL_UNSIGNED_INT;
    const GLuint vao = name_.get();
    glVertexArrayVertexBuffer(
        vao, location, buffer.name(), static_cast<GLintptr>(byte_offset), stride);
    glVertexArrayAttribIFormat(vao, location, components, type, 0);
    glVertexArrayAttribBinding(vao, location, location);
    glVertexArrayBindingDivisor(vao, location, divisor);
    glEnableVertexArrayAttrib(vao, location);
    throw_on_gl_error("describing vertex input " + std::to_string(location));
}

void VertexArray::indices(const Buffer& buffer) {
    glVertexArrayElementBuffer(name_.get(), buffer.name());
    throw_on_gl_error("attaching indices");
}

void VertexArray::bind() const { glBindVertexArray(name_.get()); }

Framebuffer::Framebuffer(const std::vector<const Texture2D*>& colours,
                         const Texture2D* depth,
                         int layer) {
    check_argument(!colours.empty() || depth, "a framebuffer without textures");
    const Texture2D& first = colours.empty() ? *depth : *colours.front();
    width_ = first.width();
    height_ = first.height();
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    ++gl_detail::counted().framebuffers;
    name_ = GlName<gl_detail::delete_framebuffer>(name);
    const auto attach = [&](GLenum where, const Texture2D& texture) {
        check_argument(texture.width() == width_ && texture.height() == height_,
                       "a framebuffer over textures of " + size_text(width_, height_) + " and " +
                           size_text(texture.width(), texture.height()));
        if (texture.shape().layers > 0) {
            glNamedFramebufferTextureLayer(name, where, texture.name(), 0, layer);
        } else {
            glNamedFramebufferTexture(name, where, texture.name(), 0);
        }
    };
    std::vector<GLenum> attachments;
    for (const Texture2D* colour : colours) {
        const GLenum where = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachments.size());
        attach(where, *colour);
        attachments.push_back(where);
    }
    if (depth) attach(GL_DEPTH_ATTACHMENT, *depth);
    if (attachments.empty()) {
        glNamedFramebufferDrawBuffer(name, GL_NONE);
    } else {
        glNamedFramebufferDrawBuffers(
            name, static_cast<GLsizei>(attachments.size()), attachments.data());
    }
    const GLenum status = glCheckNamedFramebufferStatus(name, GL_DRAW_FRAMEBUFFER);
    throw_on_gl_error("making a framebuffer");
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw std::runtime_error("OpenGL framebuffer of " + size_text(width_, height_) +
                                 " is incomplete, status " + std::to_string(status));
    }
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name_.get());
    glViewport(0, 0, width_, height_);
    check_gl("binding a framebuffer");
}

void Framebuffer::clear_colour(int attachment, float r, float g, float b, float a) const {
    // Clearing obeys the scissor; a clear here means all of it.
    glDisable(GL_SCISSOR_TEST);
    const float values[4] = {r, g, b, a};
    glClearNamedFramebufferfv(name_.get(), GL_COLOR, attachment, values);
    check_gl("clearing a framebuffer");
}

void Framebuffer::clear_depth(float depth) const {
    glDisable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(name_.get(), GL_DEPTH, 0, &depth);
    check_gl("clearing depth");
}

}  // namespace livery
