// Reflectance in the plane of light and normal, drawn as a polar plot.
#pragma once

#include <vector>

#include "appearance/lobe_curve.h"

namespace livery {

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
