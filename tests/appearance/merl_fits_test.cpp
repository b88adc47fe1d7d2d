// The fits of MERL's materials that stand in for its tables: plausible by themselves, and against
// each other, for both were made from the same measurements by different people.
#include "support/merl_fits.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/measured/measured_reflectance.h"
#include "appearance/models.h"
#include "core/colour.h"
#include "core/worst_error.h"
#include "support/reference_data.h"

namespace livery {
namespace {

double luminance(const glm::dvec3& rec709) { return (xyz_from_rec709() * rec709).y; }

template <typename Fit>
glm::dvec3 albedo(const Fit& fit, double mu) {
    const glm::dvec3 wo = direction(mu, 0.0);
    glm::dvec3 sum(0.0);
    for (const auto& [wi, weight] : directions_by_half_vector(wo, 200)) {
        sum += weight * evaluate(fit, wi, wo);
    }
    return sum;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0.0 : values[values.size() / 2];
}

/// Between these two fits, over directions up to 70 degrees: median relative difference of
/// luminance.
double disagreement(const SgdFit& sgd, const AbcFit& abc) {
    Random random(4);
    std::vector<double> relative;
    for (int k = 0; k < 1000; ++k) {
        const glm::dvec3 wo = direction(0.34 + 0.66 * random.uniform(), 0.0);
        const glm::dvec3 wi = direction(0.34 + 0.66 * random.uniform(), 6.3 * random.uniform());
        const double a = luminance(evaluate(sgd, wi, wo));
        const double b = luminance(evaluate(abc, wi, wo));
        relative.push_back(worst_if_nan(2.0 * std::abs(a - b) / (a + b)));
    }
    return median(relative);
}

template <typename Fit>
void expect_plausible(const std::vector<Fit>& fits, const char* what) {
    ASSERT_EQ(fits.size(), 100u);
    Random random(6);
    int brighter = 0, negative = 0;
    double largest = 0.0;
    for (const Fit& fit : fits) {
        for (int k = 0; k < 500; ++k) {
            const glm::dvec3 wo = direction(0.17 + 0.83 * random.uniform(), 6.3 * random.uniform());
            const glm::dvec3 wi = random_partner(random, wo, 0.05);
            const glm::dvec3 value = evaluate(fit, wi, wo);
            const glm::dvec3 swapped = evaluate(fit, wo, wi);
            for (int c = 0; c < 3; ++c) {
                ASSERT_TRUE(std::isfinite(value[c])) << fit.name;
                EXPECT_NEAR(value[c], swapped[c], 1e-9 * std::abs(value[c])) << fit.name;
                negative += value[c] < 0.0;
            }
        }
        for (const double mu : {0.5, 0.8, 1.0}) {
            const double share = luminance(albedo(fit, mu));
            EXPECT_GT(share, 0.005) << fit.name;
            EXPECT_LT(share, 1.5) << fit.name << " at " << mu;
            largest = worse_of(largest, share);
            brighter += share > 1.0;
        }
    }
    std::printf("%s: %d of 300 albedos above 1, largest %.3f; %d of 150000 values negative\n",
                what,
                brighter,
                largest,
                negative);
    EXPECT_LT(brighter, 15);
    EXPECT_LT(negative, 1500);
}

TEST(MerlFits, AreReflectance) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    expect_plausible(read_sgd_fits(data / "materials/sgd_bagher2012_merl.csv"), "SGD");
    expect_plausible(read_abc_fits(data / "materials/abc_low2012_merl.csv"), "ABC");
}

TEST(MerlFits, AgreeWithEachOther) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto sgd = read_sgd_fits(data / "materials/sgd_bagher2012_merl.csv");
    const auto abc = read_abc_fits(data / "materials/abc_low2012_merl.csv");
    std::vector<double> all, albedos;
    std::string worst;
    double most = 0.0;
    for (const SgdFit& fit : sgd) {
        const AbcFit& other = fit_named(abc, fit.name);
        all.push_back(disagreement(fit, other));
        const double a = luminance(albedo(fit, 0.8)), b = luminance(albedo(other, 0.8));
        albedos.push_back(worst_if_nan(2.0 * std::abs(a - b) / (a + b)));
        if (all.back() > most) {
            most = all.back();
            worst = fit.name;
        }
    }
    std::printf("SGD against ABC: median %.3f of values, %.3f of albedos; most %.2f, %s\n",
                median(all),
                median(albedos),
                most,
                worst.c_str());
    EXPECT_LT(median(all), 0.2);
    EXPECT_LT(median(albedos), 0.2);
}

TEST(MerlFits, HaveTheColoursOfTheirNames) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto fits = read_sgd_fits(data / "materials/sgd_bagher2012_merl.csv");
    const auto face = [&](const char* name) {
        const glm::dvec3 value = evaluate(fit_named(fits, name),
                                          direction(std::cos(std::numbers::pi / 4.0), 0.0),
                                          {0.0, 0.0, 1.0});
        return lab_from_xyz(xyz_from_rec709() * (std::numbers::pi * value), d65_xyz());
    };
    EXPECT_GT(face("red-plastic").y, 20.0);
    EXPECT_LT(face("green-plastic").y, -10.0);
    EXPECT_GT(face("yellow-paint").z, 30.0);
    EXPECT_LT(face("blue-fabric").z, -10.0);
    EXPECT_GT(face("white-paint").x, 60.0);  // the database has it at 36%
    EXPECT_LT(face("black-phenolic").x, 15.0);
    EXPECT_THROW(fit_named(fits, "unobtainium"), std::invalid_argument);
}

TEST(MerlFits, GiveSamplesLikeAMeasurement) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto fits = read_sgd_fits(data / "materials/sgd_bagher2012_merl.csv");
    const SgdFit& paint = fit_named(fits, "blue-metallic-paint");
    const MeasuredSamples samples = samples_of(paint, 30, 12, 12);
    EXPECT_GT(samples.pairs.size(), 1000u);
    EXPECT_EQ(samples.values.size(), 3 * samples.pairs.size());
    const auto measured = measured_from(samples, MeasuredFormat::csv, "blue-metallic-paint");
    Random random(8);
    std::vector<double> relative;
    for (int k = 0; k < 2000; ++k) {
        const glm::dvec3 wo = direction(0.3 + 0.7 * random.uniform(), 0.0);
        const glm::dvec3 wi = direction(0.3 + 0.7 * random.uniform(), 6.3 * random.uniform());
        const double truth = luminance(evaluate(paint, wi, wo));
        const double value = luminance(rec709_from_working() * evaluate(measured, wi, wo));
        relative.push_back(std::abs(value / truth - 1.0));
    }
    EXPECT_LT(median(relative), 0.02);
}

}  // namespace
}  // namespace livery
