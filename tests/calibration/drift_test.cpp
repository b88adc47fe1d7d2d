// What has moved, and what has become brighter, in pictures that were moved and brightened.
#include "calibration/drift.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "support/message_of.h"

namespace livery {
namespace {

constexpr int kCameraWidth = 480, kCameraHeight = 320;

/// A lit disc with waves of light on it, as smooth as a lens leaves them; moved by `by`.
double light_at(double x, double y, glm::dvec2 by) {
    const double u = x - by.x - 240.0, v = y - by.y - 160.0;
    const double disc = 1.0 / (1.0 + std::exp((std::hypot(u, v) - 120.0) / 1.5));
    return disc *
           (0.6 + 0.2 * std::sin(u / 5.0) * std::cos(v / 7.0) + 0.1 * std::sin((u + v) / 19.0));
}

struct Then {
    glm::dvec2 moved{0.0};
    double light = 1.0, room = 0.01, noise = 0.002;
    std::uint64_t seed = 1;
};

DriftReference seen(const Then& at) {
    Random random(at.seed, 3);
    Photograph white, black;
    white.image = ImageF(kCameraWidth, kCameraHeight, 3);
    black.image = ImageF(kCameraWidth, kCameraHeight, 3);
    for (int y = 0; y < kCameraHeight; ++y)
        for (int x = 0; x < kCameraWidth; ++x)
            for (int c = 0; c < 3; ++c) {
                const auto noise = [&] { return at.noise * (2.0 * random.uniform() - 1.0); };
                const double light = at.light * light_at(x, y, at.moved);
                white.image.at(x, y, c) = static_cast<float>(at.room + light + noise());
                black.image.at(x, y, c) = static_cast<float>(at.room + noise());
            }
    return drift_reference(white, black, 0);
}

const DriftReference& then() {
    static const DriftReference reference = seen({});
    return reference;
}

TEST(Drift, IsNoneWhereNothingMoved) {
    const Drift drift = drift_between(then(), seen({{0.0, 0.0}, 1.0, 0.01, 0.002, 2}));
    EXPECT_GT(drift.blocks, 30);
    EXPECT_EQ(drift.lost, 0);
    EXPECT_LT(drift.shift_p95_px, 0.05);
    EXPECT_NEAR(drift.room_light, 0.0, 1e-3);
    for (const GradedFigure& figure : grade_figures(drift))
        EXPECT_EQ(figure.grade, Grade::good) << figure.name << " " << figure.value;
}

// From a hundredth of what matters to farther than anybody bumps a table.
TEST(Drift, FindsHowFarThingsMoved) {
    for (const double far : {0.1, 0.4, 1.5, 6.0, 20.0, 45.0}) {
        const glm::dvec2 by = far * glm::dvec2(0.8, -0.6);
        const Drift drift = drift_between(then(), seen({by, 1.0, 0.01, 0.002, 3}));
        SCOPED_TRACE(far);
        EXPECT_NEAR(drift.shift_median_px, far, 0.05 + 0.02 * far);
        EXPECT_GT(drift.blocks, drift.lost);
    }
}

TEST(Drift, TellsLightFromMovement) {
    const Drift drift = drift_between(then(), seen({{0.0, 0.0}, 0.8, 0.05, 0.002, 4}));
    EXPECT_LT(drift.shift_p95_px, 0.1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(drift.light_ratio[c], 0.8, 0.002);
    // The room's light over the disc's middle light, about 0.6
    EXPECT_NEAR(drift.room_light, 0.04 / 0.6, 0.02);
    const auto figures = grade_figures(drift);
    EXPECT_EQ(figures[0].grade, Grade::good);
    EXPECT_EQ(figures[1].grade, Grade::bad);
    EXPECT_EQ(figures[2].grade, Grade::bad);
}

TEST(Drift, IsTooFarToSayForAnotherScene) {
    DriftReference other = seen({{0.0, 0.0}, 1.0, 0.01, 0.002, 5});
    Random random(6, 1);
    for (float& value : other.white.values) value = static_cast<float>(random.uniform());
    const Drift drift = drift_between(then(), other);
    EXPECT_GT(drift.lost, drift.blocks);
    EXPECT_EQ(grade_figures(drift)[0].grade, Grade::bad);
    EXPECT_EQ(grade_figures(drift)[0].value, "too far to say");
}

TEST(Drift, RefusesWhatCannotBeCompared) {
    const std::string cap = message_of([] {
        drift_between(then(), seen({{0.0, 0.0}, 0.0, 0.01, 0.002, 7}));
    });
    EXPECT_NE(cap.find("no light of the projector"), std::string::npos) << cap;
    DriftReference flat = then();
    for (std::size_t i = 0; i < flat.white.values.size(); ++i)
        flat.white.values[i] = flat.black.values[i] + 0.5f;
    EXPECT_NE(message_of([&] { drift_between(flat, flat); }).find("detail"), std::string::npos);
    DriftReference other = then();
    other.white = ImageF(kCameraWidth / 2, kCameraHeight / 2, 1);
    EXPECT_THROW(drift_between(then(), other), FileError);
}

}  // namespace
}  // namespace livery
