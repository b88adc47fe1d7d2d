#include "core/ten_degree.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/colour.h"
#include "core/mutation.h"

namespace livery {

namespace {

/// Of XYZ as shares of white's, row by row: least squares over the 217 reflectances of
/// docs/colour.md, each weighted as L*a*b* weights it, with rows that add up to 1.
const glm::dmat3& shares10_from_shares() {
    static const glm::dmat3 matrix = glm::transpose(
        glm::dmat3(0.8958, 0.0918, 0.0124, -0.0228, 0.9639, 0.0589, 0.0267, -0.0407, 1.0140));
    return matrix;
}

}  // namespace

glm::dvec3 d65_xyz10() {
    static const glm::dvec3 white = [] {
        Spectrum one{};
        one.fill(1.0);
        return xyz10_from_reflectance(one);
    }();
    return white;
}

glm::dvec3 xyz10_from_reflectance(const Spectrum& reflectance) {
    glm::dvec3 xyz(0.0);
    double white_y = 0.0;
    for (std::size_t k = 0; k < reflectance.size(); ++k) {
        const double light = illuminant_d65()[k];
        xyz += light * reflectance[k] * glm::dvec3(cie1964_x()[k], cie1964_y()[k], cie1964_z()[k]);
        white_y += light * cie1964_y()[k];
    }
    return xyz / LIVERY_MUTATED(xyz10_white, white_y);
}

glm::dvec3 xyz10_from_xyz(glm::dvec3 xyz) {
    return shares10_from_shares() * (xyz / d65_xyz()) * d65_xyz10();
}

glm::dvec3 xyz_from_xyz10(glm::dvec3 xyz10) {
    static const glm::dmat3 inverse = glm::inverse(shares10_from_shares());
    return inverse * (xyz10 / d65_xyz10()) * d65_xyz();
}

glm::dvec3 lab10_from_xyz10(glm::dvec3 xyz10) { return lab_from_xyz(xyz10, d65_xyz10()); }

glm::dvec3 xyz10_from_lab10(glm::dvec3 lab10) { return xyz_from_lab(lab10, d65_xyz10()); }

}  // namespace livery
