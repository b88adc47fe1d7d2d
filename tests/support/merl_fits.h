// The hundred materials of the MERL database by the two sets of fits that people published:
// stand-ins for its tables, which are another's to give. LIVERY_REFERENCE_DATA has the numbers in
// `materials`.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/measured/measured_samples.h"

namespace livery {

/// Shifted gamma distribution: Bagher, Soler and Holzschuch, "Accurate fitting of measured
/// reflectances using a shifted gamma micro-facet distribution" (2012). All by channel.
struct SgdFit {
    std::string name;
    glm::dvec3 diffuse{0.0}, specular{0.0};               ///< Kd, Ks
    glm::dvec3 alpha{0.0}, p{0.0}, kappa{0.0};            ///< of the distribution
    glm::dvec3 f0{0.0}, f1{0.0};                          ///< of the Fresnel term
    glm::dvec3 lambda{0.0}, c{0.0}, k{0.0}, theta0{0.0};  ///< of the masking
};

/// Low, Kronander, Ynnerman and Unger, "BRDF models for accurate and efficient rendering of glossy
/// surfaces" (2012), the microfacet form.
struct AbcFit {
    std::string name;
    glm::dvec3 diffuse{0.0}, a{0.0};
    double b = 0.0, c = 0.0, index = 1.5;
};

/// Throw FileError.
std::vector<SgdFit> read_sgd_fits(const std::filesystem::path& csv);
std::vector<AbcFit> read_abc_fits(const std::filesystem::path& csv);

/// In linear Rec.709 as the database's, per steradian, 0 below the horizon.
glm::dvec3 evaluate(const SgdFit& fit, glm::dvec3 wi, glm::dvec3 wo);
glm::dvec3 evaluate(const AbcFit& fit, glm::dvec3 wi, glm::dvec3 wo);

/// The one of that name. Throws std::invalid_argument.
template <typename Fit>
const Fit& fit_named(const std::vector<Fit>& fits, std::string_view name) {
    for (const Fit& fit : fits) {
        if (fit.name == name) return fit;
    }
    throw std::invalid_argument("no material '" + std::string(name) + "'");
}

/// As a file of measurements would have them: `theta_h` by `theta_d` by `phi_d` pairs of directions
/// even on the axes of a MERL table, those up to 80 degrees from the normal.
template <typename Fit>
MeasuredSamples samples_of(const Fit& fit, int theta_h = 90, int theta_d = 24, int phi_d = 24);

}  // namespace livery
