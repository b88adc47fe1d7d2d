// From shaded fragments to the projector's picture: the mean over what covers each pixel.
#pragma once

#include "gl/draw.h"
#include "gl/handles.h"
#include "gl/program.h"
#include "radiance/packed_fragments.h"
#include "radiance/surface_map.h"

namespace livery {

/// Draws only the tiles that the product covers.
class ResolvePass {
  public:
    ResolvePass(const SurfaceMap& map, const PackedLayout& layout);

    void run(const Texture2D& shaded_fragments, const Framebuffer& target);
    std::size_t pixels() const { return pixels_; }  ///< that one run touches

  private:
    Program program_;
    Texture2D first_;  ///< of each pixel: one fragment, or where its list begins
    Texture2D lists_;
    Buffer corners_;
    VertexArray vertices_;
    int vertex_count_ = 0;
    std::size_t pixels_ = 0;
};

}  // namespace livery
