#include "twin/chart.h"

#include "core/paths.h"
#include "core/spectrum.h"
#include "twin/spectra.h"

namespace livery {

ChartPhotograph photograph_chart_under_daylight(const CameraDescription& camera) {
    const SpectrumTable patches =
        read_spectra_csv(shipped_path("calibration/spectra/colorchecker.csv"));
    const Spectrum& daylight = illuminant_d65();
    ChartPhotograph chart;
    for (const Spectrum& reflectance : patches.columns) {
        glm::dvec3 rgb(0.0);
        for (std::size_t k = 0; k < reflectance.size(); ++k) {
            const double light = daylight[k] * reflectance[k];
            for (int c = 0; c < 3; ++c) {
                rgb[c] += light * camera.sensitivities[static_cast<std::size_t>(c)][k];
            }
        }
        chart.camera_rgb.push_back(rgb);
        chart.xyz.push_back(xyz_from_reflectance(reflectance, daylight));
    }
    return chart;
}

}  // namespace livery
