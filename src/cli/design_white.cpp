#include "cli/design_white.h"

#include <utility>

#include <fmt/format.h>

#include "compensation/compensation.h"

namespace livery {

DesignWhite design_white_of(const ColourCalibration& calibration,
                            double percentile,
                            const Image8& counted,
                            std::string mask) {
    DesignWhite white{
        design_white_luminance(calibration, percentile, counted), percentile, std::move(mask), 0};
    for (std::size_t i = 0; i < calibration.status.values.size(); ++i) {
        const bool valid = is_valid(static_cast<PixelStatus>(calibration.status.values[i]));
        white.pixels += valid && (counted.empty() || counted.values[i] != 0);
    }
    return white;
}

std::string text_of(const DesignWhite& white) {
    return fmt::format("design white {:.4g}, the {:g}th percentile of {} pixels: {}",
                       white.y,
                       white.percentile,
                       white.pixels,
                       white.mask);
}

void tell(const DesignWhite& white, Outcome& outcome) {
    outcome.figures["design_white_y"] = white.y;
    outcome.figures["design_white_mask"] = white.mask;
    outcome.figures["design_white_pixels"] = white.pixels;
}

}  // namespace livery
