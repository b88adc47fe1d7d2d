// How a paint looks, beside its parameters: sphere, lobe, colour at five angles, flop and gloss,
// held against another paint or a measurement.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "appearance/lobe_curve.h"
#include "appearance/measured/measured_grid.h"
#include "appearance/paint_figures.h"
#include "studio/studio.h"

namespace livery {

/// What the background thread works out of a paint.
struct PaintPortrait {
    Material material;
    PaintFigures figures;
    std::vector<LobePoint> curve;
};
/// What of it is asked for; equal when nothing would come out differently.
struct PortraitKey {
    std::vector<double> own, other;  ///< reflectance_numbers(); other empty: none
    double light_rad = 0.0;
    bool operator==(const PortraitKey&) const = default;
};

struct PaintPortraitState {
    double light_deg = 45.0;  ///< from the normal
    bool logarithmic = true;
    std::optional<Material> compared;  ///< what the paint is held against
    std::string search;                ///< in the list to choose that from
    bool working = false;
    PortraitKey asked;
    std::optional<PaintPortrait> own, other;
    std::optional<ReflectanceDifference> difference;  ///< between the two
    std::string problem;
};

/// `material` is what is being edited. Works the figures out in the background; what was there
/// before stays until then.
void draw_paint_portrait(Studio& studio, const Material& material);

}  // namespace livery
