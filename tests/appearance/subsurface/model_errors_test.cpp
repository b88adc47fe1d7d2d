// What the documentation says of each model's error, against Monte Carlo.

#include "appearance/subsurface/model_errors.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "core/quadrature.h"
#include "subsurface_reference.h"
#include "support/reference_data.h"

namespace livery {
namespace {

const ModelError& error_of(const MediumErrors& errors, SubsurfaceModel model) {
    for (const ModelError& error : errors.models) {
        if (error.model == model) return error;
    }
    throw std::logic_error("no such model");
}

const NamedMedium& medium_called(const std::string& name) {
    for (const NamedMedium& medium : compared_media()) {
        if (medium.name == name) return medium;
    }
    throw std::logic_error("no such medium");
}

/// Percent of the light that each model is off, as others found with an independent photon code;
/// -1: not told.
struct Row {
    const char* medium;
    int photons;
    double dipole, better, beam, p3, best;
};

TEST(ModelErrors, AreThoseOfAnIndependentComparison) {
    using enum SubsurfaceModel;
    const Row rows[] = {
        {"marble", 10'000, 20, 10, 2.5, 9, 0.9},
        {"white PVC", 10'000, 20, 10, 2.5, 9, 0.9},
        {"skin 1", 60'000, 51, 17, 7.1, 33, 0.9},
        {"albedo .5", 60'000, 131, 17, 9.9, 63, 1.5},
    };
    for (const Row& row : rows) {
        const MediumErrors errors =
            model_errors(medium_called(row.medium), {static_cast<std::uint64_t>(row.photons), 2});
        // Noise of the truth adds where it is not small beside a model's error.
        const double noise = 100.0 * errors.noise_l1;
        const auto near = [&](SubsurfaceModel model, double percent) {
            const double found = 100.0 * error_of(errors, model).reflectance_l1;
            EXPECT_GT(found, percent - 2.0 - 0.5 * noise)
                << row.medium << " " << info_of(model).name;
            EXPECT_LT(found, percent + 2.0 + noise) << row.medium << " " << info_of(model).name;
        };
        near(dipole, row.dipole);
        near(better_dipole, row.better);
        near(beam_diffusion, row.beam);
        near(p3, row.p3);
        near(scaled_beam_diffusion, row.best);
    }
}

/// "within 8% of the light in those like this one"
double stated_percent(const std::string& why) {
    const auto at = why.find("within ");
    return at == std::string::npos ? 0.0 : std::stod(why.substr(at + 7));
}

TEST(BestModel, IsAsNearAsItSaysAndNearerThanTheOthers) {
    for (const NamedMedium& named : compared_media()) {
        const bool slow = named.medium.albedo_prime() > 0.99 && !named.medium.thickness_mm;
        const MediumErrors errors = model_errors(named, {slow ? 5'000u : 30'000u, 3});
        const double noise = errors.noise_l1;
        const ModelError& best = error_of(errors, kBestSubsurfaceModel);
        const double stated = stated_percent(why_best({{named.medium}})) / 100.0;
        EXPECT_LT(best.reflectance_l1, stated + noise) << named.name;
        EXPECT_LT(best.transmittance_l1, stated + 2.0 * noise) << named.name;
        for (const ModelError& other : errors.models) {
            EXPECT_LT(best.reflectance_l1, other.reflectance_l1 + noise)
                << named.name << " " << info_of(other.model).name;
        }
        std::printf("%-24s %.1f%% (noise %.1f%%)\n",
                    named.name.c_str(),
                    100.0 * best.reflectance_l1,
                    100.0 * noise);
    }
}

TEST(ModelErrors, HaveATable) {
    const std::string text = markdown_of({model_errors(medium_called("skin 1, 2 mm"), {1000, 1})});
    EXPECT_NE(text.find("| skin 1, 2 mm |"), std::string::npos) << text;
    EXPECT_NE(text.find("**scaled-beam-diffusion**"), std::string::npos) << text;
    EXPECT_NE(text.find("multipole"), std::string::npos) << text;
}

TEST(ModelErrors, AreSmallAgainstTheTablesOfAnIndependentPhotonCode) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const auto nodes = gauss_legendre(8);
    const auto l1 = [&](const auto& profile, const auto& truth, const ReferenceTable& table) {
        double off = 0.0, all = 0.0;
        for (std::size_t k = 1; k < table.rings.size(); ++k) {
            const auto [low, high] = table.rings[k];
            const double value = integrate(nodes, low, high, [&](double r) {
                return 2.0 * std::numbers::pi * r * profile(r);
            });
            const double there = truth[k].value * std::numbers::pi * (high - low) * (high + low);
            off += std::abs(value - there);
            all += there;
        }
        return off / all;
    };
    for (const ReferenceTable& table : reference_tables(data)) {
        const auto profile = subsurface_profile(kBestSubsurfaceModel, table.medium);
        const bool no_step = table.medium.eta == 1.0;
        const double up = l1(profile.reflected, table.rd, table);
        EXPECT_LT(up, no_step ? 0.07 : 0.03) << table.name;
        const double down =
            table.medium.thickness_mm ? l1(profile.transmitted, table.rt, table) : 0.0;
        EXPECT_LT(down, 0.07) << table.name;
        std::printf("%s: R_d %.2f%%, T_d %.2f%%\n", table.name.c_str(), 100.0 * up, 100.0 * down);
        if (table.name != "marble_g_n1.5_semi") continue;
        // P3 from 1 to 10 mean free paths, where the dipole is off by a fifth.
        const auto rms_ln = [&](SubsurfaceModel model) {
            const auto one = subsurface_profile(model, table.medium);
            double sum = 0.0;
            int count = 0;
            for (std::size_t k = 0; k < table.rings.size(); ++k) {
                const double r = 0.5 * (table.rings[k].inner_mm + table.rings[k].outer_mm);
                const double paths = r * table.medium.sigma_t_prime();
                if (paths < 1.0 || paths > 10.0) continue;
                const double off = std::log(one.reflected(r) / table.rd[k].value);
                sum += off * off;
                ++count;
            }
            return std::sqrt(sum / count);
        };
        EXPECT_LT(rms_ln(SubsurfaceModel::p3), 0.06);
        EXPECT_NEAR(rms_ln(SubsurfaceModel::dipole), 0.192, 0.01);
    }
}

}  // namespace
}  // namespace livery
