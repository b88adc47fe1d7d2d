// Draw calls with their whole state said at the call: nothing depends on what ran before.
#pragma once

#include <optional>

#include "gl/handles.h"
#include "gl/program.h"

namespace livery {

enum class Blend { none, add, over /**< premultiplied alpha */ };
enum class Primitive { points, triangles, triangle_strip, lines };

struct DrawState {
    Blend blend = Blend::none;
    bool depth_test = false;   ///< nearer passes; and is written
    bool depth_equal = false;  ///< only what lies at the very depth that is there; none is written
    bool cull_back = false;    ///< front faces are counter-clockwise on the picture (rows down)
    std::optional<PixelRect> scissor;  ///< only these pixels
};

/// `count` vertices (or indices) from `first`, into `target`.
void draw(const Program& program,
          const VertexArray& vertices,
          const Framebuffer& target,
          Primitive primitive,
          int first,
          int count,
          const DrawState& state = {},
          int instances = 1);
void draw_indexed(const Program& program,
                  const VertexArray& vertices,
                  const Framebuffer& target,
                  Primitive primitive,
                  int first,
                  int count,
                  const DrawState& state = {},
                  int instances = 1);

/// Runs a screen_pass program over all pixels, or those of a rectangle. One per context.
class ScreenPass {
  public:
    void run(const Program& program, const Framebuffer& target, const DrawState& state = {}) const;

  private:
    VertexArray no_inputs_;
};

/// Hands everything asked for to the device, and does not wait.
void flush_gl();

/// Waits until everything asked for is done.
void finish_gl();

}  // namespace livery
