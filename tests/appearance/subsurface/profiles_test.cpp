// The models' formulas, their closed totals and their hard cases.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/subsurface/media.h"
#include "appearance/subsurface/profile_integrals.h"
#include "appearance/subsurface/profile_models.h"
#include "appearance/subsurface/single_scattering.h"
#include "appearance/subsurface/subsurface_profile.h"
#include "core/worst_error.h"

namespace livery {
namespace {

constexpr double kPi = std::numbers::pi;

ScatteringMedium slab_of(ScatteringMedium medium, double thickness_mm) {
    medium.thickness_mm = thickness_mm;
    return medium;
}

/// Over the plane with many more nodes than the models use.
template <typename Function>
double fine_integral(double from, double to, const Function& f) {
    static const auto nodes = gauss_legendre(16);
    const double span = std::log(to / from);
    constexpr int kPanels = 50;
    double sum = kPi * from * from * f(from);
    for (int k = 0; k < kPanels; ++k) {
        sum += integrate(nodes, span * k / kPanels, span * (k + 1) / kPanels, [&](double u) {
            const double r = from * std::exp(u);
            return 2.0 * kPi * r * r * f(r);
        });
    }
    return sum;
}

TEST(Dipole, IsTheFormulaWithItsClosedTotal) {
    const SubsurfaceProfile profile = subsurface_profile(SubsurfaceModel::dipole, kMarble);
    // Jensen et al. 2001, by hand.
    const double all = 2.6241, albedo = 2.62 / all, tr = std::sqrt(3.0 * 0.0041 * all);
    const double a = (1.0 + 0.596346) / (1.0 - 0.596346);
    const double zr = 1.0 / all, zv = zr + 4.0 * a / (3.0 * all);
    for (const double r : {0.01, 0.5, 3.0, 20.0}) {
        const auto q = [&](double z) {
            const double d = std::hypot(r, z);
            return z * (1.0 + tr * d) * std::exp(-tr * d) / (d * d * d);
        };
        const double value = albedo / (4.0 * kPi) * (q(zr) + q(zv));
        EXPECT_NEAR(profile.reflectance(r), value, 3e-6 * value) << r;
    }
    const double s = std::sqrt(3.0 * (1.0 - albedo));
    EXPECT_NEAR(profile.totals.reflectance,
                0.5 * albedo * (1.0 + std::exp(-4.0 / 3.0 * a * s)) * std::exp(-s),
                2e-6);
    const double sum = fine_integral(1e-6, 400.0, profile.reflected);
    EXPECT_NEAR(sum, profile.totals.reflectance, 1e-9);
}

TEST(P3, HasItsClosedTotal) {
    for (const ScatteringMedium& medium :
         {kMarble, kSkin, ScatteringMedium{0.05, 5.0, 0.8, 1.4, {}}}) {
        const P3Dipole p3(medium);
        const double sum = fine_integral(1e-6, 400.0, [&](double r) { return p3.at(r); });
        EXPECT_NEAR(sum, p3.total(), 1e-7);
    }
}

TEST(P3, IsContinuousWhereAbsorptionVanishes) {
    const P3Dipole none({0.0, 1.0, 0.3, 1.4, {}});
    for (const double sigma_a : {1e-6, 1e-9, 1e-12, 1e-15}) {
        const P3Dipole little({sigma_a, 1.0, 0.3, 1.4, {}});
        for (const double r : {0.0, 0.1, 1.0, 5.0}) {
            EXPECT_NEAR(little.at(r), none.at(r), 20.0 * std::sqrt(sigma_a) * none.at(0.0)) << r;
        }
        EXPECT_NEAR(little.total(), none.total(), 20.0 * std::sqrt(sigma_a));
    }
    EXPECT_GT(none.at(10.0), 0.0);
}

TEST(P3, SaysWhereItIsNegative) {
    const ScatteringMedium ketchup{0.97, 0.07, 0.0, 1.3, {}};
    EXPECT_TRUE(subsurface_profile(SubsurfaceModel::p3, ketchup).was_negative);
    EXPECT_FALSE(subsurface_profile(SubsurfaceModel::p3, kMarble).was_negative);
}

TEST(SingleScattering, HasItsTotals) {
    // Isotropic, no boundary: w/2 int 1/(1 + 1/mu) dmu = w/2 (1 - ln 2).
    const ScatteringMedium open{0.4, 0.6, 0.0, 1.0, {}};
    EXPECT_NEAR(single_scattering_totals(open).reflectance, 0.3 * (1.0 - std::log(2.0)), 1e-6);
    for (const ScatteringMedium& medium : {ScatteringMedium{0.4, 0.6, 0.0, 1.5, {}},
                                           ScatteringMedium{0.4, 0.6, 0.7, 1.3, 0.8},
                                           ScatteringMedium{0.0, 1.0, -0.5, 1.4, 3.0},
                                           ScatteringMedium{0.1, 2.0, 0.95, 1.5, 1.0}}) {
        const DiffuseTotals totals = single_scattering_totals(medium);
        const double up = fine_integral(
            1e-7, 60.0, [&](double r) { return single_scattering_reflectance(medium, r); });
        // What is at 1/r down to the beam itself is as much again.
        EXPECT_NEAR(up, totals.reflectance, 3e-4 * totals.reflectance);
        if (!medium.thickness_mm) continue;
        const double down = fine_integral(
            1e-7, 60.0, [&](double r) { return single_scattering_transmittance(medium, r); });
        EXPECT_NEAR(down, totals.transmittance, 1e-3 * totals.transmittance);
    }
}

TEST(PointSources, AreTheSameByImagesAndByModes) {
    for (const Diffusion& diffusion : {classical_diffusion(kMarble),
                                       improved_diffusion(kSkin),
                                       classical_diffusion({0.0, 1.0, 0.0, 1.3, {}})}) {
        const double thickness = 2.0;
        const double period = thickness + 2.0 * diffusion.extrapolation_mm;
        const PointSources sources(diffusion, thickness, {0.3, 1.5});
        std::vector<Exitance> before, after;
        sources.at(0.2 * period * (1.0 - 1e-9), before);
        sources.at(0.2 * period * (1.0 + 1e-9), after);
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_NEAR(before[k].reflected, after[k].reflected, 1e-5 * after[k].reflected);
            EXPECT_NEAR(before[k].transmitted, after[k].transmitted, 1e-4 * after[k].transmitted);
        }
    }
}

TEST(PointSources, HaveTheirClosedTotals) {
    for (const double thickness : {0.0, 0.4, 3.0, 40.0}) {
        const auto slab = thickness > 0.0 ? std::optional(thickness) : std::nullopt;
        const PointSources sources(improved_diffusion(kSkin), slab, {0.2});
        std::vector<Exitance> out;
        const auto side = [&](bool top) {
            return fine_integral(1e-4, 60.0, [&](double r) {
                sources.at(r, out);
                return top ? out[0].reflected : out[0].transmitted;
            });
        };
        const Exitance total = sources.total(0);
        EXPECT_NEAR(side(true), total.reflected, 2e-5) << thickness;
        EXPECT_NEAR(side(false), total.transmitted, 2e-5) << thickness;
    }
}

TEST(PointSources, GiveTheSameFromEitherSideOfASlab) {
    const PointSources sources(improved_diffusion(kMarble), 2.0, {0.3, 1.7});
    std::vector<Exitance> out;
    for (const double r : {0.01, 0.3, 2.0, 15.0}) {
        sources.at(r, out);
        EXPECT_NEAR(out[0].reflected, out[1].transmitted, 1e-9 * out[0].reflected) << r;
        EXPECT_NEAR(out[0].transmitted, out[1].reflected, 1e-9 * out[1].reflected) << r;
    }
}

TEST(Multipole, BecomesTheDipole) {
    const SubsurfaceProfile dipole = subsurface_profile(SubsurfaceModel::dipole, kSkin);
    double before = 1.0;
    for (const double thickness : {5.0, 10.0, 20.0, 40.0}) {
        const auto profile =
            subsurface_profile(SubsurfaceModel::multipole, slab_of(kSkin, thickness));
        double worst = 0.0;
        for (const double r : {0.0, 0.1, 1.0, 5.0, 10.0}) {
            const double off = profile.reflectance(r) / dipole.reflectance(r) - 1.0;
            worst = worse_of(worst, std::abs(off));
        }
        EXPECT_LT(worst, std::max(before, 1e-8)) << thickness;
        before = worst;
        EXPECT_NEAR(profile.totals.transmittance, 0.0, std::exp(-0.5 * thickness)) << thickness;
    }
    EXPECT_LT(before, 1e-8);
}

TEST(ThickSlabs, AreHalfSpacesInEveryModelOfBoth) {
    for (const SubsurfaceModel model :
         {SubsurfaceModel::beam_diffusion, SubsurfaceModel::scaled_beam_diffusion}) {
        const SubsurfaceProfile half = subsurface_profile(model, kSkin);
        const SubsurfaceProfile slab = subsurface_profile(model, slab_of(kSkin, 60.0));
        EXPECT_NEAR(slab.totals.reflectance, half.totals.reflectance, 1e-6);
        for (const double r : {0.0, 0.1, 1.0, 5.0}) {
            EXPECT_NEAR(slab.reflectance(r), half.reflectance(r), 1e-5 * half.reflectance(r)) << r;
        }
    }
}

TEST(ScaledBeamDiffusion, HasTheExactTotals) {
    for (const ScatteringMedium& medium :
         {kMarble, kSkin, slab_of(kMarble, 2.0), slab_of(kSkin, 0.3)}) {
        const auto profile = subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium);
        const DiffuseTotals exact = exact_totals(medium);
        EXPECT_NEAR(profile.totals.reflectance, exact.reflectance, 1e-12);
        EXPECT_NEAR(profile.totals.transmittance, exact.transmittance, 1e-12);
        EXPECT_NEAR(fine_integral(1e-5, 300.0, profile.reflected), exact.reflectance, 5e-4);
        EXPECT_NEAR(fine_integral(1e-5, 300.0, profile.transmitted), exact.transmittance, 5e-4);
    }
}

