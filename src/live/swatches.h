// Paint swatches: a paint on a sphere in the studio's light, a translucent one as a disc lit from
// behind; drawn once and kept as files.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "appearance/material.h"
#include "core/image.h"
#include "radiance/light/vertex_light.h"

namespace livery {

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
