// The last step of a picture: into a window, the right way up.
#pragma once

#include <glm/vec2.hpp>

#include "gl/handles.h"

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

}  // namespace livery
