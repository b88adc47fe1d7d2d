#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "jobs/captured_calibration.h"

namespace livery {
namespace {

/// A square of 200 mm around the origin that faces +z, turned about the x axis.
Mesh square(double tilt_rad) {
    Mesh mesh;
    const auto c = static_cast<float>(std::cos(tilt_rad));
    const auto s = static_cast<float>(std::sin(tilt_rad));
    for (const glm::vec2 corner :
         {glm::vec2(-100, -100), glm::vec2(100, -100), glm::vec2(100, 100), glm::vec2(-100, 100)}) {
        mesh.positions_mm.emplace_back(corner.x, corner.y * c, corner.y * s);
        mesh.normals.emplace_back(0.0f, -s, c);
        mesh.uvs.emplace_back(corner / 200.0f);
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.triangle_part = {0, 0};
    mesh.parts = {Part{"square", "", glm::dvec3(0.5)}};
    compute_tangents(mesh);
    return mesh;
}

TEST(ProjectorIrradiance, FollowsCosineAndDistanceOnAPlane) {
    const View projector = look_at({120.0, 60.0, 700.0}, {0.0, 0.0, 0.0}, 0.4, 64, 48);
    const glm::dvec3 lamp = centre_in_world(projector);
    for (const double tilt_rad : {0.0, 0.5, -0.8, 1.2}) {
        const glm::dvec3 normal(0.0, -std::sin(tilt_rad), std::cos(tilt_rad));
        const ImageF irradiance = projector_irradiance(square(tilt_rad), projector);
        int compared = 0;
        for (int y = 0; y < projector.height; ++y) {
            for (int x = 0; x < projector.width; ++x) {
                const Ray ray = ray_through(projector, {x + 0.5, y + 0.5});
                const double cosine = -glm::dot(ray.direction, normal);
                const double t = glm::dot(lamp, normal) / cosine;
                const glm::dvec3 p = lamp + t * ray.direction;
                const double along = p.y / std::cos(tilt_rad);
                // Away from the border by more than a pixel (6 mm, over the cosine)
                const double margin = 8.0 / cosine;
                const double outside = std::max(std::abs(p.x), std::abs(along));
                if (outside > 100.0 + margin) {
                    EXPECT_EQ(irradiance.at(x, y), 0.0f);
                }
                if (outside > 100.0 - margin) continue;
                // Half a percent: the mean over a pixel is not the middle's value, and the
                // fragment's place is the mean of 16 jittered rays.
                EXPECT_NEAR(
                    static_cast<double>(irradiance.at(x, y)) / (cosine / (t * t)), 1.0, 0.005)
                    << tilt_rad << ": " << x << ", " << y;
                ++compared;
            }
        }
        EXPECT_GT(compared, 50) << tilt_rad;
    }
}

TEST(ProjectorIrradiance, PixelsThatAreHardlyCoveredCountAsNothing) {
    // The square's border runs up the middle of the picture, at x = 100 mm.
    const View projector = look_at({100.0, 0.0, 500.0}, {100.0, 0.0, 0.0}, 0.2, 33, 33);
    const auto column = [&](double shift_px) {
        View shifted = projector;
        shifted.principal_px.x += shift_px;
        return projector_irradiance(square(0.0), shifted).at(16, 16);
    };
    EXPECT_EQ(column(-0.25), 0.0f);  // a quarter of the pixel
    // Three quarters of it: not less light for being partly beside the mesh.
    EXPECT_NEAR(static_cast<double>(column(0.25)), 1.0 / (500.0 * 500.0), 0.005 / (500.0 * 500.0));
}

}  // namespace
}  // namespace livery
