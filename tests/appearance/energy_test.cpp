// What a surface may do with light: never more out than in, the same both ways, finite always.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/models.h"
#include "core/random.h"

namespace livery {
namespace {

TEST(DirectionalAlbedo, GgxOfAlphaOneAndF0OneAtNormalIncidenceIsOneMinusLogTwo) {
    f64::BsdfParameters p = plain_parameters();
    p.f0 = glm::dvec3(1.0);
    p.alpha_x = p.alpha_y = 1.0;
    const double albedo = directional_albedo(ReflectanceModel::ggx, p, {0.0, 0.0, 1.0}, 400).x;
    // Quadrature of 400 x 400 points: 1e-5 measured when doubling them.
    EXPECT_NEAR(albedo, 1.0 - std::numbers::ln2, 3e-5);
}

TEST(DirectionalAlbedo, NeverExceedsOne) {
    const std::vector<double> alphas = {1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0};
    const std::vector<double> mus = {1e-3, 0.01, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0};
    const std::vector<double> f0s = {0.0, 0.01, 0.04, 0.2, 0.6, 1.0};
    for (const double alpha : alphas) {
        for (const double f0 : f0s) {
            for (const double mu : mus) {
                f64::BsdfParameters p = plain_parameters();
                p.diffuse = glm::dvec3(1.0);
                p.f0 = glm::dvec3(f0);
                p.alpha_x = p.alpha_y = alpha;
                const glm::dvec3 wo = direction(mu, 0.3);
                EXPECT_LE(directional_albedo(ReflectanceModel::ggx, p, wo, 48).x, 1.0 + 1e-4)
                    << "ggx, alpha " << alpha << " f0 " << f0 << " mu " << mu;
                for (const double coat : {0.001, 0.1, 0.6}) {
                    p.coat_alpha = coat;
                    EXPECT_LE(directional_albedo(ReflectanceModel::clearcoat, p, wo, 48).x,
                              1.0 + 1e-4)
                        << "coat " << coat << " on alpha " << alpha << " f0 " << f0 << " mu " << mu;
                }
            }
        }
    }
}

}  // namespace
}  // namespace livery
