#include "calibration/colour/response.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "calibration/support/messages.h"
#include "core/error.h"
#include "core/random.h"

namespace livery {
namespace {

/// Least squares over every way to cut the sequence into constant runs that rise: the optimum of
/// isotonic regression is one of them.
std::vector<double> brute_force_isotonic(const std::vector<double>& values,
                                         const std::vector<double>& weights) {
    const std::size_t n = values.size();
    std::vector<double> best;
    double best_error = std::numeric_limits<double>::infinity();
    for (unsigned cuts = 0; cuts < (1u << (n - 1)); ++cuts) {
        std::vector<double> fit;
        double error = 0.0, before = -std::numeric_limits<double>::infinity();
        bool rising = true;
        for (std::size_t begin = 0; begin < n && rising;) {
            std::size_t end = begin + 1;
            while (end < n && !(cuts >> (end - 1) & 1u)) ++end;
            double sum = 0.0, weight = 0.0;
            for (std::size_t i = begin; i < end; ++i) {
                sum += weights[i] * values[i];
                weight += weights[i];
            }
            const double mean = sum / weight;
            rising = mean >= before;
            before = mean;
            for (std::size_t i = begin; i < end; ++i) {
                fit.push_back(mean);
                error += weights[i] * (values[i] - mean) * (values[i] - mean);
            }
            begin = end;
        }
        if (rising && error < best_error) {
            best_error = error;
            best = fit;
        }
    }
    return best;
}

TEST(IsotonicRegression, IsTheLeastSquaresOptimum) {
    Random random(11);
    for (int round = 0; round < 60; ++round) {
        const std::size_t n = 2 + random.below(8);
        std::vector<double> values, weights;
        for (std::size_t i = 0; i < n; ++i) {
            values.push_back(0.2 * static_cast<double>(i) + random.normal());
            weights.push_back(0.1 + 3.0 * random.uniform());
        }
        const auto expected = brute_force_isotonic(values, weights);
        const auto found = isotonic_regression(values, weights);
        ASSERT_EQ(found.size(), n);
        for (std::size_t i = 0; i < n; ++i)
            ASSERT_NEAR(found[i], expected[i], 1e-12) << "round " << round;
    }
    EXPECT_THROW(isotonic_regression(std::vector<double>{1.0}, std::vector<double>{0.0}),
                 std::invalid_argument);
    EXPECT_THROW(isotonic_regression(std::vector<double>{NAN}, std::vector<double>{1.0}),
                 std::invalid_argument);
}

TEST(NadarayaWatson, OfTwoSamplesIsALogisticCurve) {
    // Weights exp(-(x-a)^2/2h^2), exp(-(x-b)^2/2h^2): the ratio is a logistic function of x with
    // slope (b - a) / h^2 about the middle.
    const std::vector<double> n{0.3, 0.4}, drive{100.0, 150.0}, weight{1.0, 1.0};
    for (const double at : {0.2, 0.31, 0.35, 0.36, 0.44}) {
        const double expected =
            100.0 + 50.0 / (1.0 + std::exp(-(0.1 / (0.02 * 0.02)) * (at - 0.35)));
        EXPECT_NEAR(nadaraya_watson(n, drive, weight, 0.02, at), expected, 1e-9) << at;
    }
    EXPECT_TRUE(std::isnan(nadaraya_watson(n, drive, weight, 1e-4, 5.0)));
}

TEST(NadarayaWatson, OfAStraightLineOverAllNumbersIsTheLine) {
    std::vector<double> n, drive, weight;
    for (int i = -2000; i <= 3000; ++i) {
        n.push_back(i / 1000.0);
        drive.push_back(255.0 * i / 1000.0);
        weight.push_back(1.0);
    }
    EXPECT_NEAR(nadaraya_watson(n, drive, weight, 0.02, 0.37), 255.0 * 0.37, 1e-6);
}

TEST(KernelResponse, EqualsTheDefinitionOverTheRawSamples) {
    Random random(3);
    std::vector<ResponseSample> samples;
    std::vector<double> n, drive, weight;
    for (int i = 0; i < 4000; ++i) {
        const auto level = static_cast<std::uint8_t>(random.below(256));
        const double value = std::pow(level / 255.0, 2.2) + 0.004 * random.normal();
        samples.push_back({static_cast<float>(value), 1.0f, level});
        n.push_back(static_cast<double>(static_cast<float>(value)));
        drive.push_back(level);
        weight.push_back(1.0);
    }
    const ResponseCurve curve = kernel_response(samples, 0.02, 0.0, 1.0);
    ASSERT_EQ(curve.drive_from_n.size(), kResponseSize);
    // Gathering into cells a 64th of the bandwidth wide moves a sample by at most h / 128: second
    // order.
    for (std::size_t i = 0; i < kResponseSize; i += 97) {
        const double at = static_cast<double>(i) / static_cast<double>(kResponseSize - 1);
        EXPECT_NEAR(curve.drive_from_n[i], nadaraya_watson(n, drive, weight, 0.02, at), 0.02) << at;
    }
    for (std::size_t i = 1; i < kResponseSize; ++i)
        ASSERT_GE(curve.drive_from_n[i], curve.drive_from_n[i - 1]);
    EXPECT_HAS(message_of<Refused>([] { kernel_response({}, 0.02, 0.0, 1.0); }), "grey level");
}

LevelCurve gamma_curve(double gamma) {
    LevelCurve curve;
    for (std::size_t i = 0; i < 256; ++i) {
        curve.n[i] = std::pow(static_cast<double>(i) / 255.0, gamma);
        curve.weight[i] = 1e10;
    }
    return curve;
}

double n_at_drive_of(const ResponseCurve& curve, double n, double gamma) {
    const double place = n * static_cast<double>(kResponseSize - 1);
    const auto low = std::min(static_cast<std::size_t>(place), kResponseSize - 2);
    const double fraction = place - static_cast<double>(low);
    const double drive = static_cast<double>(curve.drive_from_n[low]) * (1.0 - fraction) +
                         static_cast<double>(curve.drive_from_n[low + 1]) * fraction;
    return std::pow(drive / 255.0, gamma);
}

TEST(InvertLevels, TurnsAGammaCurveRound) {
    for (const double gamma : {1.0, 1.8, 2.2, 2.8}) {
        const ResponseCurve curve = invert_levels(smooth_levels(gamma_curve(gamma)), 0, 255);
        EXPECT_LT(curve.largest_violation, 2e-4);  // the smoothed foot may ripple
        EXPECT_NEAR(curve.drive_from_n.front(), 0.0, 1e-3);
        EXPECT_NEAR(curve.drive_from_n.back(), 255.0, 1e-3);
        // What smoothing may move and chords cut: 2e-4 of N.
        for (const double n : {0.01, 0.05, 0.2, 0.5, 0.9, 0.99})
            EXPECT_NEAR(n_at_drive_of(curve, n, gamma), n, 2e-4) << gamma << " at " << n;
    }
}

// Blocks of grey on a mock-up whose parts light one another: each drive errs by 2%, as its weight
// says, and every tenth by 8%, which no weight says.
TEST(SmoothLevels, IsSmoothThoughSomeBlocksLieOff) {
    // About seven free parameters of 160 drives: 2% sqrt(7 / 160), half as much again.
    constexpr double kMost = 0.0063;
    double mean = 0.0;
    constexpr int kSeeds = 8;
    for (int seed = 0; seed < kSeeds; ++seed) {
        Random random(static_cast<std::uint64_t>(100 + seed));
        LevelCurve measured;
        for (std::size_t i = 1; i < 256; ++i) {
            const double n = std::pow(static_cast<double>(i) / 255.0, 2.2);
            const double sigma = 0.02 * n + 2e-4;
            measured.n[i] = n + (i % 10 == 3 ? 4.0 : 1.0) * sigma * random.normal();
            measured.weight[i] = 1.0 / (sigma * sigma);
        }
        const LevelCurve smooth = smooth_levels(measured);
        double square = 0.0, count = 0.0;
        for (std::size_t i = 96; i < 250; ++i, count += 1.0)
            square +=
                std::pow(smooth.n[i] / std::pow(static_cast<double>(i) / 255.0, 2.2) - 1.0, 2.0);
        mean += std::sqrt(square / count) / kSeeds;
    }
    EXPECT_LT(mean, kMost);
}

// A projector's own table may have a corner: with little noise it is followed, not smoothed away.
TEST(SmoothLevels, FollowsACornerThatNoiseDoesNotHide) {
    Random random(7);
    LevelCurve measured;
    const auto truth = [](std::size_t i) {
        const double x = static_cast<double>(i) / 255.0;
        return x < 0.5 ? 0.6 * x : 0.3 + 1.4 * (x - 0.5);
    };
    constexpr double kSigma = 5e-4;
    for (std::size_t i = 0; i < 256; ++i) {
        measured.n[i] = truth(i) + kSigma * random.normal();
        measured.weight[i] = 1.0 / (kSigma * kSigma);
    }
    const LevelCurve smooth = smooth_levels(measured);
    // At the corner itself a drive or two of its slope; elsewhere three deviations.
    for (std::size_t i = 0; i < 256; ++i)
        EXPECT_NEAR(smooth.n[i], truth(i), i > 118 && i < 138 ? 4e-3 : 3.0 * kSigma) << i;
}

TEST(SmoothLevels, AveragesNoiseAndBridgesGaps) {
    Random random(21);
    LevelCurve measured;
    const double sigma = 0.01;
    for (std::size_t i = 0; i < 256; ++i) {
        if (i % 5 != 0) continue;  // four of five drives were not seen
        measured.n[i] = std::pow(static_cast<double>(i) / 255.0, 2.2) + sigma * random.normal();
        measured.weight[i] = 1.0 / (sigma * sigma);
    }
    const LevelCurve smooth = smooth_levels(measured);
    double square = 0.0;
    for (std::size_t i = 0; i < 256; ++i) {
        const double error = smooth.n[i] - std::pow(static_cast<double>(i) / 255.0, 2.2);
        square += error * error;
    }
    // 52 samples, a curve of some six degrees of freedom: 0.01 sqrt(6/52) = 0.0034
    EXPECT_LT(std::sqrt(square / 256.0), 0.006);
    EXPECT_THROW(smooth_levels(LevelCurve{}), std::invalid_argument);
}

TEST(InvertLevels, ReportsAndMendsAFallingResponse) {
    LevelCurve curve = gamma_curve(2.2);
    curve.n[120] = curve.n[119] - 0.03;
    const ResponseCurve response = invert_levels(curve, 0, 255);
    EXPECT_NEAR(response.largest_violation, 0.03, 1e-9);
    for (std::size_t i = 1; i < kResponseSize; ++i)
        ASSERT_GE(response.drive_from_n[i], response.drive_from_n[i - 1]);

    LevelCurve flat;
    flat.weight.fill(1.0);
    EXPECT_HAS(message_of<Refused>([&] { invert_levels(flat, 0, 255); }), "do not get brighter");
    EXPECT_THROW(invert_levels(curve, 200, 100), std::invalid_argument);
}

TEST(LevelMeans, IgnoreStraysAndWeighByPrecision) {
    std::vector<ResponseSample> samples;
    Random random(5);
    for (int i = 0; i < 400; ++i)
        samples.push_back({static_cast<float>(0.5 + 0.01 * random.normal()), 1.0f, 100});
    for (int i = 0; i < 10; ++i) samples.push_back({9.0f, 1.0f, 100});
    samples.push_back({std::numeric_limits<float>::quiet_NaN(), 1.0f, 100});
    samples.push_back({0.2f, 3.0f, 50});
    samples.push_back({0.6f, 1.0f, 50});
    const LevelCurve curve = level_means(samples);
    EXPECT_NEAR(curve.n[100], 0.5, 5 * 0.01 / std::sqrt(400.0));
    EXPECT_NEAR(curve.n[50], 0.3, 1e-6);  // weights 3 : 1
    EXPECT_EQ(curve.weight[99], 0.0);
    // Inverse variance of the mean: 400 / 0.01^2, from 400 samples' own scatter
    EXPECT_NEAR(curve.weight[100] / (400.0 / 1e-4), 1.0, 0.3);
}

TEST(LevelMeans, AFewSamplesAreNoSurerThanOtherLevels) {
    // One sample scatters by nothing, two may agree by chance: neither is exact.
    std::vector<ResponseSample> samples;
    Random random(6);
    for (const std::uint8_t level : std::array<std::uint8_t, 3>{90, 100, 110})
        for (int i = 0; i < 50; ++i)
            samples.push_back({static_cast<float>(0.5 + 0.01 * random.normal()), 1.0f, level});
    samples.push_back({0.7f, 1.0f, 50});
    samples.push_back({0.7f, 1.0f, 60});
    samples.push_back({0.7f, 1.0f, 60});
    const LevelCurve curve = level_means(samples);
    for (const std::size_t level : {50u, 60u}) {
        EXPECT_GT(curve.weight[level], 0.0);
        EXPECT_LT(curve.weight[level], 2.0 / 1e-4);  // two samples of 0.01
    }
}

}  // namespace
}  // namespace livery
