#include "core/colour.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "support/reference_data.h"

namespace livery {
namespace {

TEST(Colour, Ciede2000MatchesSharmasPairs) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    std::ifstream file(data / "spectral/ciede2000_sharma34.csv");
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
