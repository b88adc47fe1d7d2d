// Files of measured reflectance: what is read, and what is refused with which words.
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/measured/measured_reflectance.h"
#include "appearance/merl_bytes.h"
#include "core/colour.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

constexpr std::size_t kMerlBytes = 12 + 24 * 90 * 90 * 180;

/// A diffuser that returns this at every wavelength, in eight pairs of directions.
std::string spectral_text(const std::string& value) {
    std::string text = "# a comment 5\n# num wls\n3\n\n400 550 \n 700\n";
    for (int k = 0; k < 8; ++k) {
        text += std::to_string(0.1 * k) + " 0 0.3 " + std::to_string(k) + " " + value + " " +
                value + "\n" + value + "\n";
    }
    return text;
}

std::string csv_text(const std::string& header, const std::string& values) {
    std::string text = header + "\n";
    for (int k = 0; k < 8; ++k) {
        text += std::to_string(0.1 * k) + ",0,0.3," + std::to_string(k) + "," + values + "\n";
    }
    return text;
}

const std::string kAngles = "theta_i,phi_i,theta_o,phi_o,";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

TEST(MeasuredFiles, ReadSpectraAsColoursUnderDaylight) {
    const auto text = spectral_text("0.25");
    const auto measured = measured_from(
        parse_spectral_samples(text, "a.brdf"), MeasuredFormat::spectral_text, "a.brdf");
    EXPECT_TRUE(measured.is_spectral());
    EXPECT_EQ(measured.samples.wavelengths_nm, (std::vector<double>{400.0, 550.0, 700.0}));
    EXPECT_EQ(measured.samples.pairs.size(), 8u);
    const glm::dvec3 wi = direction_from_angles(0.5, 1.0), wo = direction_from_angles(0.2, 3.0);
    const glm::dvec3 grey = evaluate(measured, wi, wo);
    // The white of the tabulated D65 and the one that Rec.2020 is defined by differ by 2e-4.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(grey[c], 0.25, 1e-4);
    for (const double value : evaluate_spectrum(measured, wi, wo)) EXPECT_NEAR(value, 0.25, 1e-9);
    EXPECT_EQ(evaluate(measured, wi, {0.6, 0.0, -0.8}), glm::dvec3(0.0));
}

TEST(MeasuredFiles, ReadCsvOfColoursAndOfWavelengths) {
    const glm::dvec3 wi = direction_from_angles(0.5, 1.0), wo = direction_from_angles(0.2, 3.0);
    const auto colours =
        measured_from(parse_measured_csv(csv_text(kAngles + "r,g,b", "0.5,-0.01,0.02"), "a.csv"),
                      MeasuredFormat::csv,
                      "a.csv");
    EXPECT_FALSE(colours.is_spectral());
    const glm::dvec3 rgb = rec709_from_working() * evaluate(colours, wi, wo);
    EXPECT_NEAR(rgb.x, 0.5, 1e-9);
    EXPECT_NEAR(rgb.y, -0.01, 1e-9);
    EXPECT_NEAR(rgb.z, 0.02, 1e-9);
    EXPECT_THROW(evaluate_spectrum(colours, wi, wo), std::invalid_argument);
    const auto spectra = parse_measured_csv(
        csv_text("theta_i,390 nm,theta_o,phi_i,phi_o,550nm,7.1e2", "1,2,3"), "a.csv");
    EXPECT_EQ(spectra.wavelengths_nm, (std::vector<double>{390.0, 550.0, 710.0}));
    EXPECT_EQ(spectra.values.size(), 24u);
    EXPECT_EQ(spectra.values[3], 0.0);
    EXPECT_EQ(spectra.values[4], 2.0);
}

TEST(MeasuredFiles, LeaveOutNegativeSamplesButNotSaturatedColours) {
    auto text = replaced(spectral_text("0.25"), "0.25", "-0.25");
    text += "0.9 0 0.3 0 1 1 1\n";
    const MeasuredSamples spectra = parse_spectral_samples(text, "a.brdf");
    EXPECT_EQ(spectra.masked, 1u);
    EXPECT_EQ(spectra.pairs.size(), 8u);
    // Blue without any light in it; a green that Rec.709 has no positive red for.
    auto csv = csv_text(kAngles + "r,g,b", "-0.1,0.5,0.1") + "0.2,0,0.2,0,0.3,0.2,-5\n";
    const MeasuredSamples colours = parse_measured_csv(csv, "a.csv");
    EXPECT_EQ(colours.masked, 1u);
    EXPECT_EQ(colours.pairs.size(), 8u);
}

