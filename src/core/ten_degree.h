// The colours that paint instruments give: D65 and the CIE 1964 observer, whose field is 10 degrees
// wide. Everything else in the program is the CIE 1931 observer's (colour.h).
#pragma once

#include <glm/vec3.hpp>

#include "core/spectrum.h"

namespace livery {

/// XYZ of D65 for the 10 degree observer, with Y = 1.
glm::dvec3 d65_xyz10();

/// Of a reflectance under D65, exactly.
glm::dvec3 xyz10_from_reflectance(const Spectrum& reflectance);

/// The likely colour for the one observer of a surface known only by what the other sees under D65.
/// Linear, white stays white; surfaces that look alike to one need not to the other
/// (docs/colour.md says how far that goes).
glm::dvec3 xyz10_from_xyz(glm::dvec3 xyz);
glm::dvec3 xyz_from_xyz10(glm::dvec3 xyz10);

/// L*a*b* with D65 as white.
glm::dvec3 lab10_from_xyz10(glm::dvec3 xyz10);
glm::dvec3 xyz10_from_lab10(glm::dvec3 lab10);

}  // namespace livery
