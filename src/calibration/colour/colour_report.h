// What a colour calibration tells: planes, residuals, warnings with causes and fixes, refusals.
#pragma once

#include <string>
#include <vector>

#include "calibration/colour/colour_samples.h"
#include "calibration/colour/mixing.h"
#include "calibration/correspondence/gray_code.h"
#include "scene/colour_calibration.h"

namespace livery {

/// "3.4%"
std::string percent(double fraction);

/// Throws Refused when the shots of one picture differ in brightness by more than 1%.
void check_shots(const std::string& role, double spread);
/// `white_over_sum`: luminance-like sum of white over that of red + green + blue.
[[noreturn]] void refuse_not_additive(double error, double white_over_sum);
[[noreturn]] void refuse_invalid(const ColourSamples& samples,
                                 const std::vector<PixelStatus>& status);

/// Equation 9's planes, the status and the map; everything that is not valid stays 0.
void fill_planes(const ColourSamples& samples,
                 const PixelMixing& mixing,
                 const std::vector<PixelStatus>& status,
                 const ProjectorToCamera& map,
                 ColourCalibration& calibration);

/// Residuals and warnings. `response_error`: how far U's ends lie from S and T, or the table's
/// rms error.
void report(const PixelMixing& mixing,
            const std::vector<PixelStatus>& status,
            const PooledMixing& pooled,
            double response_error,
            bool with_table,
            ColourCalibration& calibration);

}  // namespace livery
