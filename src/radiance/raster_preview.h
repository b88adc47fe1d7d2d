// What moves: the mesh rasterised from any view, for orbiting and nudging. Same scene in, same
// picture out as RadianceRenderer, with light and openness solved at the vertices.
#pragma once

#include <memory>
#include <optional>

#include "core/image.h"
#include "core/progress.h"
#include "radiance/light/vertex_light.h"
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

    void set_supersampling(int supersampling);

    /// Glints are counted in this view's pixels, as the projector shows them; without one in those
    /// of the view that is drawn.
    void set_glint_view(const std::optional<View>& projector);

    /// Solves what light changed, then draws.
    void render(const Scene& scene, const View& view, const Progress& progress = {});

    /// For those who solve light elsewhere: takes a solved one, and draws with the newest taken,
    /// whatever the scene says. Its lights shine as brightly as the scene's where they are the
    /// same. Throws std::invalid_argument when none was taken, or for another product.
    void take(std::shared_ptr<const VertexLight> light);
    void draw(const Scene& scene, const View& view);

    ImageF read_back() const;  ///< as RadianceRenderer::read_back
    unsigned texture() const;  ///< RGBA16F of the view's size

    /// One part in the last picture, RGBA8 of the view's size: R is its share of what is covered
    /// of a pixel, A how much that is.
    unsigned draw_part_coverage(std::size_t part);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
