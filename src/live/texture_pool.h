// Textures that one thread draws and others show: they come back when nobody holds them.
#pragma once

#include <memory>

#include "gl/fence.h"
#include "gl/handles.h"

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

}  // namespace livery
