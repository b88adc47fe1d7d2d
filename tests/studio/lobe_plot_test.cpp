#include <gtest/gtest.h>

#include "studio/paint/paint_portrait.h"

namespace livery {
namespace {

std::vector<LobePoint> curve_up_to(double value) {
    return {{-0.5, glm::dvec3(0.01)}, {0.5, glm::dvec3(value)}};
}

TEST(LobePlot, LogarithmsReachFromThousandthsToThePowerOfTenAboveThePeak) {
    LobePlot plot;
    const auto curve = curve_up_to(37.0);
    plot.curve = &curve;
    const RadialScale scale = scale_for(plot);
    EXPECT_DOUBLE_EQ(scale.highest, 100.0);
    EXPECT_NEAR(scale.lowest, 1e-3, 1e-15);
    EXPECT_DOUBLE_EQ(scale.radius(100.0), 1.0);
    EXPECT_DOUBLE_EQ(scale.radius(1e-3), 0.0);
    EXPECT_NEAR(scale.radius(1.0), 0.6, 1e-12);
    EXPECT_DOUBLE_EQ(scale.radius(0.0), 0.0);
    EXPECT_DOUBLE_EQ(scale.radius(-1.0), 0.0);
    EXPECT_DOUBLE_EQ(scale.radius(1e9), 1.0);
}

TEST(LobePlot, AMirrorsDecadesAreAtMostSixAndABlackPaintHasSome) {
    LobePlot plot;
    const auto mirror = curve_up_to(3e6), black = curve_up_to(0.0);
    plot.curve = &mirror;
    EXPECT_NEAR(scale_for(plot).highest / scale_for(plot).lowest, 1e6, 1.0);
    plot.curve = &black;
    EXPECT_GE(scale_for(plot).highest / scale_for(plot).lowest, 99.0);
    plot.curve = nullptr;
    EXPECT_GT(scale_for(plot).highest, scale_for(plot).lowest);
}

TEST(LobePlot, HoldsBothCurvesInProportionToo) {
    LobePlot plot;
    const auto own = curve_up_to(0.7), other = curve_up_to(4.2);
    plot.curve = &own;
    plot.logarithmic = false;
    EXPECT_DOUBLE_EQ(scale_for(plot).highest, 1.0);
    plot.compared = &other;
    const RadialScale scale = scale_for(plot);
    EXPECT_DOUBLE_EQ(scale.highest, 5.0);
    EXPECT_DOUBLE_EQ(scale.radius(2.5), 0.5);
}

}  // namespace
}  // namespace livery
