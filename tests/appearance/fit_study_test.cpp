// What fitting reaches: the figures of docs/materials.md about measured paints, their halves, and
// lacquers that no model is made for. LIVERY_THOROUGH=1 takes all of them and all models, instead
// of one of each kind and the model that is best of it: ten minutes of one core.
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "appearance/fit/fit_brdf.h"
#include "appearance/measured/measured_reflectance.h"
#include "appearance/model_table.h"
#include "appearance/paint_bsdf.h"
#include "core/random.h"
#include "support/effect_lacquer.h"
#include "support/merl_fits.h"
#include "support/reference_data.h"
#include "support/thorough.h"

namespace livery {
namespace {

ReflectanceFunction value_of(const MeasuredReflectance& measured) {
    return [&](const glm::dvec3& wi, const glm::dvec3& wo) { return evaluate(measured, wi, wo); };
}

FitSamples samples_of(const MeasuredReflectance& measured) {
    return fit_samples(value_of(measured), [&](const DirectionPair& pair) {
        return is_measured(measured, pair.wi, pair.wo);
    });
}

/// The best of all models, or what `likely` comes to; the best three are printed.
BrdfFit best_fit(const std::string& name,
                 const MeasuredReflectance& measured,
                 ReflectanceModel likely = ReflectanceModel::car_paint) {
    const FitSamples samples = samples_of(measured);
    const std::vector<BrdfFit> fits =
        thorough() ? fit_all_models(samples, value_of(measured))
                   : std::vector{fit_model(likely, samples, value_of(measured))};
    double seconds = 0.0;
    for (const BrdfFit& fit : fits) seconds += fit.seconds;
    std::printf("    %-24s", name.c_str());
    for (std::size_t k = 0; k < std::min<std::size_t>(3, fits.size()); ++k) {
        std::printf("  %s %.2f %.1f %.3f",
                    model_info(fits[k].material.model).name,
                    fits[k].difference.de00_mean,
                    fits[k].difference.de00_p95,
                    fits[k].error_log);
    }
    const Material& best = fits.front().material;
    if (best.film_nm > 0.0) std::printf("  film %.0f nm of %.2f", best.film_nm, best.film_eta);
    std::printf("  %.1f s\n", seconds);
    std::fflush(stdout);
    return fits.front();
}

MeasuredSamples chosen_of(const MeasuredSamples& all, const std::vector<bool>& chosen) {
    MeasuredSamples some;
    some.wavelengths_nm = all.wavelengths_nm;
    for (std::size_t k = 0; k < all.pairs.size(); ++k) {
        if (!chosen[k]) continue;
        some.pairs.push_back(all.pairs[k]);
        const auto from = all.values.begin() + static_cast<std::ptrdiff_t>(k * all.channels());
        some.values.insert(
            some.values.end(), from, from + static_cast<std::ptrdiff_t>(all.channels()));
    }
    return some;
}

// The two halves' fits are as far from the half that they have not seen.
TEST(FitStudy, NightlyHalvesOfMeasuredPaints) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const std::string& name :
         chosen<std::string>({"cayman", "garnet_red", "krylon_blue"}, 1)) {
        const auto file = data / "paint" / (name + ".brdf");
        const MeasuredSamples all = read_spectral_samples(file);
        Random random(11);
        std::vector<bool> first;
        for (std::size_t k = 0; k < all.pairs.size(); ++k) first.push_back(random.uniform() < 0.5);
        std::vector<bool> second = first;
        second.flip();
        if (thorough()) {
            best_fit(name, measured_from(all, MeasuredFormat::spectral_text, file));
        }
        const std::array halves{
            measured_from(chosen_of(all, first), MeasuredFormat::spectral_text, file),
            measured_from(chosen_of(all, second), MeasuredFormat::spectral_text, file)};
        for (std::size_t k = 0; k < 2; ++k) {
            const BrdfFit fit = best_fit(fmt::format("{}, half {}", name, k + 1), halves[k]);
            const ReflectanceDifference other =
                difference_of(reflectance_of(fit.material), value_of(halves[1 - k]));
            std::printf("        the other half: %.2f %.1f\n", other.de00_mean, other.de00_p95);
            EXPECT_NEAR(other.de00_mean, fit.difference.de00_mean, 0.3) << name << " " << k;
        }
    }
}

/// At the directions of a real instrument, with 2% of noise.
BrdfFit best_fit(const EffectLacquer& lacquer, const MeasuredSamples& directions) {
    return best_fit(lacquer.name,
                    measured_from(samples_of(lacquer, directions.pairs, 0.02, 5),
                                  MeasuredFormat::spectral_text,
                                  "simulated.brdf"));
}

