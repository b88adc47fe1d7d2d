// The simulated stands on which a painted sphere is photographed, one lamp at a time, and a mirror
// ball in the light of an environment.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "appearance/material.h"
#include "core/image.h"
#include "core/progress.h"
#include "scene/look.h"
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

/// A metal's complex index of refraction for red, green and blue: n + i k.
struct MetalIndex {
    glm::dvec3 n{1.0}, k{0.0};
};

/// Its reflectance of unpolarised light, exactly (Fresnel).
glm::dvec3 metal_reflectance(const MetalIndex& metal, double cosine);

/// World: millimetres, y up, the ball's middle at the origin.
struct MirrorBallStand {
    std::vector<CameraDescription> cameras;  ///< their lenses and noise; spectra are not used
    /// Camera colours of light in the working space, the same for all cameras.
    glm::dmat3 camera_from_working{1.0};
    double diameter_mm = 80.0;
    std::optional<MetalIndex> metal;  ///< none: every ray is mirrored whole
    double camera_radius_mm = 0.0;    ///< a black ball around the camera in use, mirrored too
    double units_per_s = 20'000.0;    ///< what green reads each second of white of radiance 1
};

/// `count` cameras 800 mm away at the height of the ball, the first on +z, the others turned by 110
/// degrees each; the ball fills three quarters of their pictures. Noise, flare and encoding are
/// those of `camera`.
MirrorBallStand usual_mirror_ball_stand(const CameraDescription& camera, int size_px, int count);

/// Radiance from far away, in the working space, by the unit direction toward it.
using LightFrom = std::function<glm::dvec3(const glm::dvec3& direction)>;
/// What a map says, texel by texel.
LightFrom light_of(const Environment& environment);

/// The light that a camera of the stand sees of the ball and of what is behind it, file units a
/// second. Rays are traced to a mesh of the ball and mirrored there, `samples_a_side` squared a
/// pixel.
ImageF mirror_ball_light(const MirrorBallStand& stand,
                         const CameraDescription& camera,
                         const LightFrom& light_from,
                         int samples_a_side = 6,
                         const Progress& progress = {});

}  // namespace livery
