// A folder of photographs of a painted sphere -> a file of measured reflectance.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/sphere/sphere_reflectance.h"
#include "core/progress.h"

namespace livery {

struct SphereMeasurementRequest {
    std::filesystem::path captures;       ///< a folder (docs/measuring.md)
    std::filesystem::path camera_to_xyz;  ///< empty: what the manifest names, if anything
    std::filesystem::path out;            ///< .csv
};

struct SphereMeasurement {
    SphereReflectance reflectance;
    Sphere manifest_sphere;
    OutlineFit outline;
    std::size_t photographs = 0, lamps = 0, white_photographs = 0;
    double white_rms = 0.0;      ///< of the white sphere's pixels to a matte one's, relative
    double lamp_spread = 0.0;    ///< largest difference of a lamp's response to the mean, relative
    std::string camera_colours;  ///< where the colours come from: "matrix", "assumed Rec.709"
    std::size_t samples = 0;     ///< written
    std::vector<std::string> notes;
};

/// Writes the CSV of docs/files.md. Throws FileError, Refused, std::invalid_argument (a name that
/// does not end in .csv), Cancelled.
SphereMeasurement measure_sphere(const SphereMeasurementRequest& request,
                                 const Progress& progress = {});

}  // namespace livery
