// Poses from picked points: exact, with bad clicks, and from points that hold no pose.
#include "calibration/registration/picked_points.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "calibration/registration/rotation.h"
#include "core/error.h"
#include "core/random.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"
#include "twin/description.h"

namespace livery {
namespace {

const Bounds kCar{{-90.0, 0.0, -38.0}, {90.0, 55.0, 38.0}};

class PickedPoints : public ::testing::Test {
  protected:
    PickedPoints() : view_(read_bench_file("default").camera.view) {}

    std::vector<MeshPick> picked(const std::vector<glm::dvec3>& places, double noise_px) {
        std::vector<MeshPick> points;
        for (const glm::dvec3& place : places)
            points.push_back(
                {place,
                 *project(view_, place) + noise_px * glm::dvec2(random_.normal(), random_.normal()),
                 "line " + std::to_string(points.size() + 2)});
        return points;
    }
    std::string refused(const std::vector<MeshPick>& points) const {
        const std::string said = message_of([&] { pose_from_points(view_, points, kCar); });
        std::printf("    %s\n", said.c_str());
        return said;
    }
    double error_px(const PickedPose& pose) const {
        return error_px(view_, view_.view_from_world, pose.view_from_mesh);
    }
    /// Largest distance in the picture over the box.
    static double error_px(const View& lens, const Rigid3& by_truth, const Rigid3& by_pose) {
        View truth = lens, found = lens;
        truth.view_from_world = by_truth;
        found.view_from_world = by_pose;
        double largest = 0.0;
        for (int k = 0; k < 8; ++k) {
            const glm::dvec3 corner((k & 1) ? kCar.high.x : kCar.low.x,
                                    (k & 2) ? kCar.high.y : kCar.low.y,
                                    (k & 4) ? kCar.high.z : kCar.low.z);
            largest =
                std::max(largest, glm::length(*project(truth, corner) - *project(found, corner)));
        }
        return largest;
    }

