// How a paint looks, beside its parameters: sphere, lobe, colour at five angles, flop and gloss,
// held against another paint or a measurement.
#pragma once

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

struct LobePlot {
    const std::vector<LobePoint>* curve = nullptr;     ///< red, green, blue and luminance
    const std::vector<LobePoint>* compared = nullptr;  ///< may be null: luminance, in violet
    bool logarithmic = true;                           ///< the radius; else in proportion
};

/// The radius of a value, 0 to 1, between the plot's middle and its rim.
struct RadialScale {
    double lowest = 1e-3, highest = 1.0;  ///< per steradian; lowest counts for logarithms only
    bool logarithmic = true;
    double radius(double value) const;
};
/// The rim at the power of ten (linear: 1, 2 or 5 times one) above the curves; two to six decades.
RadialScale scale_for(const LobePlot& plot);

/// An item `width` wide and about half as high. Dragging it turns the light: true when
/// `light_deg` has changed. Reads out the value under the pointer.
bool draw_lobe_plot(const LobePlot& plot, double& light_deg, float width);

}  // namespace livery
