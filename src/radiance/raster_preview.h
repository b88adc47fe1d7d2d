// What moves: the mesh rasterised from any view, for orbiting and nudging. Same scene in, same
// picture out as RadianceRenderer, with light and openness solved at the vertices.
#pragma once

#include <memory>

#include "core/image.h"
#include "core/progress.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

/// Needs a current OpenGL context, the same for its whole life. A new view costs one draw; a light
/// or an environment is solved at the vertices when it changes.
class RasterPreview {
  public:
    /// `supersampling` squared samples a pixel (1 to 4).
    explicit RasterPreview(std::shared_ptr<const Product> product, int supersampling = 2);
    ~RasterPreview();
    RasterPreview(const RasterPreview&) = delete;
    RasterPreview& operator=(const RasterPreview&) = delete;

    void render(const Scene& scene, const View& view, const Progress& progress = {});
    ImageF read_back() const;  ///< as RadianceRenderer::read_back
    unsigned texture() const;  ///< RGBA16F of the view's size

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
