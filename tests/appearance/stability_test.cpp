// The same both ways, the same in float and double, and a number for every input.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/models.h"
#include "core/random.h"

namespace livery {
namespace {

class Stability : public ::testing::TestWithParam<ReflectanceModel> {};

TEST_P(Stability, IsTheSameWithLightAndEyeExchanged) {
    if (!model_info(GetParam()).reciprocal) GTEST_SKIP() << "not claimed";
    Random random(3);
    for (const double alpha : {1e-3, 0.03, 0.3, 1.0}) {
        const f64::BsdfParameters p = ledger_parameters(alpha, 1.7);
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

TEST(RelativeError, IsInfiniteWhereAValueIsNoNumber) {
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    EXPECT_DOUBLE_EQ(relative_error(1.5, 1.0), 0.5);
    EXPECT_DOUBLE_EQ(relative_error(0.5, 1.0), 0.5);
    EXPECT_EQ(relative_error(1e-3, 1e-7), 0.0);  // darker than what is compared
    for (const double truth : {0.0, 1e-7, 1.0, nan}) {
        EXPECT_EQ(relative_error(nan, truth), inf) << truth;
        EXPECT_EQ(relative_error(inf, truth), inf) << truth;
    }
    EXPECT_EQ(relative_error(1.0, nan), inf);
    EXPECT_EQ(relative_error(inf, inf), inf);
}

/// Of values from float-rounded local directions, at every slope parameter.
constexpr double kWorstError = 1e-4;

TEST_P(Stability, FloatFollowsDouble) {
    for (const PrecisionError& row : precision_errors(GetParam(), 10'000, 5)) {
        std::printf("    %-24s alpha %-8.4g value %.2e density %.2e\n",
                    model_info(GetParam()).name,
                    row.alpha,
                    row.float_worst,
                    row.float_density_worst);
        EXPECT_LE(row.float_worst, kWorstError) << "alpha " << row.alpha;
        EXPECT_LE(row.float_density_worst, kWorstError) << "alpha " << row.alpha;
    }
}

/// LIVERY_INPUTS=10000000 asks for as many as the ledger has.
std::size_t inputs_asked_for() {
    const char* text = std::getenv("LIVERY_INPUTS");
    return text ? std::stoul(text) : 500'000;
}

TEST_P(Stability, EveryInputHasAFiniteValueThatIsNotNegative) {
    const InvalidValues result = count_invalid(GetParam(), inputs_asked_for(), 11);
    EXPECT_EQ(result.invalid, 0u) << "of " << result.inputs;
}

TEST_P(Stability, ExtremeSamplesAreUnitAndWeightsOfTheEnvironmentFinite) {
    Random random(13);
    const auto good = [](float value) { return std::isfinite(value) && value >= 0.0f; };
    for (int k = 0; k < 20'000; ++k) {
        const f32::BsdfParameters p = extreme_parameters(random);
        const glm::vec3 wo = extreme_directions(random).wo;
        if (wo.z <= 0.0f) continue;
        const glm::vec3 u(random.uniform_float(), random.uniform_float(), random.uniform_float());
        const glm::vec3 direction = sample(GetParam(), p, wo, u);
        ASSERT_NEAR(glm::dot(direction, direction), 1.0f, 1e-4f) << "case " << k;
        const f32::BsdfEnvironment e = environment_weights(GetParam(), p, wo.z);
        for (const glm::vec3& part : {e.diffuse, e.specular, e.coat}) {
            ASSERT_TRUE(good(part.x) && good(part.y) && good(part.z)) << "case " << k;
            if (model_info(GetParam()).conserves_energy) {
                ASSERT_LE(part.x, 1.03f) << "case " << k;
            }
        }
    }
}

TEST(ParametersOutOfRange, AreRefusedNotANumberIncluded) {
    for (const ParameterInfo& parameter : parameter_table()) {
        // One channel of a colour may leave [0, 1] by a little within the working space.
        const double below = parameter.kind == ParameterKind::colour ? 1.0 : 0.01;
        for (const double bad : {std::nan(""),
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity(),
                                 parameter.low - below,
                                 2.0 * parameter.high}) {
            for (int k = 0; k < parameter.count(); ++k) {
                Material material;
                *parameter.in_material(material)[static_cast<std::size_t>(k)] = bad;
                try {
                    parameters_of(material);
                    ADD_FAILURE() << parameter.name << " " << bad;
                } catch (const std::invalid_argument& error) {
                    EXPECT_NE(std::string(error.what()).find(parameter.name), std::string::npos)
                        << error.what();
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Models, Stability, ::testing::ValuesIn(all_models()), prefix_of);

}  // namespace
}  // namespace livery
