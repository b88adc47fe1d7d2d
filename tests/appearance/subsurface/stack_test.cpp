// Layers: against one slab, closed forms and photons.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/subsurface/layered_sources.h"
#include "appearance/subsurface/media.h"
#include "appearance/subsurface/model_errors.h"
#include "appearance/subsurface/profile_integrals.h"
#include "appearance/subsurface/single_scattering.h"

namespace livery {
namespace {

using enum SubsurfaceModel;

const ScatteringMedium kMarbleLayer{0.0041, 2.62, 0.0, 1.5, 1.0};
const ScatteringMedium kSkinLayer{0.17, 0.88, 0.0, 1.5, 1.0};

ScatteringMedium with_thickness(ScatteringMedium medium, std::optional<double> thickness_mm) {
    medium.thickness_mm = thickness_mm;
    return medium;
}

/// Two layers that merge into nothing, of next to the same coefficients.
ScatteringStack nearly(const ScatteringMedium& whole, double first_mm) {
    ScatteringMedium above = whole, below = whole;
    above.thickness_mm = first_mm;
    if (whole.thickness_mm) below.thickness_mm = *whole.thickness_mm - first_mm;
    below.sigma_a_per_mm *= 1.0 + 1e-9;
    return {{above, below}};
}

TEST(InverseHankel, GivesTheClosedFormOfADipolesTerms) {
    // e^{-sqrt(sigma^2 + s^2) z}/2 is z (1 + sigma d) e^{-sigma d}/(4 pi d^3).
    for (const double sigma : {0.0, 0.2, 3.0}) {
        for (const double z : {0.01, 0.3, 2.0}) {
            for (const double r : {1e-3, 0.1, 1.0, 5.0, 30.0}) {
                double found = 0.0;
                inverse_hankel(r, [&](double s, double weight) {
                    found += weight * 0.5 * std::exp(-std::hypot(sigma, s) * z);
                });
                const double d = std::hypot(r, z);
                const double expected = z * (1.0 + sigma * d) * std::exp(-sigma * d) /
                                        (4.0 * std::numbers::pi * d * d * d);
                // As the header says; near the beam the nodes are dense where F is large.
                EXPECT_NEAR(found, expected, 1e-6 * expected + 1e-8 * 0.5 / std::max(r * r, z * z))
                    << sigma << " " << z << " " << r;
            }
        }
    }
}

TEST(LayeredDiffusion, IsTheSlabsWhereAllLayersAreEqual) {
    const ScatteringMedium slab = with_thickness(kSkinLayer, 2.0);
    const Diffusion diffusion = improved_diffusion(slab);
    const LayeredDiffusion layers({{diffusion, 0.5}, {diffusion, 1.5}}, diffusion, diffusion);
    for (const double depth : {0.1, 0.49, 0.7, 1.9}) {
        const Exitance expected = PointSources(diffusion, 2.0, {depth}).total(0);
        const Exitance found =
            depth < 0.5 ? layers.at(0.0).of(0, depth) : layers.at(0.0).of(1, depth - 0.5);
        EXPECT_NEAR(found.reflected, expected.reflected, 1e-12);
        EXPECT_NEAR(found.transmitted, expected.transmitted, 1e-12);
    }
    const LayeredDiffusion endless({{diffusion, 0.5}, {diffusion, {}}}, diffusion, diffusion);
    for (const double s : {0.0, 1.0, 30.0}) {
        EXPECT_NEAR(
            endless.at(s).of(0, 0.2).reflected, half_space_spectrum(diffusion, 0.2, s), 1e-12);
    }
}

TEST(ScatteringStack, OfEqualLayersIsOneSlab) {
    const ScatteringMedium slab = with_thickness(kMarbleLayer, 2.0);
    const ScatteringStack two{{kMarbleLayer, kMarbleLayer}};
    for (const SubsurfaceModel model : {multipole, scaled_beam_diffusion}) {
        const SubsurfaceProfile one = subsurface_profile(model, slab);
        const SubsurfaceProfile both = subsurface_profile(model, two);
        EXPECT_EQ(both.totals.reflectance, one.totals.reflectance);
        EXPECT_EQ(both.totals.transmittance, one.totals.transmittance);
        for (const double r : {0.0, 0.1, 1.0, 5.0}) {
            EXPECT_EQ(both.reflectance(r), one.reflectance(r));
            EXPECT_EQ(both.transmittance(r), one.transmittance(r));
        }
    }
    const auto photons = monte_carlo_profile(two, {{0.1, 1.0}}, {2'000, 3});
    const auto expected = monte_carlo_profile(slab, {{0.1, 1.0}}, {2'000, 3});
    EXPECT_EQ(photons.rd[0].value, expected.rd[0].value);
    EXPECT_EQ(photons.total_transmittance.value, expected.total_transmittance.value);
}

TEST(ScatteringStack, OfNearlyEqualLayersIsNearlyOneSlab) {
    // The whole way through layers, at what the slab's own code gives by other means. A thousandth:
    // both integrate over depths by eight points a panel, in panels that are not the same.
    for (const ScatteringMedium& whole : {with_thickness(kMarbleLayer, 2.0),
                                          with_thickness(kSkinLayer, 2.0),
                                          with_thickness({0.17, 4.4, 0.8, 1.3, {}}, {})}) {
        const ScatteringStack stack = nearly(whole, 0.6);
        const DiffuseTotals exact = exact_totals(whole), layered = exact_totals(stack);
        EXPECT_NEAR(layered.reflectance, exact.reflectance, 1e-5);
        EXPECT_NEAR(layered.transmittance, exact.transmittance, 1e-5);
        const DiffuseTotals once = single_scattering_totals(whole);
        const DiffuseTotals once_layered = single_scattering_totals(stack);
        EXPECT_NEAR(once_layered.reflectance, once.reflectance, 1e-7);
        EXPECT_NEAR(once_layered.transmittance, once.transmittance, 1e-7);
        const SubsurfaceProfile one = subsurface_profile(scaled_beam_diffusion, whole);
        const SubsurfaceProfile two = subsurface_profile(scaled_beam_diffusion, stack);
        for (const double r : {0.02, 0.2, 1.0, 3.0}) {
            const double alone = single_scattering_reflectance(whole, r);
            EXPECT_NEAR(single_scattering_reflectance(stack, r), alone, 1e-5 * alone) << r;
            EXPECT_NEAR(two.reflectance(r) / one.reflectance(r), 1.0, 1e-3) << r;
            // Sources next to the bottom are points a twentieth of a mean free path apart.
            if (!whole.thickness_mm || r < 0.1) continue;
            EXPECT_NEAR(two.transmittance(r) / one.transmittance(r), 1.0, 1e-3) << r;
        }
    }
}

TEST(ScatteringStack, HasTheTotalsThatMcmlPublishes) {
    // sample.mci of MCML (Wang, Jacques and Zheng 1995), per cm there, and what it prints for a
    // million photons: of what arrives, with what never scattered. Three standard errors of so
    // many photons, each of which counts at most .4 off: .0012.
    const ScatteringStack stack{
        {{0.1, 10.0, 0.9, 1.37, 1.0}, {0.1, 1.0, 0.0, 1.37, 1.0}, {0.2, 1.0, 0.7, 1.37, 2.0}}};
    const UnscatteredLight straight = unscattered_light(stack);
    const double enters = 1.0 - straight.specular;
    EXPECT_NEAR(straight.specular, 0.0243729, 1e-6);
    const DiffuseTotals exact = exact_totals(stack);
    EXPECT_NEAR(enters * (exact.reflectance + straight.reflected), 0.237544, 0.0012);
    EXPECT_NEAR(enters * (exact.transmittance + straight.transmitted), 0.0964896, 0.0012);
    const MonteCarloProfile photons = monte_carlo_profile(stack, {}, {20'000, 9});
    EXPECT_NEAR(
        enters * photons.absorbed.value, 0.641594, 3.5 * photons.absorbed.standard_error + 0.0012);
}

TEST(MonteCarlo, InLayersIsWithinItsErrorOfExactTotals) {
    for (const NamedStack& one : compared_stacks()) {
        const MonteCarloProfile photons = monte_carlo_profile(one.stack, {}, {20'000, 5});
        const DiffuseTotals exact = exact_totals(one.stack);
        EXPECT_NEAR(photons.total_reflectance.value,
                    exact.reflectance,
                    3.5 * photons.total_reflectance.standard_error + 2e-4)
            << one.name;
        EXPECT_NEAR(photons.total_transmittance.value,
                    exact.transmittance,
                    3.5 * photons.total_transmittance.standard_error + 2e-4)
            << one.name;
        EXPECT_NEAR(sum_of(photons), 1.0, 1e-9) << one.name;
    }
}

TEST(BestModel, NightlyOfLayersIsAsNearAsItSaysAndNearerThanTheMultipole) {
    for (const NamedStack& one : compared_stacks()) {
        const MediumErrors errors = model_errors(one, {20'000, 3});
        ASSERT_EQ(errors.models.size(), 2u);
        const ModelError &best = errors.models[0], &other = errors.models[1];
        ASSERT_EQ(best.model, scaled_beam_diffusion);
        const std::string why = why_best(one.stack);
        const double stated = std::stod(why.substr(why.find("within ") + 7)) / 100.0;
        EXPECT_LT(best.reflectance_l1, stated + errors.noise_l1) << one.name;
        EXPECT_LT(best.transmittance_l1, stated + 2.0 * errors.noise_l1) << one.name;
        EXPECT_LT(best.reflectance_l1, other.reflectance_l1) << one.name;
        EXPECT_NEAR(best.reflectance_bias, 0.0, 1e-6) << one.name;
    }
}

TEST(ScatteringStack, IsSafeAtItsCorners) {
    const ScatteringMedium clear{0.0, 0.0, 0.0, 1.5, 0.3}, absorber{2.0, 0.0, 0.0, 1.5, 0.3};
    const ScatteringMedium thin{0.01, 1.0, 0.0, 1.5, 1e-3}, white{0.0, 2.0, 0.0, 1.5, 1.0};
    const ScatteringMedium forward{0.01, 100.0, 0.99, 1.5, 0.5};
    const ScatteringMedium bright{0.0001, 0.9999, 0.0, 1.5, 2.0};
    const auto endless = [](const ScatteringMedium& medium) { return with_thickness(medium, {}); };
    const std::vector<ScatteringStack> stacks{{{white, thin}},
                                              {{thin, endless(white)}},
                                              {{thin, kSkinLayer, thin}},
                                              {{bright, endless(kSkinLayer)}},
                                              {{bright, white}},
                                              {{forward, kMarbleLayer}},
                                              {{kMarbleLayer, endless(forward)}},
                                              {{clear, kMarbleLayer, clear}},
                                              {{absorber, kMarbleLayer, absorber}},
                                              {{kMarbleLayer, endless(clear)}},
                                              {{clear, absorber}},
                                              {{clear, endless(absorber)}},
                                              {{kMarbleLayer, endless(absorber)}}};
    for (std::size_t k = 0; k < stacks.size(); ++k) {
        const UnscatteredLight straight = unscattered_light(stacks[k]);
        const double most = 1.0 - straight.reflected - straight.transmitted;
        for (const SubsurfaceModel model : {multipole, scaled_beam_diffusion}) {
            const SubsurfaceProfile profile = subsurface_profile(model, stacks[k]);
            EXPECT_GE(profile.totals.reflectance, 0.0) << k;
            EXPECT_GE(profile.totals.transmittance, 0.0) << k;
            EXPECT_LE(profile.totals.reflectance + profile.totals.transmittance, most + 1e-9) << k;
            for (const double r : {0.0, 0.1, 30.0, 1000.0}) {
                const double up = profile.reflectance(r), down = profile.transmittance(r);
                EXPECT_TRUE(std::isfinite(up) && up >= 0.0) << k << " " << r << " " << up;
                EXPECT_TRUE(std::isfinite(down) && down >= 0.0) << k << " " << r << " " << down;
            }
        }
        const MonteCarloProfile photons = monte_carlo_profile(stacks[k], {}, {640, 7});
        EXPECT_NEAR(sum_of(photons), 1.0, 1e-9) << k;
    }
}

TEST(ScatteringStack, IsRefusedWithTheLayerThatIsWrong) {
    const auto refuses = [](const ScatteringStack& stack, const std::string& part) {
        try {
            check_stack(stack);
            ADD_FAILURE() << part;
        } catch (const std::invalid_argument& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    };
    refuses({}, "layers: found 0");
    refuses({{kMarbleLayer, with_thickness(kSkinLayer, -1.0)}}, "layer 2: thickness: found -1");
    refuses({{with_thickness(kMarbleLayer, {}), kSkinLayer}}, "layer 1: found no thickness");
    refuses({{kMarbleLayer, {0.1, 1.0, 0.0, 1.3, 1.0}}}, "layer 2: found an index of 1.3");
    refuses({{{std::numeric_limits<double>::quiet_NaN(), 1.0, 0.0, 1.5, 1.0}}}, "layer 1: sigma_a");
    EXPECT_THROW(subsurface_profile(dipole, ScatteringStack{{kMarbleLayer, kSkinLayer}}),
                 std::invalid_argument);
}

}  // namespace
}  // namespace livery
