// The simulated stand on which a painted sphere is photographed, one lamp at a time.
#pragma once

#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "appearance/material.h"
#include "core/image.h"
#include "core/progress.h"
#include "twin/description.h"

namespace livery {

/// World: millimetres, the sphere's middle at the origin, the camera on +z, y up.
struct SphereStand {
    CameraDescription camera;  ///< its lens and noise; its spectra are not used
    /// Camera colours of light in the working space: this camera tells colours as an observer does,
    /// in primaries and with a white balance of its own.
    glm::dmat3 camera_from_working{1.0};
    double diameter_mm = 60.0;
    std::vector<glm::dvec3> lamps_mm;
    double lamp_diameter_mm = 4.0;
    /// What green reads each second off a white diffuser that faces a lamp 600 mm away.
    double units_per_s = 20'000.0;
    double cloth_reflectance = 0.004;
    double cloth_behind_mm = 800.0;
};

/// A camera a metre away whose picture the sphere fills to two thirds, with the noise, flare and
/// encoding of `camera`; 28 lamps 600 mm from the sphere, 4 to 158 degrees from the camera's
/// direction, each turned around it by the golden angle.
SphereStand usual_sphere_stand(const CameraDescription& camera, int width, int height);

/// The light that the camera sees of a sphere of that paint under a lamp, file units a second.
ImageF sphere_light(const SphereStand& stand,
                    const Material& paint,
                    const glm::dvec3& lamp_mm,
                    const Progress& progress = {});

}  // namespace livery
