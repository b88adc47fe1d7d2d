// A frame's pictures, where they were made: fetched from the graphics card only when asked for.
#pragma once

#include <array>
#include <memory>

#include "core/image.h"
#include "live/texture_pool.h"

namespace livery {

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
