// Move-only owners of OpenGL objects. Needs a current context from creation to destruction.
//
// Orientation: row 0 of a picture's data is texel row 0, and it is the picture's top row. So in a
// fragment shader gl_FragCoord.xy is the pixel position in the program's own convention (centres
// at half integers, rows down): NDC y = -1 is the top edge, y_ndc = 2 y_px / height - 1, and no
// step flips anything. Only a window's final blit turns the picture over.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace livery {

enum class TexelFormat {
    r8,
    rg8,
    rgba8,
    r16f,
    rg16f,
    rgba16f,
    r32f,
    rg32f,
    rgba32f,
    r8ui,
    r16ui,
    r32ui,
    rg32ui,
    rgba32ui,
    depth32f,
};
int channel_count(TexelFormat format);

enum class TexelFilter { nearest, linear, mipmapped };
enum class TexelWrap { clamp, repeat };

struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
};

/// The name of one OpenGL object; what deletes it is fixed by the type.
template <void (*Delete)(unsigned)>
class GlName {
  public:
    GlName() = default;
    explicit GlName(unsigned name) : name_(name) {}
    GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0u)) {}
    GlName& operator=(GlName&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    GlName(const GlName&) = delete;
    GlName& operator=(const GlName&) = delete;
    ~GlName() {
        if (name_ != 0u) Delete(name_);
    }
    unsigned get() const { return name_; }

  private:
    unsigned name_ = 0;
};

namespace gl_detail {
void delete_texture(unsigned name);
void delete_buffer(unsigned name);
void delete_vertex_array(unsigned name);
void delete_framebuffer(unsigned name);
}  // namespace gl_detail

struct TextureShape {
    int width = 0;
    int height = 0;
    int layers = 0;  ///< 0: sampler2D; 1 and more: sampler2DArray
    int levels = 1;  ///< mip levels
};

/// Immutable storage, a 2D texture or an array of them. Default-constructed: none.
class Texture2D {
  public:
    Texture2D() = default;
    Texture2D(TextureShape shape,
              TexelFormat format,
              TexelFilter filter = TexelFilter::nearest,
              TexelWrap wrap_horizontal = TexelWrap::clamp,
              TexelWrap wrap_vertical = TexelWrap::clamp);
    Texture2D(int width, int height, TexelFormat format);

    /// Tightly packed texels of one level (and layer), as many channels as the format has; floats
    /// become half floats where the format is. Throws std::invalid_argument on a wrong size or
    /// type (float and half need a float format, bytes r8 to rgba8 or r8ui, integers the *ui).
    void upload(std::span<const float> texels, int level = 0, int layer = 0);
    void upload(std::span<const std::uint8_t> texels, int level = 0, int layer = 0);
    void upload(std::span<const std::uint16_t> texels, int level = 0, int layer = 0);
    void upload(std::span<const std::uint32_t> texels, int level = 0, int layer = 0);
    /// A rectangle of level 0.
    void upload(std::span<const float> texels, const PixelRect& rect, int layer = 0);
    void make_mipmaps();
    void clear(float value = 0.0f);  ///< every channel of level 0; float and normalised formats
    void clear(const std::array<float, 4>& rgba);

    void bind(unsigned unit) const;
    void bind_image(unsigned unit) const;  ///< level 0, for a compute program to write
    unsigned name() const { return name_.get(); }
    const TextureShape& shape() const { return shape_; }
    int width() const { return shape_.width; }
    int height() const { return shape_.height; }
    TexelFormat format() const { return format_; }
    explicit operator bool() const { return name_.get() != 0u; }

  private:
    void upload_any(
        const void* data, std::size_t count, unsigned type, PixelRect rect, int level, int layer);

    GlName<gl_detail::delete_texture> name_;
    TextureShape shape_;
    TexelFormat format_ = TexelFormat::rgba8;
};

/// Binds a texture that somebody else owns.
void bind_texture(unsigned unit, unsigned texture_name);

/// The same rectangle of level 0 from one texture into another, whose format has as many bits.
void copy_texels(unsigned from_texture_name, const Texture2D& to, const PixelRect& rect);

/// All layers of an array's level 0 to the first ones of another, of the same size and format.
void copy_layers(const Texture2D& from, const Texture2D& to);

/// Bytes on the device: vertices, indices, uniform or shader storage blocks.
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::size_t bytes);
    template <typename T>
    explicit Buffer(std::span<const T> values) : Buffer(values.data(), values.size_bytes()) {}
    template <typename T>
    explicit Buffer(const std::vector<T>& values) : Buffer(std::span<const T>(values)) {}

    template <typename T>
    void update(std::span<const T> values, std::size_t byte_offset = 0) {
        update(values.data(), values.size_bytes(), byte_offset);
    }
    void update(const void* data, std::size_t bytes, std::size_t byte_offset);
    void clear();  ///< to zeros
    /// From its beginning; waits for what was asked for before.
    void read(void* data, std::size_t bytes) const;
    void bind_uniform_block(unsigned index) const;
    void bind_storage_block(unsigned index) const;
    std::size_t bytes() const { return bytes_; }
    unsigned name() const { return name_.get(); }

  private:
    Buffer(const void* data, std::size_t bytes);

    GlName<gl_detail::delete_buffer> name_;
    std::size_t bytes_ = 0;
};

/// Bytes that a shader sees of one storage block; 2^24 at least.
std::size_t largest_storage_block();

/// Where the vertex shader's inputs come from. Keeps names only: the buffers must outlive it.
class VertexArray {
  public:
    VertexArray();  ///< no inputs: shaders that count gl_VertexID
    /// `components` floats from `byte_offset`, one every `stride` bytes (divisor 1: an instance).
    void floats(unsigned location,
                const Buffer& buffer,
                int components,
                int stride,
                std::size_t byte_offset = 0,
                unsigned divisor = 0);
    /// Unsigned integers of 1, 2 or 4 bytes, seen as uint by the shader.
    void integers(unsigned location,
                  const Buffer& buffer,
                  int components,
                  int component_bytes,
                  int stride,
                  std::size_t byte_offset = 0,
                  unsigned divisor = 0);
    void indices(const Buffer& buffer);  ///< 32 bit
    void bind() const;

  private:
    GlName<gl_detail::delete_vertex_array> name_;
};

/// Draws into level 0 of textures of one size. Keeps names only: the textures must outlive it.
class Framebuffer {
  public:
    Framebuffer() = default;
    /// Throws std::invalid_argument on different sizes, std::runtime_error when incomplete.
    explicit Framebuffer(const std::vector<const Texture2D*>& colours,
                         const Texture2D* depth = nullptr,
                         int layer = 0);

    void bind() const;  ///< and sets the viewport to the whole of it
    void clear_colour(int attachment, float r, float g, float b, float a) const;
    void clear_depth(float depth = 1.0f) const;
    int width() const { return width_; }
    int height() const { return height_; }
    unsigned name() const { return name_.get(); }

  private:
    GlName<gl_detail::delete_framebuffer> name_;
    int width_ = 0, height_ = 0;
};

}  // namespace livery