TEST(MeasuredFiles, RefuseBadSpectralText) {
    const auto refuses = [](const std::string& text, auto... parts) {
        EXPECT_TRUE(
            fails_with([&] { parse_spectral_samples(text, "a.brdf"); }, {"a.brdf", parts...}))
            << text;
    };
    const std::string good = spectral_text("0.25");
    refuses("", "the end of the file", "the number of wavelengths");
    refuses("# only a comment", "the end of the file");
    refuses("three", "line 1: the number of wavelengths", "'three'", "a whole number");
    for (const char* count : {"0", "1", "-3", "2.5", "513", "600", "nan"}) {
        refuses(
            replaced(good, "\n3\n", "\n" + std::string(count) + "\n"), "line 3", count, "whole");
    }
    refuses("3\n400 500", "line 2", "the end of the file", "wavelengths");
    refuses(replaced(good, "550", "300"), "300 nm after 400 nm", "rising");
    refuses(replaced(good, "700", "650"), "400 to 650 nm", "400 to 700");
    refuses("2\n410 700\n", "410 to 700 nm", "400 to 700");
    refuses("2\n400 700\n", "0 usable samples (0 negative)", "8 or more");
    refuses(good + "0.1 0 0.3", "line 23", "the end of the file", "phi_o");
    refuses(good + "0.1 0 0.3 0 1 1", "the end of the file", "the value at 700 nm");
    refuses(replaced(good, "0.25", "nan"), "line 7: the value at 400 nm", "'nan'", "finite");
    refuses(replaced(good, "0.25", "1e10"), "the value at 400 nm", "at most 1e9");
    refuses(replaced(good, "0.25", "0,5x"), "'5x'", "finite");
    refuses(replaced(good, "0.3", "1.6"), "line 7: theta_o", "1.6", "from 0 to pi/2");
    refuses(replaced(good, "0.3", "-0.1"), "line 7: theta_o", "-0.1", "from 0 to pi/2");
    refuses(spectral_text("-1"), "0 usable samples (8 negative)", "8 or more");
    refuses("2\n400 700\n" + std::string("\0\1\2", 3), "line 3: theta_i", "finite");
}

TEST(MeasuredFiles, RefuseBadCsv) {
    const auto refuses = [](const std::string& text, auto... parts) {
        EXPECT_TRUE(fails_with([&] { parse_measured_csv(text, "a.csv"); }, {"a.csv", parts...}))
            << text;
    };
    const std::string good = csv_text(kAngles + "r,g,b", "0.1,0.2,0.3");
    refuses("", "nothing", "a header");
    refuses("r,g,b\n", "header", "'theta_i'", "wavelengths in nm");
    refuses(replaced(good, ",b\n", ",blue\n"), "header", "'b'");
    refuses(replaced(good, ",b\n", ",b,500\n"), "header", "'500'", "r, g, b or wavelengths");
    refuses(csv_text(kAngles + "400,red", "1,1"), "header", "'red'");
    refuses(csv_text(kAngles + "700,400", "1,1"), "wavelengths", "400 nm after 700 nm");
    refuses(csv_text("theta_i,phi_i,theta_o,phi_o", "1"), "wavelengths", "none", "400 to 700");
    refuses(replaced(good, "0.3,1,", "1.7,1,"), "line 3, theta_o", "'1.7'", "pi/2");
    refuses(replaced(good, "0.2,0.3", "nan,0.3"), "line 2, g", "'nan'", "finite");
    refuses(replaced(good, "0.2,0.3", "2e9,0.3"), "line 2, g", "2e9", "at most 1e9");
    refuses(good + "0.1,0,0.2", "line 10", "3 cells", "7, as in the header");
    refuses(kAngles + "r,g,b\n0,0,0,0,1,1,1\n", "1 usable samples", "8 or more");
}

TEST(MeasuredFiles, RefuseBadTables) {
    const auto refuses = [](const std::string& bytes, auto... parts) {
        EXPECT_TRUE(fails_with([&] { parse_merl(bytes, "a.binary"); }, {"a.binary", parts...}));
    };
    std::string bytes(kMerlBytes, '\0');
    const std::array<std::int32_t, 3> header{90, 90, 180};
    std::memcpy(bytes.data(), header.data(), 12);
    refuses("", "header", "0 bytes", "90, 90, 180");
    refuses(bytes.substr(0, 11), "header", "11 bytes");
    refuses(bytes.substr(0, kMerlBytes - 1), "34992011 bytes", "34992012");
    refuses(bytes + "x", "34992013 bytes", "34992012");
    auto other = bytes;
    const std::array<std::int32_t, 3> huge{2'000'000'000, 2'000'000'000, -5};
    std::memcpy(other.data(), huge.data(), 12);
    refuses(other, "2000000000 x 2000000000 x -5", "90 x 90 x 180");
    refuses(other.substr(0, 12), "2000000000 x 2000000000 x -5");
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e20}) {
        auto broken = bytes;
        const std::size_t bin = 7 + 180 * (3 + 90 * 2);
        std::memcpy(broken.data() + 12 + 8 * (bin + 90 * 90 * 180), &bad, 8);
        refuses(broken, "green of bin theta_h 2, theta_d 3, phi_d 7", "finite");
    }
    const double negative = -1.0;
    for (std::size_t at = 12; at < bytes.size(); at += 8) {
        std::memcpy(bytes.data() + at, &negative, 8);
    }
    refuses(bytes, "no measurement", "negative");
}

TEST(MeasuredFiles, AreKnownByTheirSuffix) {
    const TemporaryFolder folder;
    const auto brdf = folder.write("a b.BRDF", spectral_text("0.25"));
    EXPECT_TRUE(is_measured_file(brdf));
    EXPECT_EQ(read_measured_file(brdf).samples.pairs.size(), 8u);
    const auto csv = folder.write("a.csv", csv_text(kAngles + "r,g,b", "0.1,0.2,0.3"));
    EXPECT_EQ(read_measured_file(csv).format, MeasuredFormat::csv);
    EXPECT_FALSE(is_measured_file("a.json"));
    EXPECT_TRUE(fails_with([&] { read_measured_file(folder / "a.txt"); }, {"a.txt", ".binary"}));
    EXPECT_TRUE(fails_with([&] { read_measured_file(folder / "no.binary"); }, {"no such file"}));
    EXPECT_TRUE(fails_with([&] { read_measured_file(folder.write("b.binary", "short")); },
                           {"b.binary", "5 bytes"}));
}

}  // namespace
}  // namespace livery
