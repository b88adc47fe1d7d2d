// Measured reflectance between its samples: against the formulas that tables were made from, and
// three real paints.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/measured/half_difference.h"
#include "appearance/measured/measured_grid.h"
#include "appearance/merl_bytes.h"
#include "appearance/models.h"
#include "core/colour.h"
#include "core/worst_error.h"
#include "support/reference_data.h"

namespace livery {
namespace {

/// A glossy paint without narrow lobes, in the working space.
glm::dvec3 satin(const glm::dvec3& wi, const glm::dvec3& wo) {
    f64::BsdfParameters p = plain_parameters();
    p.diffuse = {0.4, 0.1, 0.05};
    p.alpha_x = p.alpha_y = 0.2;
    return evaluate(ReflectanceModel::ggx, p, wi, wo);
}

const MeasuredReflectance& satin_table() {
    static const MeasuredReflectance measured =
        measured_from(parse_merl(merl_bytes([](const glm::dvec3& wi, const glm::dvec3& wo) {
                                     return rec709_from_working() * satin(wi, wo);
                                 }),
                                 "satin.binary"),
                      "satin.binary");
    return measured;
}

TEST(HalfDifference, IsTheInverseOfItsDefinition) {
    Random random(3);
    for (int k = 0; k < 20'000; ++k) {
        const double theta_h = std::pow(random.uniform(), 4.0) * 1.57;
        const double theta_d = std::pow(random.uniform(), 2.0) * 1.57;
        const double phi_d = std::numbers::pi * random.uniform();
        const auto [wi, wo] = pair_from_angles(theta_h, theta_d, phi_d);
        const double turn = 6.0 * random.uniform();
        const auto turned = [&](const glm::dvec3& w) {
            return glm::dvec3(w.x * std::cos(turn) - w.y * std::sin(turn),
                              w.x * std::sin(turn) + w.y * std::cos(turn),
                              w.z);
        };
        const glm::dvec3 angles = f64::half_difference(turned(wi), turned(wo));
        const glm::dvec3 swapped = f64::half_difference(turned(wo), turned(wi));
        EXPECT_NEAR(angles.x, theta_h, 1e-12);
        EXPECT_NEAR(angles.y, theta_d, 1e-12);
        if (theta_h < 1e-5 || theta_d < 1e-5) continue;
        const auto apart = [](double a, double b) {
            const double d = std::abs(a - b);
            return std::min(d, std::numbers::pi - d);
        };
        EXPECT_LT(apart(angles.z, phi_d), 1e-8) << theta_h << " " << theta_d;
        EXPECT_LT(apart(swapped.z, phi_d), 1e-8);
        const glm::vec3 in_float =
            f32::half_difference(glm::vec3(turned(wi)), glm::vec3(turned(wo)));
        // The half vector of nearly opposite directions is what their rounding leaves.
        const double rounding = 1e-6 / std::cos(theta_d);
        EXPECT_NEAR(static_cast<double>(in_float.x), theta_h, rounding);
        EXPECT_NEAR(static_cast<double>(in_float.y), theta_d, 1e-6);
    }
    EXPECT_EQ(f64::half_difference({0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}), glm::dvec3(0.0));
    const glm::dvec3 opposite = f64::half_difference({1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
    EXPECT_TRUE(std::isfinite(opposite.x) && std::isfinite(opposite.y));
}

TEST(MeasuredTable, GivesBackTheFormulaThatItWasMadeFrom) {
    std::vector<double> relative;
    Random random(5);
    for (int k = 0; k < 50'000; ++k) {
        const glm::dvec3 wo = direction(0.17 + 0.83 * random.uniform(), 6.3 * random.uniform());
        const glm::dvec3 wi = random_partner(random, wo, 0.2);
        if (wi.z < 0.17) continue;
        const glm::dvec3 value = evaluate(satin_table(), wi, wo);
        const glm::dvec3 truth = satin(wi, wo);
        relative.push_back(
            worst_if_nan(std::abs(luminance_of_working(value) - luminance_of_working(truth)) /
                         luminance_of_working(truth)));
        const glm::dvec3 swapped = evaluate(satin_table(), wo, wi);
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(value[c], swapped[c], 1e-9);
    }
    std::sort(relative.begin(), relative.end());
    const auto at = [&](double q) {
        return relative[static_cast<std::size_t>(q * static_cast<double>(relative.size() - 1))];
    };
    std::printf("table of 90 x 90 x 180 bins: median %.5f, p95 %.5f, largest %.4f\n",
                at(0.5),
                at(0.95),
                at(1.0));
    EXPECT_LT(at(0.5), 3e-4);
    EXPECT_LT(at(0.95), 4e-3);
    EXPECT_LT(at(1.0), 0.05);
}

TEST(MeasuredTable, DoesNotDependOnTheAzimuthWhereThereIsNone) {
    for (const double tilt : {0.0, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3}) {
        const double expected = evaluate(satin_table(), {0.6, 0.0, 0.8}, {-0.6, 0.0, 0.8}).x;
        for (int k = 0; k < 8; ++k) {
            const glm::dvec3 wo =
                glm::normalize(glm::dvec3(-0.6 + tilt * std::cos(k), tilt * std::sin(k), 0.8));
            EXPECT_NEAR(evaluate(satin_table(), {0.6, 0.0, 0.8}, wo).x, expected, 2e-3 * expected);
            const glm::dvec3 back =
                glm::normalize(glm::dvec3(0.6 + tilt * std::cos(k), tilt * std::sin(k), 0.8));
            const double retro = satin({0.6, 0.0, 0.8}, {0.6, 0.0, 0.8}).x;
            EXPECT_NEAR(evaluate(satin_table(), {0.6, 0.0, 0.8}, back).x, retro, 2e-3 * retro);
        }
    }
}

TEST(MeasuredTable, FillsHolesFromTheNearestAndSaysSo) {
    std::string bytes =
        merl_bytes([](const glm::dvec3&, const glm::dvec3&) { return glm::dvec3(0.2); });
    const auto clean = parse_merl(bytes, "a.binary");
    const std::size_t bin = 30 + 180 * (20 + 90 * 20);
    const double hole = -0.5;
    std::memcpy(bytes.data() + 12 + 8 * bin, &hole, 8);
    const auto holed = parse_merl(bytes, "a.binary");
    EXPECT_EQ(holed.masked, clean.masked + 1);
    EXPECT_NEAR(holed.values[bin].x, 0.2, 1e-12) << "not averaged with what was negative";
    const auto measured = measured_from(parse_merl(bytes, "a.binary"), "a.binary");
    const double root = 20.5 / 90.0;
    const auto [wi, wo] = pair_from_angles(0.5 * std::numbers::pi * root * root,
                                           20.5 * std::numbers::pi / 180.0,
                                           30.5 * std::numbers::pi / 180.0);
    EXPECT_FALSE(is_measured(measured, wi, wo));
    EXPECT_TRUE(is_measured(measured, {0.0, 0.6, 0.8}, {0.0, 0.0, 1.0}));
    EXPECT_FALSE(is_measured(measured, {0.0, 0.6, -0.8}, {0.0, 0.0, 1.0}));
    EXPECT_NEAR(evaluate(measured, wi, wo).y, 0.2, 1e-9);
    EXPECT_NEAR(directional_albedo(measured, {0.0, 0.6, 0.8}).y, 0.2 * std::numbers::pi, 1e-3);
}

TEST(MeasuredGrid, StatesWhatItLoses) {
    const MeasuredGrid fine = resampled(satin_table());
    const ReflectanceDifference of_fine = resampling_error(fine, satin_table());
    const ReflectanceDifference of_coarse =
        resampling_error(resampled(satin_table(), {12, 6, 6}), satin_table());
    EXPECT_LT(of_fine.relative_median, 3e-3);
    EXPECT_LT(of_fine.relative_p95, 0.01);
    EXPECT_LT(of_fine.de00_mean, 0.05);
    EXPECT_GT(of_coarse.relative_median, 2.0 * of_fine.relative_median);
    EXPECT_GT(of_coarse.de00_mean, 2.0 * of_fine.de00_mean);
    const ReflectanceDifference none = difference_of(satin, satin);
    EXPECT_EQ(none.relative_p95, 0.0);
    EXPECT_EQ(none.de00_p95, 0.0);
    EXPECT_EQ(evaluate(fine, {0.6f, 0.0f, -0.8f}, {0.0f, 0.0f, 1.0f}), glm::vec3(0.0f));
}

TEST(MeasuredSamples, AreMetExactlyAndNeverOvershot) {
    MeasuredSamples samples;
    Random random(9);
    double low = 1e9, high = 0.0;
    for (int k = 0; k < 500; ++k) {
        const DirectionPair pair{direction(random.uniform(), 6.3 * random.uniform()),
                                 direction(random.uniform(), 6.3 * random.uniform())};
        const glm::dvec3 value = satin(pair.wi, pair.wo);
        samples.pairs.push_back(pair);
        for (int c = 0; c < 3; ++c) samples.values.push_back(value[c]);
        low = std::min(low, value.x);
        high = std::max(high, value.x);
    }
    samples.pairs.push_back({samples.pairs[0].wo, samples.pairs[0].wi});  // again, exchanged
    for (std::size_t c = 0; c < 3; ++c) samples.values.push_back(samples.values[c]);
    const SampleInterpolator interpolator(samples);
    std::array<double, 3> values{};
    for (std::size_t k = 0; k < samples.pairs.size(); ++k) {
        interpolator.evaluate(f64::half_difference(samples.pairs[k].wi, samples.pairs[k].wo),
                              values);
        EXPECT_NEAR(values[0], samples.values[3 * k], 1e-6 * values[0]);
    }
    for (int k = 0; k < 2000; ++k) {
        const glm::dvec3 wi = random_direction(random), wo = random_direction(random);
        interpolator.evaluate(f64::half_difference(wi, wo), values);
        EXPECT_GE(values[0], 0.999 * low);
        EXPECT_LE(values[0], 1.001 * high);
        std::array<double, 3> swapped{};
        interpolator.evaluate(f64::half_difference(wo, wi), swapped);
        EXPECT_NEAR(swapped[0], values[0], 1e-6 * values[0]);
    }
}

/// The nearest neighbours by looking at every one.
TEST(MeasuredSamples, NearestIsTheNearest) {
    MeasuredSamples samples;
    Random random(2);
    for (int k = 0; k < 300; ++k) {
        samples.pairs.push_back({random_direction(random), random_direction(random)});
        samples.values.insert(samples.values.end(), {1.0, 1.0, 1.0});
    }
    const SampleInterpolator all(samples);
    for (int k = 0; k < 200; ++k) {
        const glm::dvec3 at =
            f64::half_difference(random_direction(random), random_direction(random));
        double nearest = 1e9;
        for (std::size_t s = 0; s < samples.pairs.size(); ++s) {
            MeasuredSamples one;
            one.pairs = {samples.pairs[s]};
            one.values = {1.0, 1.0, 1.0};
            nearest = std::min(nearest, SampleInterpolator(one).distance_to_nearest(at));
        }
        EXPECT_NEAR(all.distance_to_nearest(at), nearest, 1e-12);
    }
}

class CornellPaints : public ::testing::Test {
  protected:
    static MeasuredReflectance read(const std::filesystem::path& data, const char* name) {
        return read_measured_file(data / "paint" / (std::string(name) + ".brdf"));
    }
    /// Under light 45 degrees from the normal, seen along it: off the highlight.
    static glm::dvec3 face_lab(const MeasuredReflectance& measured) {
        const glm::dvec3 value =
            evaluate(measured, direction_from_angles(std::numbers::pi / 4.0, 0.0), {0.0, 0.0, 1.0});
        return lab_from_xyz(xyz_from_working() * (std::numbers::pi * value), d65_xyz());
    }
};

TEST_F(CornellPaints, HaveTheirColours) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    const glm::dvec3 garnet = face_lab(read(data, "garnet_red"));
    const glm::dvec3 cayman = face_lab(read(data, "cayman"));
    const glm::dvec3 krylon = face_lab(read(data, "krylon_blue"));
    for (const auto& [name, lab] :
         {std::pair{"garnet_red", garnet}, {"cayman", cayman}, {"krylon_blue", krylon}}) {
        std::printf("%s at 45 degrees: L* %.1f a* %.1f b* %.1f\n", name, lab.x, lab.y, lab.z);
    }
    EXPECT_GT(garnet.y, 25.0);  // red
    EXPECT_GT(garnet.y, 1.5 * std::abs(garnet.z));
    EXPECT_LT(cayman.y, -10.0);  // green to blue
    EXPECT_LT(krylon.z, -25.0);  // blue
}

TEST_F(CornellPaints, KeepEnergyAndFallOffTheHighlight) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const char* name : {"garnet_red", "cayman", "krylon_blue"}) {
        const MeasuredReflectance measured = read(data, name);
        EXPECT_EQ(measured.samples.pairs.size(), 1439u);
        EXPECT_EQ(measured.samples.masked, 0u);
        std::printf("%s albedo:", name);
        for (const double mu : {0.1, 0.2, 0.4, 0.7, 1.0}) {
            const glm::dvec3 albedo = directional_albedo(measured, direction(mu, 0.0), 64);
            std::printf("  %.1f: %.3f %.3f %.3f", mu, albedo.x, albedo.y, albedo.z);
            for (int c = 0; c < 3; ++c) {
                EXPECT_GT(albedo[c], -0.003) << name << " " << mu;
                EXPECT_LT(albedo[c], 1.0) << name << " " << mu;
            }
        }
        std::printf("\n");
        const glm::dvec3 wi = direction_from_angles(1.0, 0.0);
        EXPECT_GT(
            luminance_of_working(
                evaluate(measured, wi, direction_from_angles(1.0, std::numbers::pi))),
            5.0 * luminance_of_working(evaluate(measured, wi, direction_from_angles(0.4, 0.0))));
        const MeasuredCoverage coverage = coverage_of(measured);
        std::printf("%s covers theta to %.1f and %.1f, theta_d %.1f to %.1f degrees, %.0f%%\n",
                    name,
                    coverage.largest_theta_i * 180.0 / std::numbers::pi,
                    coverage.largest_theta_o * 180.0 / std::numbers::pi,
                    coverage.smallest_theta_d * 180.0 / std::numbers::pi,
                    coverage.largest_theta_d * 180.0 / std::numbers::pi,
                    100.0 * coverage.fraction);
        EXPECT_NEAR(coverage.largest_theta_i, 80.0 * std::numbers::pi / 180.0, 1e-3);
        EXPECT_GT(coverage.fraction, 0.5);
        EXPECT_LT(coverage.fraction, 1.0);
    }
}

class CornellSamples : public CornellPaints {
  protected:
    /// Sorted: how far the luminance that one part of the samples foretells is off the others', up
    /// to 80 degrees from the normal.
    template <typename IsKept>
    static std::vector<double> foretold(const MeasuredSamples& all, const IsKept& is_kept) {
        MeasuredSamples kept;
        kept.wavelengths_nm = all.wavelengths_nm;
        for (std::size_t k = 0; k < all.pairs.size(); ++k) {
            if (!is_kept(k)) continue;
            kept.pairs.push_back(all.pairs[k]);
            for (std::size_t c = 0; c < all.channels(); ++c) {
                kept.values.push_back(all.values[k * all.channels() + c]);
            }
        }
        const auto guess = measured_from(kept, MeasuredFormat::spectral_text, "kept");
        const auto truth = measured_from(all, MeasuredFormat::spectral_text, "all");
        std::vector<double> relative;
        for (std::size_t k = 0; k < all.pairs.size(); ++k) {
            const auto& [wi, wo] = all.pairs[k];
            if (is_kept(k) || wi.z < 0.17 || wo.z < 0.17) continue;
            const double expected = luminance_of_working(evaluate(truth, wi, wo));
            relative.push_back(worst_if_nan(
                std::abs(luminance_of_working(evaluate(guess, wi, wo)) / expected - 1.0)));
        }
        std::sort(relative.begin(), relative.end());
        return relative;
    }
};

TEST_F(CornellSamples, AreForetoldByTheRest) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const char* name : {"garnet_red", "cayman", "krylon_blue"}) {
        const MeasuredSamples all = read(data, name).samples;
        const auto off = foretold(all, [](std::size_t k) { return k % 10 != 3; });
        std::printf("%s, a tenth foretold by the rest: median %.4f, p90 %.4f\n",
                    name,
                    off[off.size() / 2],
                    off[off.size() * 9 / 10]);
        EXPECT_LT(off[off.size() / 2], 0.06) << name;
    }
}

/// Light and eye exchanged: those with the eye nearer the normal foretell the others. As many
/// others, chosen evenly, show what the missing half alone costs.
TEST_F(CornellSamples, AreReciprocalAsFarAsTheInstrumentWas) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const char* name : {"garnet_red", "cayman", "krylon_blue"}) {
        const MeasuredSamples all = read(data, name).samples;
        const auto exchanged =
            foretold(all, [&](std::size_t k) { return all.pairs[k].wi.z < all.pairs[k].wo.z; });
        const auto half = foretold(all, [](std::size_t k) { return k % 2 == 0; });
        std::printf(
            "%s, foretold by the exchanged half: median %.4f, p90 %.4f; by every second: "
            "%.4f, %.4f\n",
            name,
            exchanged[exchanged.size() / 2],
            exchanged[exchanged.size() * 9 / 10],
            half[half.size() / 2],
            half[half.size() * 9 / 10]);
        EXPECT_LT(exchanged[exchanged.size() / 2], 0.3) << name;
        EXPECT_LT(half[half.size() / 2], 0.1) << name;
    }
}

}  // namespace
}  // namespace livery
