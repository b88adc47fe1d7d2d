// The colours of the 10 degree observer, from spectra and from what the 2 degree observer sees.
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/spectrum.h"
#include "core/working_space_study.h"
#include "support/reference_data.h"

namespace livery {
namespace {

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double within) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], within) << c;
}

TEST(TenDegree, HasTheWhiteOfTheTables) {
    // ASTM E308 gives 94.811, 100, 107.304, from 1 nm steps over a wider range.
    expect_near(d65_xyz10(), {0.94811, 1.0, 1.07304}, 3e-4);
    EXPECT_DOUBLE_EQ(d65_xyz10().y, 1.0);
    // Both observers' functions have the same area in each channel.
    for (const Spectrum* channel : {&cie1964_x(), &cie1964_y(), &cie1964_z()}) {
        EXPECT_NEAR(std::accumulate(channel->begin(), channel->end(), 0.0), 23.332, 0.003);
    }
    EXPECT_EQ(std::max_element(cie1964_y().begin(), cie1964_y().end()) - cie1964_y().begin(),
              (555 - 380) / 5);
}

TEST(TenDegree, KeepsNeutralsAndGoesBack) {
    for (const double grey : {0.0, 0.001, 0.18, 1.0, 2.5}) {
        expect_near(xyz10_from_xyz(grey * d65_xyz()), grey * d65_xyz10(), 1e-12);
    }
    for (const glm::dvec3 rec709 :
         {glm::dvec3(0.5, 0.02, 0.03), glm::dvec3(-0.05, 0.4, 0.1), glm::dvec3(0.0, 0.1, 0.9)}) {
        const glm::dvec3 xyz = xyz_from_rec709() * rec709;
        expect_near(xyz_from_xyz10(xyz10_from_xyz(xyz)), xyz, 1e-12);
    }
    expect_near(lab10_from_xyz10(d65_xyz10()), {100.0, 0.0, 0.0}, 1e-9);
    expect_near(lab10_from_xyz10(xyz10_from_lab10({45.0, 30.0, -20.0})), {45.0, 30.0, -20.0}, 1e-9);
}

TEST(TenDegree, IsForetoldFromTwoDegrees) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    std::vector<double> as_it_is, foretold;
    for (const Spectrum& reflectance : read_study_reflectances(data)) {
        const glm::dvec3 xyz = xyz_from_reflectance(reflectance, illuminant_d65());
        const glm::dvec3 truth = lab10_from_xyz10(xyz10_from_reflectance(reflectance));
        as_it_is.push_back(ciede2000(lab_from_xyz(xyz, d65_xyz()), truth));
        foretold.push_back(ciede2000(lab10_from_xyz10(xyz10_from_xyz(xyz)), truth));
    }
    const auto quantile = [](std::vector<double>& values, double fraction) {
        std::sort(values.begin(), values.end());
        return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
    };
    for (auto* values : {&as_it_is, &foretold}) {
        std::printf("10 degrees %s: CIEDE2000 median %.2f, 95%% %.2f, worst %.2f\n",
                    values == &as_it_is ? "taken for 2" : "foretold  ",
                    quantile(*values, 0.5),
                    quantile(*values, 0.95),
                    quantile(*values, 1.0));
    }
    EXPECT_LT(quantile(foretold, 0.5), 0.7);
    EXPECT_LT(quantile(foretold, 0.95), 2.1);
    EXPECT_GT(quantile(as_it_is, 0.5), 2.5 * quantile(foretold, 0.5));
}

}  // namespace
}  // namespace livery
