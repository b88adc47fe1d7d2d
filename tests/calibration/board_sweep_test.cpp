// Lenses from boards against known ones, over numbers of poses, tilts and noise: errors beside the
// standard errors that are reported.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/geometry/solve_pair.h"
#include "calibration/registration/pixel_refinement.h"
#include "calibration/support/board_sights.h"
#include "core/error.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using testing::board_sights;
using testing::kCamera;
using testing::kProjector;
using testing::kTurns;
using testing::pair_truth;
using testing::PairTruth;

/// Lenses that k1 and k2 describe.
PairTruth truth() {
    PairTruth t = pair_truth();
    t.camera.distortion = {-0.12, 0.1, 0, 0, 0};
    return t;
}

/// `count` boards tilted by the angle, to all sides in turn, and turned in their plane.
std::vector<glm::dvec3> tilts(int count, double angle_rad) {
    std::vector<glm::dvec3> turns;
    for (int k = 0; k < count; ++k) {
        const double side = 2.4 * k;  // the golden angle: no two to the same side
        turns.emplace_back(angle_rad * std::cos(side), angle_rad * std::sin(side), 0.1 * k);
    }
    return turns;
}

/// Errors over their standard errors: fx, fy, cx, cy of both lenses, then the pair's turn and
/// shift.
std::vector<double> scores(const PairSolution& found, const PairTruth& t) {
    std::vector<double> all;
    const auto lens = [&](const View& view, const View& real, const std::array<double, 4>& sigma) {
        all.push_back((view.focal_px.x - real.focal_px.x) / sigma[0]);
        all.push_back((view.focal_px.y - real.focal_px.y) / sigma[1]);
        all.push_back((view.principal_px.x - real.principal_px.x) / sigma[2]);
        all.push_back((view.principal_px.y - real.principal_px.y) / sigma[3]);
    };
    lens(found.camera, t.camera, found.camera_standard_error_px);
    lens(found.projector, t.projector, found.projector_standard_error_px);
    const Rigid3& pair = found.projector.view_from_world;
    const Rigid3& real = t.projector.view_from_world;
    const glm::dmat3 off = pair.rotation * glm::transpose(real.rotation);
    const glm::dvec3 turn = axis_of(off) * angle_of(off);
    const glm::dvec3 shift = pair.translation - real.translation;
    for (int k = 0; k < 3; ++k)
        all.push_back(turn[k] / found.turn_standard_error_rad[static_cast<std::size_t>(k)]);
    for (int k = 0; k < 3; ++k)
        all.push_back(shift[k] / found.shift_standard_error_mm[static_cast<std::size_t>(k)]);
    return all;
}

// Of 20 x 14 scores, which share their noise by twenties, 0.3% are expected over 3 and their root
// mean square at 1; a wrong covariance (a factor of two, a unit) leaves 0.7 to 1.4.
TEST(BoardSweep, NightlyErrorsAreAsLargeAsTheirStandardErrorsSay) {
    std::vector<double> all;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const PairTruth t = truth();
        const auto found = solve_pair(board_sights(t, kTurns, 0.1, seed), kCamera, kProjector);
        for (const double score : scores(found, t)) all.push_back(score);
    }
    double squares = 0.0;
    for (const double score : all) squares += score * score / static_cast<double>(all.size());
    const auto beyond =
        std::count_if(all.begin(), all.end(), [](double score) { return std::abs(score) > 3.0; });
    std::printf("    %zu scores: root mean square %.3f, %td over 3\n",
                all.size(),
                std::sqrt(squares),
                beyond);
    EXPECT_GT(std::sqrt(squares), 0.7);
    EXPECT_LT(std::sqrt(squares), 1.4);
    EXPECT_LE(beyond, 6);
}

/// How far the truth lies from what was found, by the information on all terms together: as large
/// as the number of terms on average (Mahalanobis).
double distance_squared(const PairSolution& found, const PairTruth& t, int& terms) {
    Eigen::VectorXd off(kPairTerms);
    const auto lens = [&](Eigen::Index at, const View& view, const View& real) {
        off[at] = std::log(real.focal_px.x / view.focal_px.x);
        off[at + 1] = real.principal_px.x - view.principal_px.x;
        off[at + 2] = real.principal_px.y - view.principal_px.y;
        for (std::size_t k = 0; k < 5; ++k)
            off[at + 3 + static_cast<Eigen::Index>(k)] = real.distortion[k] - view.distortion[k];
    };
    lens(0, found.projector, t.projector);
    lens(kLensTerms, found.camera, t.camera);
    const Rigid3 pair = inverse(found.projector.view_from_world);
    const Rigid3 real = inverse(t.projector.view_from_world);
    const glm::dmat3 turned = real.rotation * glm::transpose(pair.rotation);
    const glm::dvec3 turn = axis_of(turned) * angle_of(turned);
    const glm::dvec3 shift = real.translation - turned * pair.translation;
    for (int k = 0; k < 3; ++k) {
        off[2 * kLensTerms + k] = turn[k];
        off[2 * kLensTerms + 3 + k] = shift[k];
    }
    const Eigen::Map<const Eigen::Matrix<double, kPairTerms, kPairTerms>> information(
        found.information.data());
    terms = static_cast<int>((information.diagonal().array() > 0.0).count());
    return off.dot(information * off);
}

