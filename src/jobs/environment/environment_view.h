// One camera's photographs of the light all around -> what they say of each direction. For
// environment_measurement.cpp.
#pragma once

#include "capture/environment_folder.h"
#include "jobs/environment/environment_measurement.h"

namespace livery {

struct ViewOfEnvironment {
    EnvironmentView figures;
    RadianceMap map;  ///< in the camera's colours
    double marks_residual_rad = 0.0;
};

/// How photographs become a map, the same for all of a folder's views.
struct EnvironmentReading {
    std::filesystem::path manifest;
    glm::dvec3 reflectance{1.0};
    bool fresnel = true;
    int width = 1024;
};

/// Of a ball. Throws FileError, Refused, Cancelled.
ViewOfEnvironment view_of_ball(const BallView& ball,
                               const EnvironmentReading& reading,
                               const Progress& progress);

/// Of a panorama. Throws FileError, Refused, Cancelled.
ViewOfEnvironment view_of_panorama(const PanoramaPictures& panorama,
                                   const EnvironmentReading& reading,
                                   const Progress& progress);

}  // namespace livery
