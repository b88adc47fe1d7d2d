// Camera against projector from correspondences alone, and a mesh registered with nothing else.
#include "calibration/registration/pair_pose.h"

#include <cstdio>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/registration/register_scan.h"
#include "calibration/registration/rotation.h"
#include "calibration/support/bench_world.h"
#include "core/error.h"

namespace livery {
namespace {

using testing::bench_world;
using testing::BenchWorld;
using testing::traced_sight;

/// How the camera truly stands to the projector.
Rigid3 true_pair(const BenchWorld& world) {
    return world.projector.view_from_world * inverse(world.camera.view_from_world);
}

TEST(PairPose, IsRightToTheNoiseWhereTheLensesAre) {
    for (const char* name : {"default", "paper-2.75m"}) {
        const BenchWorld world = bench_world(name);
        const Sight sight = traced_sight(world.all, world.projector, world.camera, 0.1, 1);
        const Rigid3 truth = true_pair(world);
        const double distance = glm::length(truth.translation);
        const PairPose found = pose_of_pair(world.camera, world.projector, sight.map, distance);
        const double turn =
            angle_of(found.projector_from_camera.rotation * glm::transpose(truth.rotation));
        const double shift =
            glm::length(found.projector_from_camera.translation - truth.translation) / distance;
        std::printf("    %s: turn off by %.5f (sigma %.5f), shift by %.5f (sigma %.5f); %.3f px\n",
                    name,
                    turn,
                    found.turn_sigma_rad,
                    shift,
                    found.shift_sigma_rad,
                    found.median_px);
        EXPECT_LT(turn, 4.0 * found.turn_sigma_rad);
        EXPECT_LT(shift, 4.0 * found.shift_sigma_rad);
        EXPECT_GT(found.inlier_share, 0.95);
        EXPECT_NEAR(glm::length(found.projector_from_camera.translation), distance, 1e-6);
    }
}

// What a room without boards has: focal lengths from data sheets, 1% off each way, distortion
// unknown, a tape between the lenses. The mesh makes the rest exact.
TEST(PairPose, IsEnoughToRegisterTheMockup) {
    const BenchWorld world = bench_world("default");
    Sight sight = traced_sight(world.all, world.projector, world.camera, 0.1, 1);
    const double distance = glm::length(true_pair(world).translation);
    View projector = world.projector;
    for (View* view : {&projector, &sight.camera}) {
        view->distortion = {};
        view->focal_px *= view == &projector ? 0.99 : 1.01;
        view->principal_px.x = 0.5 * view->width;
    }
    sight.camera.principal_px.y = 0.5 * sight.camera.height;
    projector.principal_px.y = (0.5 + 0.45) * projector.height;
    const PairPose pair = pose_of_pair(sight.camera, projector, sight.map, 1.02 * distance);
    std::printf("    pair: %.2f px, turn sigma %.5f, shift sigma %.5f\n",
                pair.median_px,
                pair.turn_sigma_rad,
                pair.shift_sigma_rad);
    sight.camera.view_from_world = Rigid3{};
    projector.view_from_world = pair.projector_from_camera;
    RegistrationOptions options;
    options.prior = data_sheet_prior();
    const Registration found = register_scan(world.product, projector, {sight}, options);
    const testing::DrawnErrors errors = testing::drawn_errors(world, found.refined.projector);
    std::printf("    %.3f px median, %.3f px at 95%%; residual %.3f px; %zu of %zu\n",
                errors.median_px,
                errors.p95_px,
                found.refined.rms_px,
                found.refined.inliers,
                found.refined.correspondences);
    for (const Refined& one : found.refined.lens)
        std::printf("        %s %+.5f +- %.5f (before %.5f)\n",
                    one.name.c_str(),
                    one.change,
                    one.sigma,
                    one.prior);
    EXPECT_LT(errors.median_px, 0.5);
    EXPECT_LT(errors.p95_px, 1.0);
}

TEST(PairPose, RefusesOnePlaneMirrorsAndNothing) {
    BenchWorld world = bench_world("default");
    const double distance = glm::length(true_pair(world).translation);
    ProjectorToCamera none;
    none.camera_px = ImageF(
        world.projector.width, world.projector.height, 2, std::numeric_limits<float>::quiet_NaN());
    EXPECT_THROW(pose_of_pair(world.camera, world.projector, none, distance), Refused);
    EXPECT_THROW(pose_of_pair(world.camera, world.projector, none, -1.0), std::invalid_argument);

    Sight sight = traced_sight(world.all, world.projector, world.camera, 0.1, 1);
    ProjectorToCamera mirrored = sight.map;
    for (std::size_t i = 0; i < mirrored.camera_px.pixel_count(); ++i) {
        float& x = mirrored.camera_px.values[2 * i];
        x = static_cast<float>(world.camera.width) - x;
    }
    EXPECT_THROW(pose_of_pair(world.camera, world.projector, mirrored, distance), Refused);

    Mesh wall;
    testing::add_rectangle(wall, {-400, -30, -40}, {800, 0, 0}, {0, 600, 0});
    const Sight flat = traced_sight(wall, world.projector, world.camera, 0.1, 1);
    try {
        pose_of_pair(world.camera, world.projector, flat.map, distance);
        ADD_FAILURE() << "a pose from one plane";
    } catch (const Refused& refused) {
        EXPECT_NE(std::string(refused.what()).find("one plane"), std::string::npos)
            << refused.what();
    }
}

}  // namespace
}  // namespace livery
