// What a paint swap costs over sizes of the projector and of the mock-up in it, on one thread and
// on all: whether it is linear in the mock-up's pixels, and in nothing else.
#pragma once

#include <array>
#include <vector>

#include "core/progress.h"
#include "scene/product.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

/// The stages of a paint swap, and all of it.
enum class SwapStage { shading, mixing, correction, whole };
inline constexpr std::array kSwapStages{
    SwapStage::shading, SwapStage::mixing, SwapStage::correction, SwapStage::whole};
const char* to_string(SwapStage stage);  ///< as tables and plots name it

struct SweepTime {
    double ms = 0.0;  ///< median
    double fastest_ms = 0.0;
};

/// One projector, with the mock-up as large in it as it is, on some threads.
struct SweepPoint {
    int width = 0, height = 0, threads = 0, repeats = 0;
    double coverage = 0.0;          ///< of the picture
    double pixels = 0.0;            ///< that the mock-up covers
    double fragments_shaded = 0.0;  ///< in one swap
    double first_frame_ms = 0.0;    ///< of the pose, at draft quality, on all threads
    std::array<SweepTime, kSwapStages.size()> times;

    const SweepTime& of(SwapStage stage) const { return times[static_cast<std::size_t>(stage)]; }
};

/// Needs a current OpenGL context. `looks` share their light and are swapped in turn; the projector
/// stays where it is and zooms in on the product or out. `quick`: the two smaller sizes only.
std::vector<SweepPoint> run_speed_sweep(const std::shared_ptr<const Product>& product,
                                        const std::vector<Scene>& looks,
                                        const View& projector,
                                        bool quick,
                                        const Progress& progress);

/// The view with another size and its lens zoomed until the product covers a share of the picture,
/// its middle in the picture's.
View zoomed_to_coverage(
    const Product& product, const View& view, int width, int height, double coverage);

/// ms = scale * pixels^slope, by least squares of the logarithms; r2 is the share of their variance
/// that it explains. `typical_ns` is the median cost of a pixel, `spread` the largest over the
/// smallest.
struct PowerLaw {
    double scale = 0.0, slope = 0.0, r2 = 0.0, typical_ns = 0.0, spread = 0.0;
};
PowerLaw fit_power_law(const std::vector<SweepPoint>& sweep, SwapStage stage, int threads);

/// Numbers of threads of the sweep, rising.
std::vector<int> threads_of(const std::vector<SweepPoint>& sweep);

}  // namespace livery