// One focal length a lens: registration changes both of its axes together.
TEST(BoardSweep, TheInformationHoldsForAllTermsTogether) {
    constexpr int kSeeds = 12;
    double sum = 0.0;
    int terms = 0;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
        PairTruth t = truth();
        t.camera.focal_px.y = t.camera.focal_px.x;
        t.projector.focal_px.y = t.projector.focal_px.x;
        const auto found = solve_pair(board_sights(t, kTurns, 0.1, seed), kCamera, kProjector);
        EXPECT_TRUE(is_information(found.information));
        const double one = distance_squared(found, t, terms);
        std::printf("    seed %u: %.1f\n", seed, one);
        sum += one / kSeeds;
    }
    std::printf("    the truth lies %.1f away on average, of %d terms\n", sum, terms);
    EXPECT_EQ(terms, kPairTerms);
    EXPECT_LT(sum, 2.0 * terms);
    EXPECT_GT(sum, 0.5 * terms);
}

// Within four standard errors each: of 9 x 14 scores one in a thousand draws of seeds goes over.
// A board that was not fitted and has no noise is foretold within the noise of those that were: its
// own pose is exact, and hundreds of corners share some thirty unknowns.
TEST(BoardSweep, PosesTiltsAndNoise) {
    const PairTruth t = truth();
    const auto unseen = board_sights(t, {{0.3, -0.2, 0.4}}, 0.0, 1).front();
    struct Case {
        int poses;
        double tilt_rad, noise_px;
    };
    for (const Case& one : {Case{4, 0.35, 0.02},
                            Case{4, 0.6, 0.1},
                            Case{6, 0.17, 0.02},
                            Case{6, 0.35, 0.1},
                            Case{6, 0.6, 0.1},
                            Case{6, 0.6, 0.3},
                            Case{10, 0.35, 0.1},
                            Case{10, 0.35, 0.3},
                            Case{10, 0.6, 0.3}}) {
        const auto found = solve_pair(
            board_sights(t, tilts(one.poses, one.tilt_rad), one.noise_px, 3), kCamera, kProjector);
        const std::vector<double> all = scores(found, t);
        double worst = 0.0;
        for (const double score : all) worst = worse_of(worst, std::abs(score));
        const auto held_out = held_out_px(found, unseen);
        ASSERT_TRUE(held_out);
        std::printf(
            "    %2d poses, %2.0f degrees, %.2f px: focal %+.2f (+- %.2f), projector %+.2f "
            "(+- %.2f) px, apart %+.2f mm, unseen board %.3f px, worst score %.1f\n",
            one.poses,
            one.tilt_rad * 57.29578,
            one.noise_px,
            found.camera.focal_px.x - t.camera.focal_px.x,
            found.camera_standard_error_px[0],
            found.projector.focal_px.x - t.projector.focal_px.x,
            found.projector_standard_error_px[0],
            glm::length(found.projector.view_from_world.translation) -
                glm::length(t.projector.view_from_world.translation),
            *held_out,
            worst);
        EXPECT_LT(worst, 4.0);
        EXPECT_LT(*held_out, one.noise_px);
        // Noise in two coordinates.
        EXPECT_NEAR(found.camera_rms_px, std::sqrt(2.0) * one.noise_px, 0.15 * one.noise_px);
    }
}

// Ten times the noise of good photographs on boards that hardly tilt: nothing to be had.
TEST(BoardSweep, TooLittleTiltForTheNoiseIsRefused) {
    EXPECT_THROW(solve_pair(board_sights(truth(), tilts(4, 0.06), 1.0, 3), kCamera, kProjector),
                 Refused);
}

// The board is found from either end: what it is called turns about its middle, and nothing else.
TEST(BoardSweep, BoardsUpsideDownChangeNothing) {
    const PairTruth t = truth();
    auto sights = board_sights(t, kTurns, 0.1, 3);
    const auto straight = solve_leaving_each_out(sights, kCamera, kProjector);
    for (const std::size_t k : {0u, 3u, 4u}) {
        std::reverse(sights[k].camera_px.begin(), sights[k].camera_px.end());
        std::reverse(sights[k].projector_px.begin(), sights[k].projector_px.end());
    }
    const auto turned = solve_leaving_each_out(sights, kCamera, kProjector);
    // A hundredth of the standard errors: where the search stops, no more.
    for (std::size_t c = 0; c < 2; ++c) {
        const int axis = static_cast<int>(c);
        EXPECT_NEAR(turned.solution.camera.focal_px[axis],
                    straight.solution.camera.focal_px[axis],
                    0.01 * straight.solution.camera_standard_error_px[c]);
        EXPECT_NEAR(turned.solution.projector.focal_px[axis],
                    straight.solution.projector.focal_px[axis],
                    0.01 * straight.solution.projector_standard_error_px[c]);
    }
    EXPECT_NEAR(turned.held_out_rms_px, straight.held_out_rms_px, 1e-3);
}

}  // namespace
}  // namespace livery
