#include "core/spectrum.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/working_space_study.h"
#include "core/worst_error.h"

namespace livery {
namespace {

std::filesystem::path test_data(const char* file) {
    return std::filesystem::path(LIVERY_TEST_DATA) / file;
}

TEST(Spectrum, InterpolatesLinearlyAndHoldsItsEnds) {
    const std::vector<double> nm = {400, 450, 700}, values = {1.0, 2.0, 7.0};
    const auto spectrum = spectrum_from_samples(nm, values);
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
        const double at = 380.0 + 5.0 * static_cast<double>(k);
        const double expected = at <= 400   ? 1.0
                                : at <= 450 ? 1.0 + (at - 400) / 50
                                : at <= 700 ? 2.0 + (at - 450) / 50
                                            : 7.0;
        EXPECT_NEAR(spectrum[k], expected, 1e-12) << at;
    }
    const std::vector<double> one_nm = {550}, one = {3.0};
    for (const double value : spectrum_from_samples(one_nm, one)) EXPECT_EQ(value, 3.0);
}

TEST(Spectrum, RefusesSamplesThatMakeNoSense) {
    const std::vector<double> rising = {400, 500}, falling = {500, 400}, twice = {400, 400},
                              values = {1.0, 2.0}, none;
    EXPECT_NO_THROW(spectrum_from_samples(rising, values));
    EXPECT_THROW(spectrum_from_samples(falling, values), std::invalid_argument);
    EXPECT_THROW(spectrum_from_samples(twice, values), std::invalid_argument);
    EXPECT_THROW(spectrum_from_samples(none, none), std::invalid_argument);
    EXPECT_THROW(spectrum_from_samples(rising, none), std::invalid_argument);
}

TEST(Spectrum, WhitePointIsThePublishedOne) {
    // CIE 15: D65 has x .31272, y .32903, XYZ 95.047, 100, 108.883; five decimals printed, and our
    // range ends at 780 nm.
    Spectrum white{};
    white.fill(1.0);
    const auto xyz = xyz_from_reflectance(white, illuminant_d65());
    EXPECT_NEAR(xyz.x, 0.95047, 1e-4);
    EXPECT_NEAR(xyz.y, 1.0, 1e-12);
    EXPECT_NEAR(xyz.z, 1.08883, 1e-4);
    EXPECT_NEAR(d65_xyz().x, xyz.x, 2e-4);
    EXPECT_NEAR(d65_xyz().z, xyz.z, 3e-4);
    // Equal energy: the observer's three curves have the same area, 106.857 nm for Y.
    const auto equal = xyz_from_power(white);
    EXPECT_NEAR(equal.y, 106.857, 1e-2);
    EXPECT_NEAR(equal.x / equal.y, 1.0, 2e-4);
    EXPECT_NEAR(equal.z / equal.y, 1.0, 4e-4);
}

TEST(Spectrum, GreyIsAScaledWhiteAndLightAdds) {
    Spectrum grey{}, rise{}, both{};
    for (std::size_t k = 0; k < grey.size(); ++k) {
        grey[k] = 0.25;
        rise[k] = static_cast<double>(k) / 100.0;
        both[k] = grey[k] + rise[k];
    }
    Spectrum white{};
    white.fill(1.0);
    const auto of = [](const Spectrum& s) { return xyz_from_reflectance(s, illuminant_d65()); };
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(of(grey)[k], 0.25 * of(white)[k], 1e-12);
        EXPECT_NEAR(of(both)[k], of(grey)[k] + of(rise)[k], 1e-12);
    }
}

TEST(Spectrum, TablesAreThePublishedOnes) {
    const auto observer = test_data("cie1931-observer.csv");
    const auto x = read_spectrum_column(observer, "x"), y = read_spectrum_column(observer, "y"),
               z = read_spectrum_column(observer, "z"),
               d65 = read_spectrum_column(test_data("cie-illuminants.csv"), "D65");
    for (std::size_t k = 0; k < x.size(); ++k) {
        EXPECT_NEAR(cie1931_x()[k], x[k], 1e-6);
        EXPECT_NEAR(cie1931_y()[k], y[k], 1e-6);
        EXPECT_NEAR(cie1931_z()[k], z[k], 1e-6);
        EXPECT_NEAR(illuminant_d65()[k], d65[k], 1e-3);
    }
}

TEST(Spectrum, OtherIlluminantsHaveTheirWhitePoints) {
    const auto file = test_data("cie-illuminants.csv");
    Spectrum white{};
    white.fill(1.0);
    // ASTM E308, 2 degrees, 1 nm; 5 nm tables differ from it by a few units of the fourth decimal.
    const auto a = xyz_from_reflectance(white, read_spectrum_column(file, "A"));
    EXPECT_NEAR(a.x, 1.09850, 5e-4);
    EXPECT_NEAR(a.z, 0.35585, 5e-4);
    const auto d50 = xyz_from_reflectance(white, read_spectrum_column(file, "D50"));
    EXPECT_NEAR(d50.x, 0.96422, 5e-4);
    EXPECT_NEAR(d50.z, 0.82521, 5e-4);
}

TEST(Spectrum, ColorCheckerHasItsPublishedColours) {
    // The manufacturer's sRGB values, in the order of the chart. Charts differ from print to print
    // by one to three CIEDE2000, and cyan is clipped to sRGB.
    const struct {
        const char* name;
        double r, g, b;
    } patches[] = {{"dark skin", 115, 82, 68},
                   {"light skin", 194, 150, 130},
                   {"blue sky", 98, 122, 157},
                   {"foliage", 87, 108, 67},
                   {"blue flower", 133, 128, 177},
                   {"bluish green", 103, 189, 170},
                   {"orange", 214, 126, 44},
                   {"purplish blue", 80, 91, 166},
                   {"moderate red", 193, 90, 99},
                   {"purple", 94, 60, 108},
                   {"yellow green", 157, 188, 64},
                   {"orange yellow", 224, 163, 46},
                   {"blue", 56, 61, 150},
                   {"green", 70, 148, 73},
                   {"red", 175, 54, 60},
                   {"yellow", 231, 199, 31},
                   {"magenta", 187, 86, 149},
                   {"cyan", 8, 133, 161},
                   {"white 9.5 (.05 D)", 243, 243, 242},
                   {"neutral 8 (.23 D)", 200, 200, 200},
                   {"neutral 6.5 (.44 D)", 160, 160, 160},
                   {"neutral 5 (.70 D)", 122, 122, 121},
                   {"neutral 3.5 (1.05 D)", 85, 85, 85},
                   {"black 2 (1.5 D)", 52, 52, 52}};
    const auto file = test_data("colour-checker.csv");
    std::vector<double> differences;
    for (const auto& patch : patches) {
        const auto reflectance = read_spectrum_column(file, patch.name);
        const glm::dvec3 rec709(srgb_decode(patch.r / 255.0),
                                srgb_decode(patch.g / 255.0),
                                srgb_decode(patch.b / 255.0));
        differences.push_back(worst_if_nan(
            ciede2000(lab_from_xyz(xyz_from_reflectance(reflectance, illuminant_d65()), d65_xyz()),
                      lab_from_xyz(xyz_from_rec709() * rec709, d65_xyz()))));
        EXPECT_LT(differences.back(), 5.0) << patch.name;
    }
    std::sort(differences.begin(), differences.end());
    EXPECT_LT(differences[12], 2.0);
}

}  // namespace
}  // namespace livery
