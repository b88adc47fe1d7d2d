#include "core/colour.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace livery {
namespace {

TEST(Colour, Ciede2000MatchesSharmasPairs) {
    std::ifstream file(std::filesystem::path(LIVERY_TEST_DATA) / "ciede2000-pairs.csv");
    std::string line;
    std::getline(file, line);
    int pairs = 0;
    while (std::getline(file, line)) {
        std::stringstream stream(line);
        double v[8];
        char comma;
        for (int k = 0; k < 8; ++k) {
            stream >> v[k];
            stream >> comma;
        }
        // The published values have four decimals.
        EXPECT_NEAR(ciede2000({v[1], v[2], v[3]}, {v[4], v[5], v[6]}), v[7], 1e-4) << v[0];
        EXPECT_NEAR(ciede2000({v[4], v[5], v[6]}, {v[1], v[2], v[3]}), v[7], 1e-4) << v[0];
        ++pairs;
    }
    EXPECT_EQ(pairs, 34);
}

TEST(Colour, Ciede2000OfWhatIsNoNumberIsNone) {
    // Nothing would be a perfect match.
    const double nan = std::nan("");
    for (int c = 0; c < 3; ++c) {
        glm::dvec3 spoiled(50.0, 10.0, -20.0);
        spoiled[c] = nan;
        EXPECT_TRUE(std::isnan(ciede2000(spoiled, {50.0, 10.0, -20.0}))) << c;
        EXPECT_TRUE(std::isnan(ciede2000({50.0, 10.0, -20.0}, spoiled))) << c;
    }
    EXPECT_TRUE(std::isnan(ciede2000(lab_from_xyz(glm::dvec3(nan), d65_xyz()), glm::dvec3(0.0))));
}

TEST(Colour, Ciede2000MatchesItsHardestPairs) {
    // Sharma, Wu, Dalal 2005, table 1, pairs 1, 4, 7, 13, 17 and 19.
    EXPECT_NEAR(ciede2000({50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 1e-4);
    EXPECT_NEAR(ciede2000({50, -1.3802, -84.2814}, {50, 0, -82.7485}), 1.0000, 1e-4);
    EXPECT_NEAR(ciede2000({50, 0, 0}, {50, -1, 2}), 2.3669, 1e-4);
    EXPECT_NEAR(ciede2000({50, -0.001, 2.49}, {50, 0.0009, -2.49}), 4.8045, 1e-4);
    EXPECT_NEAR(ciede2000({50, 2.5, 0}, {73, 25, -18}), 27.1492, 1e-4);
    EXPECT_NEAR(ciede2000({50, 2.5, 0}, {56, -27, -3}), 31.9030, 1e-4);
    EXPECT_EQ(ciede2000({50, 2.5, 0}, {50, 2.5, 0}), 0.0);
}

/// Compares a matrix with published rows.
void expect_rows(const glm::dmat3& matrix, const double (&rows)[9], double tolerance) {
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            EXPECT_NEAR(matrix[column][row], rows[3 * row + column], tolerance)
                << "row " << row << ", column " << column;
        }
    }
}

TEST(Colour, MatricesAreThePublishedOnes) {
    // IEC 61966-2-1 prints four decimals.
    expect_rows(xyz_from_rec709(),
                {0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505},
                1e-4);
    // Rec.2020 as tabulated with six.
    expect_rows(xyz_from_working(),
                {0.636958, 0.144617, 0.168881, 0.262700, 0.677998, 0.059302, 0, 0.028073, 1.060985},
                1e-6);
    // ITU-R BT.2087-0, from 709 to 2020.
    expect_rows(working_from_rec709(),
                {0.6274, 0.3293, 0.0433, 0.0691, 0.9195, 0.0114, 0.0164, 0.0880, 0.8956},
                1e-4);
    // ACES AP1 with its own white, S-2014-004.
    expect_rows(
        xyz_from_rgb_matrix({0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}),
        {0.6624541811,
         0.1340042065,
         0.1561876870,
         0.2722287168,
         0.6740817658,
         0.0536895174,
         -0.0055746495,
         0.0040607335,
         1.0103391003},
        1e-6);
}

TEST(Colour, SrgbCurveHasItsKnownValues) {
    EXPECT_NEAR(srgb_encode(0.5), 0.735356983, 1e-9);
    EXPECT_NEAR(srgb_decode(0.5), 0.214041140, 1e-9);
    EXPECT_NEAR(srgb_decode(128.0 / 255.0), 0.215860500, 1e-9);
    EXPECT_NEAR(srgb_encode(0.002), 12.92 * 0.002, 1e-15);
    EXPECT_EQ(srgb_encode(0.0), 0.0);
    EXPECT_NEAR(srgb_encode(1.0), 1.0, 1e-15);
    // The standard's two pieces meet to within its rounding.
    EXPECT_NEAR(srgb_encode(0.0031308), srgb_encode(0.00313081), 1e-6);
    EXPECT_EQ(srgb_encode(-0.5), -srgb_encode(0.5));
    EXPECT_EQ(srgb_decode(-0.5), -srgb_decode(0.5));
}

TEST(Colour, LabHasItsKnownValues) {
    const auto white = d65_xyz();
    const auto lab = [&](double factor) { return lab_from_xyz(factor * white, white); };
    EXPECT_NEAR(lab(1.0).x, 100.0, 1e-12);
    EXPECT_NEAR(lab(0.18).x, 49.4961, 1e-4);
    EXPECT_NEAR(lab(0.005).x, 0.005 * 24389.0 / 27.0, 1e-9);  // below the cube root's part
    EXPECT_NEAR(lab(0.5).y, 0.0, 1e-12);
    // sRGB red, as tabulated widely (from rounded matrices).
    const auto red = lab_from_xyz(xyz_from_rec709() * glm::dvec3(1, 0, 0), white);
    EXPECT_NEAR(red.x, 53.24, 0.02);
    EXPECT_NEAR(red.y, 80.09, 0.03);
    EXPECT_NEAR(red.z, 67.20, 0.03);
}

TEST(Colour, OklabHasItsAuthorsValues) {
    // Ottosson's table, three decimals.
    const struct {
        glm::dvec3 xyz, oklab;
    } rows[] = {{{0.950, 1.000, 1.089}, {1.000, 0.000, 0.000}},
                {{1.000, 0.000, 0.000}, {0.450, 1.236, -0.019}},
                {{0.000, 1.000, 0.000}, {0.922, -0.671, 0.263}},
                {{0.000, 0.000, 1.000}, {0.153, -1.415, -0.449}}};
    for (const auto& row : rows) {
        const auto oklab = oklab_from_xyz(row.xyz);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(oklab[k], row.oklab[k], 0.0011);
    }
}

TEST(Colour, SpacesRoundTrip) {
    const glm::dvec3 xyz(0.2, 0.35, 0.1);
    const auto near = [](glm::dvec3 a, glm::dvec3 b) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-9);
    };
    near(xyz_from_rec709() * (rec709_from_xyz() * xyz), xyz);
    near(xyz_from_lab(lab_from_xyz(xyz, d65_xyz()), d65_xyz()), xyz);
    near(xyz_from_oklab(oklab_from_xyz(xyz)), xyz);
    near(xyz_from_rec709() * glm::dvec3(1.0), d65_xyz());
    near(xyz_from_working() * glm::dvec3(1.0), d65_xyz());
    EXPECT_NEAR(srgb_decode(srgb_encode(0.18)), 0.18, 1e-12);
}

}  // namespace
}  // namespace livery
