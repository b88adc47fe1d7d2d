// Car paint fitted to the paints of three sets of measurements: how near it comes.
//
// LIVERY_THOROUGH=1 takes every paint instead of the first of each list: five minutes of one
// core.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/everywhere.h"
#include "appearance/fit/fit_brdf.h"
#include "appearance/measured/measured_reflectance.h"
#include "core/colour.h"
#include "core/random.h"
#include "core/worst_error.h"
#include "support/merl_fits.h"
#include "support/reference_data.h"
#include "support/thorough.h"

namespace livery {
namespace {

const std::vector<std::string> kEffectPaints{"color-changing-paint2",
                                             "silver-paint",
                                             "blue-metallic-paint",
                                             "blue-metallic-paint2",
                                             "color-changing-paint1",
                                             "color-changing-paint3",
                                             "gold-metallic-paint",
                                             "gold-metallic-paint2",
                                             "gold-metallic-paint3",
                                             "gold-paint",
                                             "green-metallic-paint",
                                             "green-metallic-paint2",
                                             "pearl-paint",
                                             "red-metallic-paint",
                                             "silver-metallic-paint",
                                             "silver-metallic-paint2",
                                             "two-layer-gold",
                                             "two-layer-silver"};

// Two of them from the other set of tables: the first has them with a lobe of another width for
// each channel, which no coat has.
const std::vector<std::string> kSolidPaints{
    "dark-blue-paint", "dark-red-paint", "light-red-paint", "purple-paint", "yellow-paint"};
const std::vector<std::string> kSolidPaintsOfTheOtherSet{"orange-paint", "white-paint"};

void print(const std::string& name, const BrdfFit& fit) {
    std::printf("    %-24s CIEDE2000 %.2f, 95%% %.1f, log error %.3f, albedo %.2f, %.1f s\n",
                name.c_str(),
                fit.difference.de00_mean,
                fit.difference.de00_p95,
                fit.error_log,
                fit.largest_albedo,
                fit.seconds);
}

template <typename Table>
BrdfFit fit_of(const Table& table) {
    const ReflectanceFunction truth = [&](const glm::dvec3& wi, const glm::dvec3& wo) {
        return working_from_rec709() * evaluate(table, wi, wo);
    };
    const BrdfFit fit =
        fit_model(ReflectanceModel::car_paint, fit_samples(truth, everywhere), truth);
    print(table.name, fit);
    return fit;
}

BrdfFit fit_of_file(const std::filesystem::path& file) {
    const MeasuredReflectance measured = read_measured_file(file);
    const ReflectanceFunction truth = [&](const glm::dvec3& wi, const glm::dvec3& wo) {
        return evaluate(measured, wi, wo);
    };
    const FitSamples samples = fit_samples(
        truth, [&](const DirectionPair& pair) { return is_measured(measured, pair.wi, pair.wo); });
    const BrdfFit fit = fit_model(ReflectanceModel::car_paint, samples, truth);
    print(file.stem().string(), fit);
    return fit;
}

TEST(FitCarPaint, GivesBackThePaintThatMadeTheSamples) {
    Material paint;
    paint.model = ReflectanceModel::car_paint;
    paint.diffuse = {0.02, 0.04, 0.15};
    paint.f0 = {0.1, 0.15, 0.2};
    paint.alpha = glm::dvec2(0.07);
    paint.flake_f0 = {0.05, 0.2, 0.4};
    paint.flake_alpha = 0.25;
    paint.coat_alpha = 0.015;
    const f64::BsdfParameters p = parameters_of_f64(paint);
    const ReflectanceFunction truth = [&](const glm::dvec3& wi, const glm::dvec3& wo) {
        return evaluate(paint.model, p, wi, wo);
    };
    FitSamples samples = fit_samples(truth, everywhere);
    Random random(9);
    for (glm::dvec3& value : samples.values_working) {
        for (int c = 0; c < 3; ++c) value[c] *= std::exp(0.02 * random.normal());
    }
    const BrdfFit fit = fit_model(paint.model, samples, truth);
    EXPECT_NEAR(fit.error_log, 0.02, 0.006);
    EXPECT_LT(fit.difference.de00_mean, 0.2);
    // Which lobe is the first is nobody's to say.
    const auto [narrow, wide] = std::minmax(fit.material.alpha.x, fit.material.flake_alpha);
    EXPECT_NEAR(narrow / 0.07, 1.0, 0.06);
    EXPECT_NEAR(wide / 0.25, 1.0, 0.06);
    EXPECT_NEAR(fit.material.coat_alpha / 0.015, 1.0, 0.06);
    EXPECT_NEAR(fit.material.coat_f0 / 0.04, 1.0, 0.06);
}

// Colours of a film repeat with its thickness, so it is found among many or not at all. The model's
// own film, through noise of 2%: what is left is the noise's.
TEST(FitCarPaint, NightlyFindsTheFilmThatMadeTheColours) {
    std::vector<std::pair<double, double>> films{{180.0, 2.3}};
    if (thorough()) films.emplace_back(420.0, 1.8);
    for (const auto& [nm, eta] : films) {
        Material paint;
        paint.model = ReflectanceModel::car_paint;
        paint.diffuse = {0.02, 0.02, 0.03};
        paint.f0 = glm::dvec3(0.03);
        paint.alpha = glm::dvec2(0.3);
        paint.flake_f0 = glm::dvec3(0.12);
        paint.flake_alpha = 0.12;
        paint.film_nm = nm;
        paint.film_eta = eta;
        const f64::BsdfParameters p = parameters_of_f64(paint);
        const ReflectanceFunction truth = [&](const glm::dvec3& wi, const glm::dvec3& wo) {
            return evaluate(paint.model, p, wi, wo);
        };
        FitSamples samples = fit_samples(truth, everywhere, {60, 16, 16});
        Random random(9);
        for (glm::dvec3& value : samples.values_working) {
            for (int c = 0; c < 3; ++c) value[c] *= std::exp(0.02 * random.normal());
        }
        const BrdfFit fit = fit_model(paint.model, samples, truth);
        print(fmt::format("{:.0f} nm of {:.1f}", fit.material.film_nm, fit.material.film_eta), fit);
        EXPECT_NEAR(fit.material.film_nm * fit.material.film_eta / (nm * eta), 1.0, 0.06);
        EXPECT_LT(fit.difference.de00_mean, 0.5);
    }
}

TEST(FitCarPaint, NightlyComesNearEffectPaints) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto tables = read_sgd_fits(data / "materials/sgd_bagher2012_merl.csv");
    std::vector<double> differences;
    for (const std::string& name : chosen(kEffectPaints, 1)) {
        const BrdfFit fit = fit_of(fit_named(tables, name));
        EXPECT_LE(fit.difference.de00_mean, 2.5) << name;
        EXPECT_LE(fit.largest_albedo, 1.0 + 1e-4) << name;
        differences.push_back(worst_if_nan(fit.difference.de00_mean));
    }
    std::sort(differences.begin(), differences.end());
    EXPECT_LE(differences[differences.size() / 2], 1.2);
}

TEST(FitCarPaint, NightlyComesNearSolidPaints) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto tables = read_sgd_fits(data / "materials/sgd_bagher2012_merl.csv");
    const auto others = read_abc_fits(data / "materials/abc_low2012_merl.csv");
    for (const std::string& name : chosen(kSolidPaints, 1)) {
        EXPECT_LE(fit_of(fit_named(tables, name)).difference.de00_mean, 1.5) << name;
    }
    for (const std::string& name : chosen(kSolidPaintsOfTheOtherSet, 0)) {
        EXPECT_LE(fit_of(fit_named(others, name)).difference.de00_mean, 1.5) << name;
    }
}

// Its samples differ by 23% with light and eye exchanged (docs/materials.md), which no such model
// does.
TEST(FitCarPaint, NightlyMeasuredMetallicPaint) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    EXPECT_LE(fit_of_file(data / "paint" / "cayman.brdf").difference.de00_mean, 3.5);
}

}  // namespace
}  // namespace livery