// What paints that are kept for judging should come to: a mean of 2.5, 8 for 95%.
TEST(FitStudy, NightlyPearls) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const MeasuredSamples directions = read_spectral_samples(data / "paint" / "cayman.brdf");
    const std::vector<EffectLacquer> lacquers{
        EffectLacquer{.name = "pearl 60 nm on blue",
                      .stack = FlakeStack::titania_on_mica,
                      .film_nm = 60.0,
                      .narrow_lean = 0.08,
                      .wide_lean = 0.3,
                      .coverage = 0.7,
                      .pigment = {0.4, 0.1, 0.05}},
        EffectLacquer{.name = "pearl 90 nm",
                      .stack = FlakeStack::titania_on_mica,
                      .film_nm = 90.0,
                      .coverage = 0.6,
                      .pigment = glm::dvec3(0.1)},
        EffectLacquer{
            .name = "pearl 110 nm", .stack = FlakeStack::titania_on_mica, .film_nm = 110.0},
        EffectLacquer{.name = "pearl 130 nm",
                      .stack = FlakeStack::titania_on_mica,
                      .film_nm = 130.0,
                      .wide_share = 0.6},
        EffectLacquer{.name = "pearl 150 nm on red",
                      .stack = FlakeStack::titania_on_mica,
                      .film_nm = 150.0,
                      .narrow_lean = 0.08,
                      .wide_lean = 0.3,
                      .wide_share = 0.5,
                      .coverage = 0.6,
                      .pigment = {0.05, 0.05, 0.4}},
        EffectLacquer{.name = "pearl 200 nm on white",
                      .stack = FlakeStack::titania_on_mica,
                      .film_nm = 200.0,
                      .coverage = 0.5,
                      .pigment = glm::dvec3(0.6)},
    };
    for (const EffectLacquer& lacquer : chosen(lacquers, 1)) {
        const BrdfFit fit = best_fit(lacquer, directions);
        EXPECT_LT(fit.difference.de00_mean, 2.5) << lacquer.name;
        EXPECT_LT(fit.difference.de00_p95, 8.0) << lacquer.name;
    }
}

// Whose colours turn around half of the circle, out of a black that GGX's tails do not leave: never
// without a film, and nearer than the best of them comes without one.
TEST(FitStudy, NightlyColourShifts) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const MeasuredSamples directions = read_spectral_samples(data / "paint" / "cayman.brdf");
    const std::vector<EffectLacquer> lacquers{
        EffectLacquer{.name = "shift 290 nm", .film_nm = 290.0, .pigment = glm::dvec3(0.1)},
        EffectLacquer{.name = "shift 320 nm", .film_nm = 320.0},
        EffectLacquer{.name = "shift 380 nm", .film_nm = 380.0, .wide_lean = 0.3},
        EffectLacquer{.name = "shift 430 nm",
                      .film_nm = 430.0,
                      .narrow_lean = 0.1,
                      .wide_lean = 0.35,
                      .wide_share = 0.5,
                      .coverage = 0.5},
        EffectLacquer{.name = "shift 480 nm", .film_nm = 480.0, .coverage = 0.5},
        EffectLacquer{.name = "shift 520 nm",
                      .film_nm = 520.0,
                      .narrow_lean = 0.05,
                      .wide_lean = 0.2,
                      .wide_share = 0.3,
                      .coverage = 0.9},
    };
    for (const EffectLacquer& lacquer : chosen(lacquers, 1)) {
        const BrdfFit fit = best_fit(lacquer, directions);
        EXPECT_LT(fit.difference.de00_mean, 7.0) << lacquer.name;
        EXPECT_LT(fit.difference.de00_p95, 14.0) << lacquer.name;
        EXPECT_GT(fit.material.film_nm, 0.0) << lacquer.name;
    }
}

// Bright diffuse plastics under a polished surface: the white ones reach a diffuse albedo of 1.
TEST(FitStudy, NightlyAcrylics) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto sgd = read_sgd_fits(data / "materials/sgd_bagher2012_merl.csv");
    const auto abc = read_abc_fits(data / "materials/abc_low2012_merl.csv");
    for (const std::string& name :
         chosen<std::string>({"white-acrylic", "blue-acrylic", "violet-acrylic"}, 1)) {
        for (const MeasuredSamples& samples :
             {samples_of(fit_named(sgd, name)), samples_of(fit_named(abc, name))}) {
            const BrdfFit fit = best_fit(name,
                                         measured_from(samples, MeasuredFormat::csv, name),
                                         ReflectanceModel::cook_torrance);
            EXPECT_LT(fit.difference.de00_mean, 1.5) << name;
        }
    }
}

}  // namespace
}  // namespace livery
