// A preview's radiance as an sRGB texture, with the ground's shadow and the outline of a part.
#pragma once

#include <map>
#include <optional>
#include <utility>

#include "gl/draw.h"
#include "gl/program.h"
#include "live/ground_shadow.h"
#include "radiance/raster_preview.h"

namespace livery {

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
