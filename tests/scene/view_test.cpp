#include "scene/view.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "core/random.h"

namespace livery {
namespace {

Rigid3 random_pose(Random& random) {
    const glm::dquat q(random.normal(), random.normal(), random.normal(), random.normal());
    Rigid3 pose;
    pose.rotation = glm::mat3_cast(glm::normalize(q));
    pose.translation = 100.0 * glm::dvec3(random.normal(), random.normal(), random.normal());
    return pose;
}

View random_view(Random& random) {
    View view;
    view.width = 1280;
    view.height = 800;
    view.focal_px = {900.0 + 2500.0 * random.uniform(), 900.0 + 2500.0 * random.uniform()};
    // Lens shift: the principal point may lie below the picture.
    view.principal_px = {640.0 + 100.0 * random.normal(), 400.0 + 600.0 * random.normal()};
    view.distortion = {0.3 * random.normal(),
                       0.2 * random.normal(),
                       0.005 * random.normal(),
                       0.005 * random.normal(),
                       0.1 * random.normal()};
    view.view_from_world = random_pose(random);
    return view;
}

/// What OpenCV makes of the same numbers, moved to our pixel centres.
glm::dvec2 project_with_opencv(const View& view, const glm::dvec3& x_in_world) {
    const auto& r = view.view_from_world.rotation;
    const cv::Matx33d rotation(
        r[0][0], r[1][0], r[2][0], r[0][1], r[1][1], r[2][1], r[0][2], r[1][2], r[2][2]);
    cv::Vec3d rotation_vector;
    cv::Rodrigues(rotation, rotation_vector);
    const auto& t = view.view_from_world.translation;
    const cv::Matx33d matrix(view.focal_px.x,
                             0.0,
                             view.principal_px.x - 0.5,
                             0.0,
                             view.focal_px.y,
                             view.principal_px.y - 0.5,
                             0.0,
                             0.0,
                             1.0);
    const std::vector<double> lens(view.distortion.begin(), view.distortion.end());
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(std::vector<cv::Point3d>{{x_in_world.x, x_in_world.y, x_in_world.z}},
                      rotation_vector,
                      cv::Vec3d(t.x, t.y, t.z),
                      matrix,
                      lens,
                      pixels);
    return {pixels[0].x + 0.5, pixels[0].y + 0.5};
}

TEST(Project, AgreesWithOpenCvToAMillionthOfAPixel) {
    Random random(11);
    int compared = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const View view = random_view(random);
        const double z = 500.0 + 2000.0 * random.uniform();
        const glm::dvec3 x_in_view(
            0.5 * z * (random.uniform() - 0.5), 0.5 * z * (random.uniform() - 0.5), z);
        const glm::dvec3 x_in_world = inverse(view.view_from_world) * x_in_view;
        const auto pixel = project(view, x_in_world);
        if (!pixel) continue;
        ++compared;
        // The requirement; rounding of a rotation vector and back leaves 1e-9.
        ASSERT_LT(glm::distance(*pixel, project_with_opencv(view, x_in_world)), 1e-6) << trial;
    }
    EXPECT_GT(compared, 2500);
}

TEST(Project, AnswersNothingBehindTheView) {
    const View view = look_at({0, 0, 100}, {0, 0, 0}, 0.6, 640, 480);
    EXPECT_TRUE(project(view, {0, 0, 99.9}));
    EXPECT_FALSE(project(view, {0, 0, 100.0}));
    EXPECT_FALSE(project(view, {3, 2, 150.0}));
}

/// Along a radius, pixels must move outward until the answer is nothing, and never come back.
TEST(Project, StopsWhereTheLensFoldsOver) {
    struct Case {
        std::array<double, 5> lens;
        double fold;  ///< tangent of the field angle where d/dr (r + k1 r^3 + k2 r^5 + k3 r^7) = 0
    };
    const Case cases[] = {
        {{-0.4, 0, 0, 0, 0}, std::sqrt(1.0 / 1.2)},
        {{0, -0.1, 0, 0, 0}, std::sqrt(std::sqrt(2.0))},
        {{0, 0, 0, 0, -0.05}, std::sqrt(std::cbrt(1.0 / 0.35))},
        // 1 - 1.5 s + 0.5 s^2 = (1 - s)(1 - s/2): falls between, rises again beyond.
        {{-0.5, 0.1, 0, 0, 0}, 1.0},
        // (1 - s)(1 - s/2)(1 + s) = 1 - s/2 - s^2 + s^3/2
        {{-1.0 / 6.0, -0.2, 0, 0, 0.5 / 7.0}, 1.0},
    };
    for (const auto& [lens, fold] : cases) {
        View view = look_at({0, 0, 0}, {0, 0, 1}, 0.6, 640, 480);
        view.distortion = lens;
        double last = -1.0;
        for (double r = 0.0; r < 5.0; r += 0.001) {
            const glm::dvec3 x = inverse(view.view_from_world) * glm::dvec3(r, 0, 1);
            const auto pixel = project(view, x);
            EXPECT_EQ(pixel.has_value(), r < fold) << "k1 " << lens[0] << " at r " << r;
            if (!pixel) continue;
            EXPECT_GT(pixel->x, last);
            last = pixel->x;
        }
    }
}

TEST(RayThrough, UndoesProjectionToATenBillionthOfAPixel) {
    Random random(12);
    int there_and_back = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const View view = random_view(random);
        const double z = 300.0 + 2000.0 * random.uniform();
        const glm::dvec3 x_in_view(
            1.2 * z * (random.uniform() - 0.5), 1.2 * z * (random.uniform() - 0.5), z);
        const glm::dvec3 x_in_world = inverse(view.view_from_world) * x_in_view;
        const auto pixel = project(view, x_in_world);
        if (!pixel) continue;
        ++there_and_back;
        const Ray ray = ray_through(view, *pixel);
        EXPECT_NEAR(glm::length(ray.direction), 1.0, 1e-14);
        const auto again = project(view, ray.origin + 700.0 * ray.direction);
        ASSERT_TRUE(again) << trial;
        // 1e-10 promised, plus the rounding of projecting again at coordinates of 1000.
        ASSERT_LT(glm::distance(*again, *pixel), 1e-9) << trial;
        // The same ray, not another one that the lens maps to the same pixel. Near a fold the
        // inverse loses digits, hence 1e-6 of the distance.
        const double along = glm::dot(x_in_world - ray.origin, ray.direction);
        ASSERT_LT(glm::distance(ray.origin + along * ray.direction, x_in_world), 1e-6 * z) << trial;
    }
    EXPECT_GT(there_and_back, 2000);
}

