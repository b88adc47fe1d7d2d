// The same both ways, the same in float and double, and a number for every input.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/models.h"
#include "core/random.h"

namespace livery {
namespace {

f64::BsdfParameters coloured(double alpha) {
    f64::BsdfParameters p = plain_parameters();
    p.diffuse = {0.8, 0.3, 0.05};
    p.f0 = {0.7, 0.25, 0.03};
    p.specular = {0.5, 0.2, 0.1};
    set_slopes(p, alpha, std::min(1.7 * alpha, 1.0));
    p.coat_alpha = alpha;
    p.coat_transmittance = {0.95, 0.7, 0.3};
    return widened(rounded(p));
}

/// Not inlined: GCC 12's vectoriser otherwise drops a rounding to float whose result is widened
/// again at once, and the two precisions would be fed different directions.
[[gnu::noinline]] glm::vec3 rounded_direction(const glm::dvec3& direction) {
    return glm::vec3(direction);
}

class Stability : public testing::TestWithParam<ReflectanceModel> {};

TEST_P(Stability, IsTheSameWithLightAndEyeExchanged) {
    Random random(3);
    for (const double alpha : {1e-3, 0.03, 0.3, 1.0}) {
        const f64::BsdfParameters p = coloured(alpha);
        for (int k = 0; k < 5000; ++k) {
            const glm::dvec3 wo = random_direction(random);
            const glm::dvec3 wi = random_partner(random, wo, alpha);
            const glm::dvec3 there = evaluate(GetParam(), p, wi, wo);
            const glm::dvec3 back = evaluate(GetParam(), p, wo, wi);
            const glm::vec3 there_f =
                evaluate(GetParam(), rounded(p), glm::vec3(wi), glm::vec3(wo));
            const glm::vec3 back_f = evaluate(GetParam(), rounded(p), glm::vec3(wo), glm::vec3(wi));
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(there[c], back[c], 1e-12 * there[c]) << "alpha " << alpha;
                const auto value = static_cast<double>(there_f[c]);
                ASSERT_NEAR(value, static_cast<double>(back_f[c]), 1e-5 * value)
                    << "alpha " << alpha;
            }
        }
    }
}

TEST_P(Stability, FloatFollowsDouble) {
    Random random(5);
    for (const double alpha : {1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0}) {
        const f64::BsdfParameters p = coloured(alpha);
        // Rounding of a narrow lobe's argument is amplified as 1e-7 / alpha.
        const double tolerance = std::max(1e-4, 4e-7 / alpha);
        double worst = 0.0;
        for (int k = 0; k < 20000; ++k) {
            const glm::dvec3 out = random_direction(random);
            const glm::vec3 wo = rounded_direction(out);
            const glm::vec3 wi = rounded_direction(random_partner(random, out, alpha));
            const glm::vec3 narrow = evaluate(GetParam(), rounded(p), wi, wo);
            const glm::dvec3 wide = evaluate(GetParam(), p, glm::dvec3(wi), glm::dvec3(wo));
            for (int c = 0; c < 3; ++c) {
                if (wide[c] <= 1e-6) continue;
                const double error = std::abs(static_cast<double>(narrow[c]) / wide[c] - 1.0);
                worst = std::max(worst, error);
            }
        }
        EXPECT_LE(worst, tolerance) << "alpha " << alpha;
    }
}

std::vector<glm::vec3> adversarial_directions() {
    const float tiny = std::numeric_limits<float>::denorm_min();
    const float least = std::numeric_limits<float>::min();
    std::vector<glm::vec3> directions;
    for (const float z : {0.0f, -0.0f, tiny, least, 1e-30f, 1e-20f, 1e-10f, 1e-7f, 1e-4f, 1e-3f}) {
        directions.push_back({1.0f, 0.0f, z});
        directions.push_back({-1.0f, 0.0f, z});
        directions.push_back({0.0f, 1.0f, z});
        directions.push_back({0.0f, -1.0f, -z});
        directions.push_back({std::sqrt(0.5f), -std::sqrt(0.5f), z});
    }
    directions.push_back({0.0f, 0.0f, 1.0f});
    directions.push_back({0.0f, 0.0f, -1.0f});
    directions.push_back({tiny, -tiny, 1.0f});
    directions.push_back({1e-4f, 0.0f, 1.0f});
    return directions;
}

f32::BsdfParameters random_parameters(Random& random) {
    const auto extreme = [&] {
        const double u = random.uniform();
        return u < 0.25 ? 0.0f : u < 0.5 ? 1.0f : random.uniform_float();
    };
    const auto slope = [&] {
        return std::max(1e-4f, std::pow(10.0f, -4.0f * random.uniform_float()));
    };
    f32::BsdfParameters p;
    for (int c = 0; c < 3; ++c) {
        p.diffuse[c] = extreme();
        p.f0[c] = extreme();
        p.specular[c] = extreme();
        p.coat_transmittance[c] = extreme();
    }
    p.alpha_x = slope();
    p.alpha_y = slope();
    p.exponent_x = std::pow(10.0f, 6.0f * random.uniform_float());
    p.exponent_y = std::pow(10.0f, 6.0f * random.uniform_float());
    p.diffuse_roughness = extreme();
    p.coat_alpha = slope();
    p.coat_f0 = 0.2f * extreme();
    return p;
}

TEST_P(Stability, EveryInputHasAFiniteValueThatIsNotNegative) {
    Random random(11);
    const auto adversarial = adversarial_directions();
    const auto any = [&]() -> glm::vec3 {
        const double u = random.uniform();
        if (u < 0.3)
            return adversarial[random.below(static_cast<std::uint32_t>(adversarial.size()))];
        return glm::vec3(random_direction(random));
    };
    const auto good = [](float value) { return std::isfinite(value) && value >= 0.0f; };
    for (int k = 0; k < 1'000'000; ++k) {
        const f32::BsdfParameters p = random_parameters(random);
        const glm::vec3 wo = any();
        glm::vec3 wi = any();
        if (k % 7 == 0) wi = {-wo.x, -wo.y, wo.z};
        if (k % 11 == 0) wi = wo;
        const glm::vec3 value = evaluate(GetParam(), p, wi, wo);
        const float density = pdf(GetParam(), p, wi, wo);
        ASSERT_TRUE(good(value.x) && good(value.y) && good(value.z) && good(density))
            << "case " << k << " wi " << wi.x << " " << wi.y << " " << wi.z << " wo " << wo.x << " "
            << wo.y << " " << wo.z << " alpha " << p.alpha_x << " " << p.alpha_y << " "
            << p.coat_alpha << " f0 " << p.f0.x << " value " << value.x << " pdf " << density;
        if (wi.z <= 0.0f || wo.z <= 0.0f) {
            ASSERT_EQ(value, glm::vec3(0.0f)) << "below the horizon, case " << k;
            continue;
        }
        if (k % 10 != 0) continue;
        const glm::vec3 u(random.uniform_float(), random.uniform_float(), random.uniform_float());
        const glm::vec3 direction = sample(GetParam(), p, wo, u);
        ASSERT_NEAR(glm::dot(direction, direction), 1.0f, 1e-4f) << "case " << k;
        const f32::BsdfEnvironment e = environment_weights(GetParam(), p, wo.z);
        for (const glm::vec3& part : {e.diffuse, e.specular, e.coat}) {
            ASSERT_TRUE(good(part.x) && part.x <= 1.02f) << "case " << k << " " << part.x;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Models, Stability, testing::ValuesIn(all_models()), prefix_of);

}  // namespace
}  // namespace livery