    View view_;
    Random random_{4};
    const std::vector<glm::dvec3> six_ = {
        {-80, 12, 30}, {75, 15, 32}, {10, 50, 20}, {-20, 52, -18}, {60, 30, -20}, {-70, 28, -25}};
};

TEST_F(PickedPoints, GiveThePoseExactly) {
    const PickedPose pose = pose_from_points(view_, picked(six_, 0.0), kCar);
    EXPECT_LT(error_px(pose), 1e-3);
    EXPECT_LT(pose.rms_px, 1e-4);
    EXPECT_EQ(pose.inliers.size(), 6u);
    EXPECT_FALSE(pose.bad);
}

/// Clicks at random places of the car by hands of any steadiness: what is off where in the picture
/// that somebody picked in, and in the one that is projected.
TEST_F(PickedPoints, HoldWithinTwoOfTheirOwnSigmas) {
    constexpr int kSetUps = 100;
    const View projector = read_bench_file("default").projector.view;
    const Rigid3 projector_from_picked = projector.view_from_world * inverse(view_.view_from_world);
    int held = 0, held_projected = 0, found = 0, inside = 0;
    double squares[6] = {};
    for (int k = 0; found < kSetUps && k < 3 * kSetUps; ++k) {
        std::vector<glm::dvec3> places;
        const auto count = 6 + random_.below(6);
        while (places.size() < count) {
            const glm::dvec3 share(random_.uniform(), random_.uniform(), random_.uniform());
            places.push_back(glm::mix(kCar.low, kCar.high, share));
        }
        const double noise_px = 0.3 + 2.0 * random_.uniform();
        PickedPose pose;
        try {
            pose = pose_from_points(view_, picked(places, noise_px), kCar);
        } catch (const Refused&) {
            continue;  // by chance too near to one another
        }
        ++found;
        const double said = held_px(view_, Rigid3{}, pose, kCar);
        const double said_projected = held_px(projector, projector_from_picked, pose, kCar);
        held += error_px(pose) < 2.0 * said;
        const Rigid3 by_truth = projector_from_picked * view_.view_from_world,
                     by_pose = projector_from_picked * pose.view_from_mesh;
        held_projected += error_px(projector, by_truth, by_pose) < 2.0 * said_projected;
        // The covariance is of what is applied after the pose
        const Rigid3 off = view_.view_from_world * inverse(pose.view_from_mesh);
        const glm::dvec3 turn = angle_of(off.rotation) * axis_of(off.rotation);
        const double six[6] = {
            turn.x, turn.y, turn.z, off.translation.x, off.translation.y, off.translation.z};
        bool all = true;
        for (std::size_t c = 0; c < 6; ++c) {
            const double sigma = std::sqrt(pose.covariance[7 * c]);
            squares[c] += six[c] * six[c] / (sigma * sigma);
            all = all && std::abs(six[c]) < 3.0 * sigma;
        }
        inside += all;
    }
    std::printf(
        "    of %d set-ups within two sigmas: %d in the picture picked in, %d in the "
        "projector's; all six numbers within three: %d\n",
        found,
        held,
        held_projected,
        inside);
    for (const double sum : squares) std::printf("    %.2f sigma (rms)\n", std::sqrt(sum / found));
    ASSERT_EQ(found, kSetUps);
    // Two of a normal distribution's hold in 95 of a hundred; a corner's distance, the farthest of
    // eight, in fewer, and deviations of a few clicks are known to a third
    EXPECT_GE(held, 88);
    EXPECT_GE(held_projected, 88);
    EXPECT_GE(inside, 85);
    for (const double sum : squares) {
        EXPECT_GT(std::sqrt(sum / found), 0.6);
        EXPECT_LT(std::sqrt(sum / found), 1.5);
    }
}

TEST_F(PickedPoints, NameOneBadClick) {
    for (std::size_t bad = 0; bad < six_.size(); ++bad) {
        auto points = picked(six_, 0.3);
        points[bad].pixel += glm::dvec2(60.0, -35.0);
        const PickedPose pose = pose_from_points(view_, points, kCar);
        ASSERT_TRUE(pose.bad) << bad;
        EXPECT_EQ(*pose.bad, bad);
        EXPECT_LT(error_px(pose), 12.0);
    }
}

TEST_F(PickedPoints, KeepAllWhereNoneIsBad) {
    for (int k = 0; k < 10; ++k) EXPECT_FALSE(pose_from_points(view_, picked(six_, 1.0), kCar).bad);
}

TEST_F(PickedPoints, RefuseWhatHoldsNoPose) {
    auto few = picked(six_, 0.0);
    few.pop_back();
    EXPECT_NE(refused(few).find("5 distinct points"), std::string::npos);
    auto doubled = picked(six_, 0.0);
    doubled[5] = doubled[2];
    EXPECT_NE(refused(doubled).find("5 distinct points"), std::string::npos);
    std::vector<glm::dvec3> line, plane, near;
    for (int k = 0; k < 7; ++k) {
        line.emplace_back(-80.0 + 23.0 * k, 20.0 + 0.1 * k * k, 5.0);
        plane.emplace_back(4.0 * (k % 3), 50.0, 3.0 * (k / 3) + 0.5 * k);
        near.emplace_back(3.0 * (k % 3), 50.0 + 1.5 * (k % 2), 2.0 * (k / 3) + 0.5 * k);
    }
    EXPECT_NE(refused(picked(line, 0.0)).find("on a line"), std::string::npos);
    EXPECT_NE(refused(picked(plane, 0.3)), "");
    EXPECT_NE(refused(picked(near, 0.3)), "");
    auto wrong = picked(six_, 0.0);
    std::swap(wrong[0].pixel, wrong[1].pixel);
    std::swap(wrong[2].pixel, wrong[5].pixel);
    EXPECT_NE(refused(wrong), "");
}

TEST_F(PickedPoints, AreReadFromAFile) {
    const TemporaryFolder folder;
    folder.write("points.csv", "x_mm,y_mm,z_mm,u_px,v_px\n1,2,3,10,20\n");
    const auto points = read_picked_points(folder / "points.csv");
    ASSERT_EQ(points.size(), 1u);
    EXPECT_EQ(points[0].mesh_mm, glm::dvec3(1, 2, 3));
    EXPECT_EQ(points[0].pixel, glm::dvec2(10.5, 20.5));
    EXPECT_EQ(points[0].name, "line 2");
    folder.write("bad.csv", "x_mm,y_mm,z_mm,u_px\n1,2,3,10\n");
    EXPECT_NE(message_of([&] { read_picked_points(folder / "bad.csv"); }).find("v_px"),
              std::string::npos);
}

}  // namespace
}  // namespace livery