TEST(RayThrough, RefusesAPixelThatNoRayReaches) {
    View view = look_at({0, 0, 0}, {0, 0, 1}, 1.5, 640, 480);
    view.distortion = {-0.4, 0, 0, 0, 0};
    // The image of the fold: r (1 - 0.4 r^2) at r = sqrt(1 / 1.2) is 0.6086.
    EXPECT_NO_THROW(ray_through(view, view.principal_px + glm::dvec2(0.608 * view.focal_px.x, 0)));
    try {
        ray_through(view, view.principal_px + glm::dvec2(0.61 * view.focal_px.x, 0));
        FAIL() << "no error";
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("no ray meets pixel ("), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("-0.4"), std::string::npos);
    }
}

TEST(LookAt, PutsTheTargetInTheMiddleAndUpIsUp) {
    const View view = look_at({100.0, 200.0, 300.0}, {1.0, 2.0, 3.0}, 0.5, 640, 480);
    const auto middle = project(view, {1.0, 2.0, 3.0});
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->x, 320.0, 1e-9);
    EXPECT_NEAR(middle->y, 240.0, 1e-9);
    const auto above = project(view, {1.0, 12.0, 3.0});
    ASSERT_TRUE(above);
    EXPECT_NEAR(above->x, 320.0, 1e-9);
    EXPECT_LT(above->y, 240.0);
    EXPECT_NEAR(glm::distance(centre_in_world(view), {100.0, 200.0, 300.0}), 0.0, 1e-9);
    EXPECT_NEAR(glm::determinant(view.view_from_world.rotation), 1.0, 1e-12);
}

TEST(LookAt, VerticalFieldOfViewReachesTheTopEdge) {
    const View view = look_at({0, 0, 100}, {0, 0, 0}, 0.8, 640, 480);
    const auto top = project(view, {0, 100.0 * std::tan(0.4), 0});
    ASSERT_TRUE(top);
    EXPECT_NEAR(top->y, 0.0, 1e-9);
}

TEST(LookAt, LooksStraightDownAndStraightUp) {
    for (const double y : {-50.0, 50.0}) {
        const View view = look_at({1, y, 2}, {1, 0, 2}, 0.8, 640, 480);
        EXPECT_NEAR(glm::determinant(view.view_from_world.rotation), 1.0, 1e-12);
        const auto middle = project(view, {1, 0, 2});
        ASSERT_TRUE(middle);
        EXPECT_NEAR(middle->x, 320.0, 1e-9);
    }
}

TEST(Rigid3, ComposesAndInverts) {
    Random random(13);
    const Rigid3 b_from_a = random_pose(random), c_from_b = random_pose(random);
    const glm::dvec3 x(3.0, -4.0, 5.0);
    EXPECT_LT(glm::distance((c_from_b * b_from_a) * x, c_from_b * (b_from_a * x)), 1e-10);
    EXPECT_LT(glm::distance(inverse(b_from_a) * (b_from_a * x), x), 1e-10);
}

}  // namespace
}  // namespace livery