TEST(NormalizedDiffusion, HoldsItsAlbedo) {
    const NormalizedDiffusion diffusion(0.6, 2.0);
    EXPECT_NEAR(fine_integral(1e-7, 300.0, [&](double r) { return diffusion.at(r); }), 0.6, 1e-5);
    const double within = fine_integral(1e-7, 1.5, [&](double r) { return diffusion.at(r); });
    EXPECT_NEAR(within, 0.6 * diffusion.cumulative(1.5), 1e-5);
}

/// Albedos, indices, phase functions and thicknesses at which formulas divide by nothing, overflow
/// or cancel.
TEST(HardCases, GiveFiniteValuesThatGainNoEnergy) {
    int checked = 0;
    for (const double albedo : {0.0, 1e-12, 0.02, 0.5, 0.99, 0.9999, 1.0 - 1e-12, 1.0}) {
        for (const double eta : {0.7, 1.0, 1.0 + 1e-9, 1.3, 2.0}) {
            for (const double g : {0.0, 0.99, -0.9}) {
                if (g != 0.0 && eta != 1.3) continue;
                for (const double depth : {0.0, 1e-3, 1.0, 1e4}) {
                    const ScatteringMedium medium{
                        1.0 - albedo,
                        albedo / (1.0 - g),
                        g,
                        eta,
                        depth > 0.0 ? std::optional(depth) : std::nullopt};
                    for (const SubsurfaceModelInfo& info : subsurface_models()) {
                        if (depth > 0.0 ? !info.slab : !info.half_space) continue;
                        const std::string what = std::string(info.name) + " a' " +
                                                 std::to_string(albedo) + " n " +
                                                 std::to_string(eta) + " g " + std::to_string(g) +
                                                 " d " + std::to_string(depth);
                        const SubsurfaceProfile profile = subsurface_profile(info.model, medium);
                        for (const double r : {0.0, 1e-9, 1e-3, 0.1, 1.0, 10.0, 100.0, 1e5}) {
                            const double rd = profile.reflectance(r);
                            const double rt = profile.transmittance(r);
                            ASSERT_TRUE(std::isfinite(rd) && rd >= 0.0) << what << " r " << r;
                            ASSERT_TRUE(std::isfinite(rt) && rt >= 0.0) << what << " r " << r;
                        }
                        const DiffuseTotals& totals = profile.totals;
                        ASSERT_GE(totals.reflectance, 0.0) << what;
                        ASSERT_GE(totals.transmittance, 0.0) << what;
                        const UnscatteredLight light = unscattered_light(medium);
                        ASSERT_LE(totals.reflectance + totals.transmittance + light.reflected +
                                      light.transmitted,
                                  1.0 + 1e-9)
                            << what;
                        ++checked;
                    }
                }
            }
        }
    }
    EXPECT_GT(checked, 700);
}

