// A preview's radiance as an sRGB texture, with the shadow of the product on its ground.
#pragma once

#include <map>
#include <optional>
#include <utility>

#include "core/image.h"
#include "gl/draw.h"
#include "gl/program.h"
#include "radiance/raster_preview.h"
#include "scene/product.h"
#include "tracing/tracer.h"

namespace livery {

/// On the plane under the lowest point of the product; independent of lights and views.
struct GroundShadow {
    double height_mm = 0.0;
    glm::dvec2 corner_mm{0.0};  ///< x and z of the picture's first corner
    glm::dvec2 size_mm{1.0};
    Image8 hidden;  ///< one channel, 255: no sky at all; columns along x, rows along z
};
GroundShadow ground_shadow(const Product& product, const Tracer& tracer);

/// Needs a current OpenGL context, the same for its whole life.
class PreviewEncoder {
  public:
    PreviewEncoder() = default;

    void set_ground(const GroundShadow* ground);  ///< null: none

    /// What `preview` drew last, seen through `view`, into an RGBA8 framebuffer of the same size.
    /// The ground is left out where none was set. `only` these pixels; none: all.
    void encode(RasterPreview& preview,
                const View& view,
                std::optional<int> highlighted_part,
                bool with_ground,
                const Framebuffer& into,
                const std::optional<PixelRect>& only = std::nullopt);

  private:
    Program& program_for(bool ground, bool highlight);

    std::map<std::pair<bool, bool>, Program> programs_;
    ScreenPass screen_;
    std::optional<GroundShadow> ground_;
    Texture2D shadow_;
};

}  // namespace livery
