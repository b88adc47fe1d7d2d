// The shading source (shaders/radiance/shade.glsl) in double, one fragment after another: what
// rounding alone makes of a picture is how far the other two, OpenGL and the lanes, are from this.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "appearance/material.h"
#include "radiance/light/mirror_lobes.h"
#include "radiance/light/mirror_quadrature.h"

namespace livery {

/// Fragments that no product has: what shading reads of each, in the layers of ShadingInputs. All
/// lists that are not empty are as long as `eye`, and colours are what half floats hold.
struct LooseFragments {
    std::vector<glm::vec4> eye;
    std::vector<std::vector<glm::vec4>> lights;  ///< of each light
    std::vector<glm::vec3> light_irradiance;     ///< of each light
    std::vector<float> light_radius2;            ///< of each light
    std::vector<glm::vec3> lit;                  ///< what plain diffuse paints read instead
    std::vector<glm::vec3> sky;                  ///< empty: no environment
    std::array<std::vector<glm::vec3>, kMirrorLayers> mirror;
    float mirror_unit = 1.0f;
    MirrorMixing mirror_mixing = MirrorMixing::cubic;
    std::vector<glm::vec4> places;  ///< for glints
    double product_scale = 1.0;

    std::size_t size() const { return eye.size(); }
};

/// Of the numbers that a paint has in float: nothing else is rounded, neither what is taken from
/// them once (PaintUniforms) nor anything after it. Throws std::invalid_argument for parameters out
/// of range.
std::vector<glm::dvec3> shaded_in_double(const Material& material,
                                         const LooseFragments& fragments,
                                         double exposure_ev);

}  // namespace livery