TEST(HardCases, ProfilesThatWouldCreateLightAreScaledDown) {
    const ScatteringMedium white{0.0, 1.0, 0.0, 1.0, {}};
    for (const SubsurfaceModel model :
         {SubsurfaceModel::better_dipole, SubsurfaceModel::beam_diffusion}) {
        const SubsurfaceProfile profile = subsurface_profile(model, white);
        EXPECT_LT(profile.scale, 0.95) << info_of(model).name;
        EXPECT_EQ(profile.totals.reflectance, 1.0) << info_of(model).name;
        const double sum = fine_integral(1e-5, 1e5, profile.reflected);
        EXPECT_NEAR(sum, 1.0, 2e-3) << info_of(model).name;
    }
    EXPECT_EQ(subsurface_profile(SubsurfaceModel::better_dipole, kMarble).scale, 1.0);
}

TEST(HardCases, AMediumOfNothingGivesNothing) {
    for (const ScatteringMedium& medium :
         {ScatteringMedium{0.0, 0.0, 0.0, 1.5, {}}, ScatteringMedium{3.0, 0.0, 0.0, 1.5, {}}}) {
        for (const SubsurfaceModelInfo& info : subsurface_models()) {
            if (!info.half_space) continue;
            const SubsurfaceProfile profile = subsurface_profile(info.model, medium);
            EXPECT_EQ(profile.reflectance(0.0), 0.0) << info.name;
            EXPECT_EQ(profile.reflectance(1.0), 0.0) << info.name;
            EXPECT_EQ(profile.totals.reflectance, 0.0) << info.name;
        }
    }
}

