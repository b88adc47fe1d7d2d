// The three things that a calibration may ask of the world, real or simulated.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"

namespace livery {

/// One photograph in the camera's own units.
struct Photograph {
    ImageF image;  ///< RGB, file units, before black subtraction
    double exposure_s = 1.0;
    double black_level = 0.0;                                       ///< file units
    double saturates_at = std::numeric_limits<double>::infinity();  ///< file units
    std::string name;  ///< file name or pattern role, for messages
};

/// Linear camera colour per second: (value - black_level) / exposure_s.
inline double linear_from_file_units(const Photograph& photograph, double value) {
    return (value - photograph.black_level) / photograph.exposure_s;
}

/// Shows device values (RGB, 8 bit, the projector's resolution); returns when they are visible.
using ShowPicture = std::function<void(const Image8& drive)>;

/// Photographs what is shown; exposure 0 asks the camera to keep its last exposure.
using TakePhotograph = std::function<Photograph(double exposure_s)>;

/// A colorimeter at the eye point, aimed at the point of the mock-up that projector pixel
/// `pixel_in_projector` lights: absolute XYZ of the light that the mock-up sends to the eye there.
using MeasureXyz = std::function<glm::dvec3(glm::dvec2 pixel_in_projector)>;

struct BenchPorts {
    ShowPicture show;
    TakePhotograph photograph;
    MeasureXyz measure_xyz;  ///< may be empty: no colorimeter at hand
};

}  // namespace livery
