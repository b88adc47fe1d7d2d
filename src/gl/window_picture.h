// The last steps of a picture: faded into the one before, and into a window, the right way up.
#pragma once

#include <glm/vec2.hpp>

#include "gl/draw.h"
#include "gl/handles.h"
#include "gl/program.h"

namespace livery {

/// Copies textures into the current window's framebuffer, turned over once (see gl/handles.h). One
/// per context, with it current from the first use to the end.
class WindowBlit {
  public:
    WindowBlit() = default;
    ~WindowBlit();
    WindowBlit(const WindowBlit&) = delete;
    WindowBlit& operator=(const WindowBlit&) = delete;

    /// The whole texture into `target` (rows down) of a window of `window_px`, black around it.
    /// Pixel for pixel where the sizes are equal, else filtered linearly.
    void show(unsigned texture,
              glm::ivec2 texture_px,
              const PixelRect& target,
              glm::ivec2 window_px);
    void black(glm::ivec2 window_px);

  private:
    unsigned framebuffer_ = 0;
};

/// One per context, with it current from the first use to the end.
class PictureFade {
  public:
    /// An RGBA8 texture with `share` (0 to 1) of the second picture and the rest of the first, both
    /// of that size; good until the next call.
    unsigned between(unsigned from, unsigned to, float share, glm::ivec2 size_px);

  private:
    Program program_;
    ScreenPass pass_;
    Texture2D mixed_;
    Framebuffer target_;
};

}  // namespace livery
