// Known media found again from noisy profiles of the photon walk, which shares no formula with the
// models; and what is refused.

#include "appearance/subsurface/fit_profile.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/subsurface/media.h"
#include "appearance/subsurface/monte_carlo.h"
#include "core/error.h"
#include "core/random.h"

namespace livery {
namespace {

constexpr std::uint64_t kNoiseSeed = 5;

std::vector<double> radii_between(double from, double to, int count) {
    std::vector<double> radii;
    for (int k = 0; k < count; ++k) {
        radii.push_back(from * std::pow(to / from, k / (count - 1.0)));
    }
    return radii;
}

/// As a camera sees it: the photon walk's means over rings with 2% noise.
std::vector<ProfileSample> measured(const ScatteringMedium& medium,
                                    const std::vector<double>& radii,
                                    std::uint64_t photons) {
    std::vector<ProfileRing> rings;
    for (const double r : radii) rings.push_back({0.95 * r, 1.05 * r});
    const MonteCarloProfile truth = monte_carlo_profile(medium, rings, {photons, kNoiseSeed});
    Random random(kNoiseSeed);
    std::vector<ProfileSample> samples;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        samples.push_back({radii[k], truth.rd[k].value * (1.0 + 0.02 * random.normal())});
    }
    return samples;
}

/// What the model itself says, without noise.
std::vector<ProfileSample> exact(SubsurfaceModel model,
                                 const ScatteringMedium& medium,
                                 const std::vector<double>& radii) {
    const SubsurfaceProfile profile = subsurface_profile(model, medium);
    std::vector<ProfileSample> samples;
    for (const double r : radii) samples.push_back({r, profile.reflectance(r)});
    return samples;
}

std::string refusal(const std::function<void()>& work) {
    try {
        work();
    } catch (const Refused& refused) {
        return refused.what();
    }
    return "";
}

const ScatteringMedium kMilk{0.0025, 1.22, 0.0, 1.3, {}};

TEST(FitProfile, FindsKnownMediaInNoise) {
    std::printf("seed %d\n", static_cast<int>(kNoiseSeed));
    using enum SubsurfaceModel;
    struct {
        const char* name;
        ScatteringMedium medium;
        double farthest_mm;
        std::uint64_t photons;
        std::vector<SubsurfaceModel> models;
    } const cases[] = {
        {"marble", kMarble, 17.0, 40'000, {scaled_beam_diffusion, p3}},
        {"skim milk", kMilk, 25.0, 40'000, {scaled_beam_diffusion}},
        {"skin 1", kSkin, 5.0, 100'000, {scaled_beam_diffusion}},
        {"skin 1, 2 mm", {0.17, 0.88, 0.0, 1.3, 2.0}, 5.0, 100'000, {scaled_beam_diffusion}},
        {"marble, g .5", {0.0041, 5.24, 0.5, 1.5, {}}, 17.0, 20'000, {scaled_beam_diffusion}},
    };
    for (const auto& one : cases) {
        const auto samples =
            measured(one.medium, radii_between(0.2, one.farthest_mm, 32), one.photons);
        for (const SubsurfaceModel model : one.models) {
            const ProfileFit fit = fit_profile(
                samples, {model, one.medium.eta, one.medium.g, one.medium.thickness_mm, 0.0});
            const double of_s = fit.sigma_s_prime_per_mm.value / one.medium.sigma_s_prime() - 1.0;
            const double of_a = fit.sigma_a_per_mm.value / one.medium.sigma_a_per_mm - 1.0;
            std::printf("%-14s %-22s sigma_s' %+.1f%% (%.1f%%) sigma_a %+.1f%% (%.1f%%)\n",
                        one.name,
                        info_of(model).name,
                        100.0 * of_s,
                        100.0 * fit.sigma_s_prime_per_mm.relative_standard_error,
                        100.0 * of_a,
                        100.0 * fit.sigma_a_per_mm.relative_standard_error);
            EXPECT_LT(std::abs(of_s), 0.10) << one.name << " " << info_of(model).name;
            EXPECT_LT(std::abs(of_a), 0.25) << one.name << " " << info_of(model).name;
            // The errors that it states are those that it has.
            EXPECT_LT(std::abs(of_s), 3.0 * fit.sigma_s_prime_per_mm.relative_standard_error);
            EXPECT_LT(std::abs(of_a), 3.0 * fit.sigma_a_per_mm.relative_standard_error);
            EXPECT_LT(fit.error, 0.1);
        }
    }
}

TEST(FitProfile, FindsWhatItsOwnModelSays) {
    for (const SubsurfaceModel model : {SubsurfaceModel::dipole,
                                        SubsurfaceModel::better_dipole,
                                        SubsurfaceModel::beam_diffusion,
                                        SubsurfaceModel::scaled_beam_diffusion,
                                        SubsurfaceModel::p3}) {
        const ProfileFit fit = fit_profile(exact(model, kMilk, radii_between(0.2, 25.0, 40)),
                                           {model, 1.3, 0.0, {}, 0.0});
        EXPECT_NEAR(fit.sigma_s_prime_per_mm.value, 1.22, 0.01) << info_of(model).name;
        EXPECT_NEAR(fit.sigma_a_per_mm.value, 0.0025, 5e-5) << info_of(model).name;
        EXPECT_LT(fit.error, 1e-3) << info_of(model).name;
        EXPECT_GT(fit.sigma_a_per_mm.relative_standard_error, 0.01) << info_of(model).name;
    }
    const ScatteringMedium slab{0.02, 2.0, 0.0, 1.4, 3.0};
    const ProfileFit fit =
        fit_profile(exact(SubsurfaceModel::multipole, slab, radii_between(0.2, 12.0, 40)),
                    {SubsurfaceModel::multipole, 1.4, 0.0, 3.0, 0.0});
    EXPECT_NEAR(fit.sigma_s_prime_per_mm.value, 2.0, 0.02);
    EXPECT_NEAR(fit.sigma_a_per_mm.value, 0.02, 4e-4);
}

TEST(FitProfile, DoesNotDependOnHowDenselyFarRadiiWereSampled) {
    std::vector<double> radii = radii_between(0.3, 5.0, 30);
    const auto few = exact(SubsurfaceModel::p3, kMarble, radii);
    for (int k = 1; k <= 200; ++k) radii.push_back(5.0 + 0.06 * k);
    const auto many = exact(SubsurfaceModel::p3, kMarble, radii);
    // Another model, so that there is something to weigh.
    const ProfileFitOptions options{SubsurfaceModel::scaled_beam_diffusion, 1.5, 0.0, {}, 0.0};
    const double a = fit_profile(few, options).sigma_s_prime_per_mm.value;
    const double b = fit_profile(many, options).sigma_s_prime_per_mm.value;
    EXPECT_NEAR(a, b, 0.05 * a);
}

TEST(FitProfile, LeavesOutWhereThereIsNoLight) {
    auto samples = exact(SubsurfaceModel::p3, kMarble, radii_between(0.3, 17.0, 40));
    samples.push_back({30.0, -1e-9});
    samples.push_back({31.0, 0.0});
    const ProfileFit fit = fit_profile(samples, {SubsurfaceModel::p3, 1.5, 0.0, {}, 0.0});
    EXPECT_EQ(fit.not_positive, 2u);
    EXPECT_NEAR(fit.sigma_s_prime_per_mm.value, 2.62, 0.03);
}

TEST(FitProfile, WarnsOfWhatItTellsBadly) {
    const auto samples = exact(SubsurfaceModel::dipole, kMarble, radii_between(0.3, 17.0, 40));
    const ProfileFit fit = fit_profile(samples, {SubsurfaceModel::dipole, 1.5, 0.0, {}, 0.0});
    ASSERT_GE(fit.warnings.size(), 2u);
    EXPECT_NE(fit.warnings[0].find("--model best"), std::string::npos);
    EXPECT_NE(fit.warnings[1].find("albedo of .998"), std::string::npos);
    EXPECT_NEAR(fit.model_error, 0.15, 0.05);
}

TEST(FitProfile, RefusesWhatTheProfileDoesNotTell) {
    const ProfileFitOptions best{SubsurfaceModel::scaled_beam_diffusion, 1.5, 0.0, {}, 0.0};
    const auto samples =
        exact(SubsurfaceModel::scaled_beam_diffusion, kMarble, radii_between(0.3, 17.0, 30));
    const auto holds = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text << "\nwithout " << part;
    };
    ProfileFitOptions wide = best;
    wide.spot_mm = 0.6;
    holds(refusal([&] { fit_profile(samples, wide); }), "the spot is 0.6 mm wide");
    wide.spot_mm = 0.3;
    EXPECT_EQ(refusal([&] { fit_profile(samples, wide); }), "");

    // All of it nearer than absorption shows.
    holds(
        refusal([&] {
            fit_profile(
                exact(SubsurfaceModel::scaled_beam_diffusion, kMarble, radii_between(0.4, 1.3, 20)),
                best);
        }),
        "sigma_a");
    // Within half a millimetre there is nothing but the beam.
    EXPECT_NE(refusal([&] {
                  fit_profile(exact(SubsurfaceModel::scaled_beam_diffusion,
                                    kMarble,
                                    radii_between(0.001, 0.01, 20)),
                              best);
              }),
              "");
    // Relative values instead of absolute ones, and a profile of no medium at all.
    auto growing = samples;
    for (ProfileSample& s : growing) s.rd = 1e-3 * s.r_mm;
    EXPECT_NE(refusal([&] { fit_profile(growing, best); }), "");
    auto scaled = samples;
    for (ProfileSample& s : scaled) s.rd *= 1e4;
    EXPECT_NE(refusal([&] { fit_profile(scaled, best); }), "");
    // The dipole finds another medium where albedos are low.
    holds(refusal([&] {
              fit_profile(exact(SubsurfaceModel::scaled_beam_diffusion,
                                {0.5, 0.5, 0.0, 1.5, {}},
                                radii_between(0.3, 8.0, 30)),
                          {SubsurfaceModel::dipole, 1.5, 0.0, {}, 0.0});
          }),
          "--model best");
}

TEST(FitProfile, RefusesOptionsOutOfRange) {
    const auto samples =
        exact(SubsurfaceModel::scaled_beam_diffusion, kMarble, radii_between(0.3, 17.0, 30));
    for (const ProfileFitOptions& options :
         std::vector<ProfileFitOptions>{{SubsurfaceModel::p3, 0.1, 0.0, {}, 0.0},
                                        {SubsurfaceModel::p3, 1.5, 1.0, {}, 0.0},
                                        {SubsurfaceModel::p3, 1.5, 0.0, 1.0, 0.0},
                                        {SubsurfaceModel::p3, 1.5, 0.0, {}, -1.0},
                                        {SubsurfaceModel::multipole, 1.5, 0.0, {}, 0.0}}) {
        EXPECT_THROW(fit_profile(samples, options), std::invalid_argument);
    }
}

}  // namespace
}  // namespace livery
