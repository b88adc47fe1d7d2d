// Materials and directions that several tests of reflectance share.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/hard_cases.h"
#include "appearance/model_table.h"
#include "core/random.h"

namespace livery {

inline std::vector<ReflectanceModel> all_models() {
    std::vector<ReflectanceModel> models;
    for (const ModelInfo& model : formula_models()) models.push_back(model.model);
    return models;
}

/// For the names of parametrised tests.
inline std::string prefix_of(const ::testing::TestParamInfo<ReflectanceModel>& info) {
    return model_info(info.param).prefix;
}

/// Slope parameters and exponents alike.
inline void set_slopes(f64::BsdfParameters& p, double along, double across) {
    p.alpha_x = along;
    p.alpha_y = across;
    p.exponent_x = exponent_of(along);
    p.exponent_y = exponent_of(across);
}

inline f64::BsdfParameters plain_parameters() {
    f64::BsdfParameters p{};
    p.specular = glm::dvec3(0.04);
    p.diffuse_roughness = 0.5;
    p.diffuse = glm::dvec3(0.0);
    p.f0 = glm::dvec3(0.04);
    set_slopes(p, 0.3, 0.3);
    p.flake_f0 = glm::dvec3(0.2);
    p.flake_alpha = 0.15;
    p.coat_alpha = 0.02;
    p.coat_f0 = 0.04;
    p.coat_transmittance = glm::dvec3(1.0);
    return p;
}

inline glm::dvec3 direction(double mu, double phi) {
    const double s = std::sqrt(std::max(0.0, (1.0 - mu) * (1.0 + mu)));
    return {s * std::cos(phi), s * std::sin(phi), mu};
}

/// Above the horizon, up to 89.99 degrees, half of them uniform in the cosine, half close to
/// grazing.
inline glm::dvec3 random_direction(Random& random) {
    constexpr double kLowest = 1.745e-4;
    const double u = random.uniform();
    const double mu = random.uniform() < 0.5 ? kLowest + (1.0 - kLowest) * u : std::pow(kLowest, u);
    return direction(mu, 2.0 * std::numbers::pi * random.uniform());
}

/// A second direction: often near the mirror direction, within a few alpha, where the lobe is.
inline glm::dvec3 random_partner(Random& random, const glm::dvec3& wo, double alpha) {
    if (random.uniform() < 0.3) return random_direction(random);
    const double width = 3.0 * alpha;
    const glm::dvec3 h =
        glm::normalize(glm::dvec3(width * random.normal(), width * random.normal(), 1.0));
    const glm::dvec3 wi = h * (2.0 * glm::dot(wo, h)) - wo;
    return wi.z > 1.745e-4 ? wi : random_direction(random);
}

}  // namespace livery
