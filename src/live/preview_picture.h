// Pictures of the preview: its radiance as an sRGB texture with the product's shadow on the ground,
// and swatches, a paint on a sphere in the studio's light or on a lit disc.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "appearance/material.h"
#include "core/image.h"
#include "gl/draw.h"
#include "gl/program.h"
#include "radiance/light/vertex_light.h"
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

inline constexpr int kSmallestSwatch_px = 8, kLargestSwatch_px = 1024;

/// The sphere and the light that all swatches share, solved at its vertices.
struct SwatchStudio {
    std::shared_ptr<const Product> product;
    std::vector<DirectionalLight> lights;
    double exposure_ev = 0.0;
    std::shared_ptr<const VertexLight> light;
};
/// On the processor, any thread. Throws FileError.
SwatchStudio make_swatch_studio(const Progress& progress = {});

/// Needs a current OpenGL context, the same for its whole life.
class SwatchPainter {
  public:
    explicit SwatchPainter(const SwatchStudio& studio);
    ~SwatchPainter();
    SwatchPainter(const SwatchPainter&) = delete;
    SwatchPainter& operator=(const SwatchPainter&) = delete;

    /// sRGB with coverage in a straight alpha, square.
    Image8 paint(const Material& material, int size_px);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Where a swatch is kept: named by what decides how it looks.
std::filesystem::path swatch_file(const Material& material, int size_px);

/// Nothing when there is none, or one that is no swatch of this size (a damaged file).
std::optional<Image8> kept_swatch(const Material& material, int size_px);

/// False where the user's folder cannot be written: then it is drawn again the next time.
bool keep_swatch(const Material& material, const Image8& swatch);

inline constexpr double kThinnestWedge_mm = 0.5, kThickestWedge_mm = 30.0;  ///< of the product

/// sRGB with coverage in a straight alpha, square. From left to right the thickness grows in equal
/// ratios; light of 1 comes from behind and of a third from the front, both even, and what a slab
/// as thick lets through and returns is exact (exact_totals.h). On the processor, some 0.1 s.
/// Throws std::invalid_argument for another paint.
Image8 translucent_swatch(const Material& translucent, int size_px);

}  // namespace livery
