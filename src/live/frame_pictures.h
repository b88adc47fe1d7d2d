// A frame's pictures, where they were made, and the textures that threads hand to one another.
#pragma once

#include <array>
#include <memory>

#include "core/image.h"
#include "gl/handles.h"
#include "gl/timer.h"

namespace livery {

/// Lives in one thread with its context. What it lends may be given back in any thread, during its
/// life or after it; what is still out when it ends becomes empty then.
class TexturePool {
  public:
    explicit TexturePool(TexelFormat format);
    ~TexturePool();
    TexturePool(const TexturePool&) = delete;
    TexturePool& operator=(const TexturePool&) = delete;

    struct Slot {
        Texture2D texture;
        Framebuffer framebuffer;
        Fence ready;
    };
    /// One of this size that nobody reads; it comes back with the last copy of the pointer.
    std::shared_ptr<Slot> lend(int width, int height);
    int made() const { return made_; }  ///< textures so far

  private:
    struct Shared;
    TexelFormat format_;
    int made_ = 0;
    std::shared_ptr<Shared> shared_;
};

/// In memory, in a texture of the share group, or both; neither: there is none.
template <typename T>
struct FramePicture {
    std::shared_ptr<const T> image;
    std::shared_ptr<const TexturePool::Slot> slot;

    bool operator==(const FramePicture&) const = default;
    explicit operator bool() const { return image || slot; }
};

/// Immutable; one value stands for one picture on the mock-up.
struct FramePictures {
    FramePicture<Image8> drive;                    ///< always has a texture, RGBA8
    std::array<FramePicture<ImageF>, 2> radiance;  ///< working space; the second: right of `column`
    int column = 0;                                ///< of a wipe
};

/// Projector input, 3 channels. Where it is a texture only, a context of the share group must be
/// current, and this waits for OpenGL; throws std::invalid_argument when the frame thread has
/// ended.
std::shared_ptr<const Image8> drive_of(const FramePictures& pictures);

/// What is wanted: R, G, B, coverage. The same holds.
std::shared_ptr<const ImageF> radiance_of(const FramePictures& pictures);

/// `left` with the columns from `column` on of `right`, which has the same size.
template <typename T>
void join_columns(const Image<T>& left, const Image<T>& right, int column, Image<T>* joined);

extern template void join_columns(const Image8&, const Image8&, int, Image8*);
extern template void join_columns(const ImageF&, const ImageF&, int, ImageF*);

}  // namespace livery
