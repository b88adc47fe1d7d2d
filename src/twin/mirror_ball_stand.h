// The simulated stand on which a mirror ball is photographed in the light of an environment.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "core/progress.h"
#include "scene/look.h"
#include "twin/description.h"

namespace livery {

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