TEST(HardCases, TheBeamItselfIsAMeanOverASmallDisc) {
    const auto profile = subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, kMarble);
    const double least = least_radius_mm(kMarble);
    EXPECT_NEAR(least, 1e-3 / 2.6241, 1e-12);
    const double within = fine_integral(1e-5 * least, least, profile.reflected);
    EXPECT_NEAR(profile.reflectance(0.0),
                within / (kPi * least * least),
                1e-3 * within / (kPi * least * least));
    EXPECT_EQ(profile.reflectance(0.5 * least), profile.reflectance(0.0));
    EXPECT_THROW(profile.reflectance(-1.0), std::invalid_argument);
    EXPECT_THROW(profile.reflectance(std::nan("")), std::invalid_argument);
}

TEST(Profiles, RefuseAMediumThatTheModelDoesNotKnow) {
    EXPECT_THROW(subsurface_profile(SubsurfaceModel::p3, slab_of(kMarble, 1.0)),
                 std::invalid_argument);
    EXPECT_THROW(subsurface_profile(SubsurfaceModel::multipole, kMarble), std::invalid_argument);
    EXPECT_FALSE(find_subsurface_model("tripole"));
    for (const SubsurfaceModelInfo& info : subsurface_models()) {
        EXPECT_EQ(find_subsurface_model(info.name), info.model);
    }
}

TEST(EnergyRadius, IsThatOfMarble) {
    const auto profile = subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, kMarble);
    EXPECT_NEAR(energy_radius_mm(profile, kMarble, 0.5), 1.4, 0.05);
    EXPECT_NEAR(energy_radius_mm(profile, kMarble, 0.9), 5.4, 0.1);
    EXPECT_NEAR(energy_radius_mm(profile, kMarble, 0.99), 13.0, 0.7);
}

}  // namespace
}  // namespace livery
