// Fitting gives back parameters that are known, through noise, and is good enough on paints that
// were measured.
#include "appearance/fit/fit_brdf.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/everywhere.h"
#include "appearance/fit/fit_search.h"
#include "appearance/measured/measured_reflectance.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/random.h"
#include "support/merl_fits.h"
#include "support/reference_data.h"

namespace livery {
namespace {

/// A model's own values, with noise of 2% on each channel.
FitSamples noisy_samples(const Material& material, unsigned seed) {
    const f64::BsdfParameters p = parameters_of_f64(material);
    Random random(seed);
    FitSamples samples =
        fit_samples([&](const glm::dvec3& wi,
                        const glm::dvec3& wo) { return evaluate(material.model, p, wi, wo); },
                    everywhere);
    for (glm::dvec3& value : samples.values_working) {
        for (int c = 0; c < 3; ++c) value[c] *= std::exp(0.02 * random.normal());
    }
    return samples;
}

BrdfFit fit_of(const Material& truth, unsigned seed) {
    const f64::BsdfParameters p = parameters_of_f64(truth);
    return fit_model(
        truth.model, noisy_samples(truth, seed), [&](const glm::dvec3& wi, const glm::dvec3& wo) {
            return evaluate(truth.model, p, wi, wo);
        });
}

// Noise of 2% on ten thousand samples leaves 0.02% of a parameter that all of them show, and a
// hundred times that of one that a hundredth of them shows weakly: 3%, f0 and coat 6%.
TEST(FitBrdf, GivesBackWhatMadeTheSamples) {
    for (const unsigned seed : {1u, 2u}) {
        Material ggx;
        ggx.model = ReflectanceModel::ggx;
        ggx.diffuse = {0.35, 0.08, 0.05};
        ggx.f0 = glm::dvec3(0.05);
        ggx.alpha = glm::dvec2(seed == 1 ? 0.04 : 0.25);
        const BrdfFit fit = fit_of(ggx, seed);
        EXPECT_NEAR(fit.error_log, 0.02, 0.006);
        EXPECT_LT(fit.difference.de00_mean, 0.1);
        EXPECT_NEAR(fit.material.alpha.x / ggx.alpha.x, 1.0, 0.03);
        EXPECT_EQ(fit.material.alpha.x, fit.material.alpha.y);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(fit.material.diffuse[c] / ggx.diffuse[c], 1.0, 0.03) << c;
            EXPECT_NEAR(fit.material.f0[c] / ggx.f0[c], 1.0, 0.06) << c;
        }
    }
    Material coated;
    coated.model = ReflectanceModel::clearcoat;
    coated.diffuse = {0.1, 0.15, 0.4};
    coated.f0 = {0.2, 0.3, 0.5};
    coated.alpha = glm::dvec2(0.2);
    coated.coat_alpha = 0.03;
    coated.coat_f0 = 0.05;
    const BrdfFit fit = fit_of(coated, 3);
    EXPECT_LT(fit.difference.de00_mean, 0.2);
    EXPECT_NEAR(fit.material.alpha.x / 0.2, 1.0, 0.03);
    EXPECT_NEAR(fit.material.coat_alpha / 0.03, 1.0, 0.06);
    EXPECT_NEAR(fit.material.coat_f0 / 0.05, 1.0, 0.06);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(fit.material.f0[c] / coated.f0[c], 1.0, 0.06) << c;
}

TEST(FitBrdf, IsTheSameEveryTime) {
    Material paint;
    paint.model = ReflectanceModel::ggx;
    const BrdfFit one = fit_of(paint, 5), other = fit_of(paint, 5);
    EXPECT_EQ(one.material.alpha, other.material.alpha);
    EXPECT_EQ(one.material.diffuse, other.material.diffuse);
    EXPECT_EQ(one.material.f0, other.material.f0);
}

TEST(FitBrdf, NightlyAllModelsAreRankedAndTheTrueOneIsFound) {
    Material paint;
    paint.model = ReflectanceModel::ggx;
    paint.diffuse = {0.05, 0.3, 0.1};
    paint.f0 = glm::dvec3(0.05);
    paint.alpha = glm::dvec2(0.1);
    const f64::BsdfParameters p = parameters_of_f64(paint);
    const ReflectanceFunction truth = [&](const glm::dvec3& wi, const glm::dvec3& wo) {
        return evaluate(paint.model, p, wi, wo);
    };
    std::vector<double> told;
    Progress progress;
    progress.report = [&](double fraction, std::string_view) { told.push_back(fraction); };
    const auto fits = fit_all_models(fit_samples(truth, everywhere, {24, 8, 8}), truth, progress);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_LT(told.front(), 0.01);
    EXPECT_GT(told.back(), 0.9);
    EXPECT_LE(told.back(), 1.0);
    ASSERT_EQ(fits.size(),
              static_cast<std::size_t>(
                  std::count_if(formula_models().begin(), formula_models().end(), can_be_fitted)));
    for (std::size_t k = 1; k < fits.size(); ++k) {
        EXPECT_LE(weighed_error(fits[k - 1]), weighed_error(fits[k]));
    }
    const auto of = [&](ReflectanceModel model) {
        return *std::find_if(fits.begin(), fits.end(), [&](const BrdfFit& fit) {
            return fit.material.model == model;
        });
    };
    EXPECT_LT(of(ReflectanceModel::ggx).difference.de00_mean, 0.05);
    EXPECT_GT(of(ReflectanceModel::lambert).difference.de00_mean, 2.0);
    // A coat of nothing is no coat: the larger model starts from the smaller one's end.
    EXPECT_LT(of(ReflectanceModel::clearcoat).difference.de00_mean, 0.3);
    for (const BrdfFit& fit : fits) EXPECT_LE(fit.largest_albedo, 1.0 + 1e-3);
}

// What a simpler model found is one of the larger one's ends, but for the six digits of a file.
TEST(FitBrdf, ALargerModelEndsNoWorseThanOneThatItHolds) {
    const ReflectanceFunction truth = [](const glm::dvec3& wi, const glm::dvec3& wo) {
        const glm::dvec3 h = glm::normalize(wi + wo);
        const double lobe = std::pow(h.z, 60.0) + 0.2 * std::pow(h.z, 8.0);
        return glm::dvec3(0.02, 0.05, 0.1) + lobe * glm::dvec3(1.0, 0.7, 0.5);
    };
    const FitSamples samples = fit_samples(truth, everywhere, {30, 10, 10});
    using enum ReflectanceModel;
    for (const auto& [small, large] : {std::pair{lambert, eon},
                                       std::pair{lambert, phong},
                                       std::pair{lambert, ggx},
                                       std::pair{ggx, clearcoat}}) {
        const BrdfFit simpler = fit_model(small, samples, truth);
        const BrdfFit fit = fit_model(large, samples, truth, std::span(&simpler, 1));
        EXPECT_LE(weighed_error(fit), weighed_error(simpler) + 1e-3)
            << model_info(small).name << " in " << model_info(large).name;
    }
}

TEST(FitBrdf, WhiteIsRoundedToWhatAFileMayHold) {
    Material white;
    white.model = ReflectanceModel::ggx;
    white.diffuse = glm::dvec3(1.0);
    const BrdfFit fit = fit_of(white, 4);
    EXPECT_NO_THROW(parameters_of_f64(fit.material));
    EXPECT_GT(fit.material.diffuse.y, 0.97);
}

TEST(FitBrdf, TakesOnlyWhatWasMeasuredUpTo80Degrees) {
    const ReflectanceFunction one = [](const glm::dvec3&, const glm::dvec3&) {
        return glm::dvec3(1.0);
    };
    const FitSamples all = fit_samples(one, everywhere, {10, 6, 6});
    const FitSamples low =
        fit_samples(one, [](const DirectionPair& pair) { return pair.wi.z > 0.5; }, {10, 6, 6});
    EXPECT_GT(low.pairs.size(), 20u);
    EXPECT_LT(low.pairs.size(), all.pairs.size());
    for (const DirectionPair& pair : all.pairs) {
        EXPECT_GE(std::min(pair.wi.z, pair.wo.z), std::cos(80.0 * 3.14159265358979 / 180.0));
        EXPECT_NEAR(glm::length(pair.wi), 1.0, 1e-12);
        EXPECT_NEAR(glm::length(pair.wo), 1.0, 1e-12);
    }
    for (const DirectionPair& pair : low.pairs) EXPECT_GT(pair.wi.z, 0.5);
}

TEST(FitBrdf, RefusesWhatCannotBeFittedAndStopsWhenAsked) {
    Material paint;
    paint.model = ReflectanceModel::ggx;
    const f64::BsdfParameters p = parameters_of_f64(paint);
    const ReflectanceFunction truth = [&](const glm::dvec3& wi, const glm::dvec3& wo) {
        return evaluate(paint.model, p, wi, wo);
    };
    FitSamples samples = fit_samples(truth, everywhere, {12, 6, 6});
    EXPECT_THROW(fit_model(paint.model, {}, truth), std::invalid_argument);
    std::atomic<bool> stop{true};
    Progress stopped;
    stopped.stop = &stop;
    EXPECT_THROW(fit_model(paint.model, samples, truth, {}, stopped), Cancelled);
    samples.values_working[7].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(fit_model(paint.model, samples, truth), std::invalid_argument);
    samples.values_working.pop_back();
    EXPECT_THROW(fit_model(paint.model, samples, truth), std::invalid_argument);
}

/// Enamel: the smallest CIEDE2000 that any model reaches on it.
TEST(FitBrdf, MeasuredSolidPaint) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const MeasuredReflectance measured = read_measured_file(data / "paint" / "krylon_blue.brdf");
    const ReflectanceFunction truth = [&](const glm::dvec3& wi, const glm::dvec3& wo) {
        return evaluate(measured, wi, wo);
    };
    const FitSamples samples = fit_samples(
        truth, [&](const DirectionPair& pair) { return is_measured(measured, pair.wi, pair.wo); });
    const BrdfFit ggx = fit_model(ReflectanceModel::ggx, samples, truth);
    const BrdfFit coated =
        fit_model(ReflectanceModel::clearcoat, samples, truth, std::span(&ggx, 1));
    std::printf(
        "    ggx %.2f, clear coat %.2f\n", ggx.difference.de00_mean, coated.difference.de00_mean);
    EXPECT_LT(std::min(ggx.difference.de00_mean, coated.difference.de00_mean), 1.5);
}

}  // namespace
}  // namespace livery
