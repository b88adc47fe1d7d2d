// Colour spaces. XYZ is CIE 1931 with Y = 1 for the white in force; RGB is linear unless a name
// says otherwise. White is D65 everywhere, without adaptation.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace livery {

/// XYZ of D65 with Y = 1 (chromaticity .3127, .3290, as Rec.709 and Rec.2020 define it).
glm::dvec3 d65_xyz();

/// XYZ from linear RGB of a space given by its primaries' and white's chromaticities.
glm::dmat3 xyz_from_rgb_matrix(glm::dvec2 red, glm::dvec2 green, glm::dvec2 blue, glm::dvec2 white);

/// Rec.709 stands at file boundaries (signed: paints leave its gamut).
const glm::dmat3& xyz_from_rec709();
const glm::dmat3& rec709_from_xyz();

/// The working space of every radiance inside the program; docs/colour.md says how it was chosen.
const glm::dmat3& xyz_from_working();
const glm::dmat3& working_from_xyz();
const glm::dmat3& working_from_rec709();
const glm::dmat3& rec709_from_working();
/// CIE Y of a colour of the working space.
inline double luminance_of_working(const glm::dvec3& working) {
    return (xyz_from_working() * working).y;
}

/// CIE 1976 L*a*b*; both arguments on the same scale.
glm::dvec3 lab_from_xyz(glm::dvec3 xyz, glm::dvec3 white_xyz);
glm::dvec3 xyz_from_lab(glm::dvec3 lab, glm::dvec3 white_xyz);

/// CIEDE2000 (Sharma, Wu, Dalal 2005), k_L = k_C = k_H = 1.
double ciede2000(glm::dvec3 lab_a, glm::dvec3 lab_b);
/// A vector of that length, each part of which passes 0 smoothly: what least squares can take.
glm::dvec3 ciede2000_vector(glm::dvec3 lab_a, glm::dvec3 lab_b);

/// Oklab (Ottosson 2020) of XYZ relative to D65 with Y = 1.
glm::dvec3 oklab_from_xyz(glm::dvec3 xyz);
glm::dvec3 xyz_from_oklab(glm::dvec3 oklab);
/// Its two matrices: between them stand the cube roots.
const glm::dmat3& oklab_cones_from_xyz();
const glm::dmat3& oklab_from_cone_roots();

/// IEC 61966-2-1 curve, odd around zero so that signed values survive a round trip.
double srgb_encode(double linear);
double srgb_decode(double encoded);

}  // namespace livery
