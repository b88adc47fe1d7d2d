#include "tracing/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/random.h"

namespace livery {
namespace {

glm::vec3 random_direction(Random& random) {
    return glm::normalize(glm::vec3(random.normal(), random.normal(), random.normal()));
}

Mesh one_triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Mesh mesh;
    mesh.positions_mm = {a, b, c};
    mesh.uvs = {{0.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, 1.0f}};
    mesh.triangles = {{0, 1, 2}};
    mesh.triangle_part = {0};
    mesh.parts.resize(1);
    compute_normals(mesh);
    compute_tangents(mesh);
    return mesh;
}

TEST(Tracer, HitsASphereWhereGeometrySaysSo) {
    const glm::dvec3 centre(20.0, -10.0, 5.0);
    constexpr double radius = 50.0;
    constexpr int rings = 256;
    const Mesh sphere = make_sphere(centre, radius, rings, "ball");
    const Tracer tracer(sphere);
    // Flat facets lie inside by at most r (1 - cos^2(pi / 2 rings)); along the ray, over cos.
    const double sagitta = radius * std::pow(std::sin(std::numbers::pi / (2 * rings)), 2.0);
    Random random(21);
    int hit_count = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const glm::dvec3 from = centre + 400.0 * glm::dvec3(random_direction(random));
        const glm::dvec3 aim = centre + 60.0 * glm::dvec3(random_direction(random));
        const glm::vec3 origin(from), direction(glm::normalize(aim - from));
        const Hit hit = tracer.closest({origin, 0.0f, direction, 1e30f});

        const glm::dvec3 o = glm::dvec3(origin) - centre, d = glm::normalize(glm::dvec3(direction));
        const double b = glm::dot(o, d), miss = std::sqrt(std::max(0.0, glm::dot(o, o) - b * b));
        if (std::abs(miss - radius) < 2.0 * sagitta) continue;  // grazes the facets
        ASSERT_EQ(hit.valid(), miss < radius) << trial;
        if (!hit.valid()) continue;
        ++hit_count;
        const double half_chord = std::sqrt(radius * radius - miss * miss);
        const double cosine = half_chord / radius;
        ASSERT_NEAR(hit.t, -b - half_chord, 1.5 * sagitta / cosine + 1e-4) << trial;
        const SurfacePoint point = surface_point(sphere, hit);
        const glm::dvec3 outward = glm::normalize(glm::dvec3(point.position_mm) - centre);
        ASSERT_GT(glm::dot(outward, glm::dvec3(point.normal)), 1.0 - 1e-4);
        // A facet leans by at most pi / rings from the sphere; its cosine is 7.5e-5 short of 1.
        ASSERT_GT(glm::dot(outward, glm::dvec3(point.geometric_normal)), 1.0 - 1.5e-4);
    }
    EXPECT_GT(hit_count, 5000);
}

TEST(Tracer, ReportsDistanceAndBarycentricsOfATriangle) {
    Random random(22);
    for (int trial = 0; trial < 2000; ++trial) {
        glm::vec3 corner[3];
        for (auto& c : corner) c = 100.0f * random_direction(random);
        const Mesh mesh = one_triangle(corner[0], corner[1], corner[2]);
        const glm::dvec3 cross =
            glm::cross(glm::dvec3(corner[1] - corner[0]), glm::dvec3(corner[2] - corner[0]));
        if (glm::length(cross) < 100.0) continue;
        const double root = std::sqrt(random.uniform()), split = random.uniform();
        const glm::dvec2 wanted(root * (1.0 - split), root * split);
        const glm::dvec3 target = (1.0 - wanted.x - wanted.y) * glm::dvec3(corner[0]) +
                                  wanted.x * glm::dvec3(corner[1]) +
                                  wanted.y * glm::dvec3(corner[2]);
        if (std::min({wanted.x, wanted.y, 1.0 - wanted.x - wanted.y}) < 1e-3) continue;
        // From either side: the tracer does not cull.
        const double side = trial % 2 == 0 ? 1.0 : -1.0;
        const glm::dvec3 n = side * glm::normalize(cross);
        const glm::vec3 origin(target + 80.0 * n + 20.0 * glm::dvec3(random_direction(random)));
        const glm::vec3 direction(glm::normalize(target - glm::dvec3(origin)));
        const Tracer tracer(mesh);
        const Hit hit = tracer.closest({origin, 0.0f, direction, 1e30f});
        ASSERT_TRUE(hit.valid()) << trial;
        ASSERT_EQ(hit.triangle, 0u);
        // Float intersection of a triangle of this size: 1e-5 of 100 mm.
        ASSERT_NEAR(hit.t, glm::distance(target, glm::dvec3(origin)), 2e-3) << trial;
        const double height = glm::length(cross) / 200.0;
        ASSERT_NEAR(hit.barycentric.x, wanted.x, 1e-3 / height) << trial;
        ASSERT_NEAR(hit.barycentric.y, wanted.y, 1e-3 / height) << trial;
    }
}

TEST(Tracer, RaysEndWhereTheySay) {
    const Mesh wall = one_triangle({-100, -100, 50}, {100, -100, 50}, {0, 100, 50});
    const Tracer tracer(wall);
    const auto ray = [](float t_min, float t_max) {
        return TraceRay{{0, 0, 0}, t_min, {0, 0, 1}, t_max};
    };
    for (const bool shadow : {false, true}) {
        const auto meets = [&](const TraceRay& r) {
            return shadow ? tracer.occluded(r) : tracer.closest(r).valid();
        };
        EXPECT_TRUE(meets(ray(0.0f, 1e30f)));
        EXPECT_TRUE(meets(ray(0.0f, std::numeric_limits<float>::infinity())));
        EXPECT_TRUE(meets(ray(49.9f, 50.1f)));
        EXPECT_FALSE(meets(ray(0.0f, 49.9f)));
        EXPECT_FALSE(meets(ray(50.1f, 1e30f)));
    }
    // t counts lengths of the direction.
    EXPECT_NEAR(tracer.closest({{0, 0, 0}, 0.0f, {0, 0, 2}, 1e30f}).t, 25.0f, 1e-4f);
}

TEST(Tracer, NothingSlipsThroughSharedEdges) {
    const Mesh sphere = make_sphere({0, 0, 0}, 100.0, 24, "ball");
    const Tracer tracer(sphere);
    Random random(23);
    int edges = 0, corners = 0, escaped_at_corners = 0;
    for (const auto& t : sphere.triangles) {
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 a = sphere.positions_mm[t[k]], b = sphere.positions_mm[t[(k + 1) % 3]];
            const glm::vec3 inside = 50.0f * random.uniform_float() * random_direction(random);
            const auto blocked = [&](const glm::vec3& aim) {
                return tracer.occluded({inside, 0.0f, glm::normalize(aim - inside), 1e30f});
            };
            for (const float along : {0.5f, 0.01f + 0.98f * random.uniform_float()}) {
                ++edges;
                ASSERT_TRUE(blocked(a + along * (b - a)));
            }
            ++corners;
            escaped_at_corners += blocked(a) ? 0 : 1;
        }
    }
    EXPECT_GT(edges, 10000);
    // Embree closes edges, but decides each edge at a corner by itself: of the rays aimed at a
    // corner to the last bit, some find every triangle just missed. Others never come that close.
    EXPECT_LT(escaped_at_corners, 3 * corners / 1000);
}

TEST(Tracer, PacketsAnswerWhatSingleRaysAnswer) {
    const Mesh sphere = make_sphere({0, 0, 0}, 100.0, 32, "ball");
    const Tracer tracer(sphere);
    Random random(24);
    for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 64u, 1003u}) {
        std::vector<TraceRay> rays(count);
        for (auto& ray : rays) {
            ray.origin = 300.0f * random_direction(random);
            ray.direction = glm::normalize(150.0f * random_direction(random) - ray.origin);
            ray.t_min = 10.0f * random.uniform_float();
            ray.t_max = 150.0f + 300.0f * random.uniform_float();
        }
        std::vector<Hit> hits(count);
        std::vector<std::uint8_t> blocked(count, 7);
        tracer.closest(rays, hits);
        tracer.occluded(rays, blocked);
        std::vector<std::uint8_t> scattered(count, 7);
        tracer.occluded(rays, scattered, RayOrder::scattered);
        std::size_t valid = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const Hit single = tracer.closest(rays[k]);
            ASSERT_EQ(blocked[k], tracer.occluded(rays[k]) ? 1 : 0);
            ASSERT_EQ(scattered[k], blocked[k]);
            ASSERT_EQ(hits[k].valid(), single.valid());
            if (!single.valid()) continue;
            ++valid;
            // Packets and single rays use other instructions; both are right to rounding.
            ASSERT_NEAR(hits[k].t, single.t, 1e-3f);
            const glm::vec3 a = surface_point(sphere, hits[k]).position_mm;
            const glm::vec3 b = surface_point(sphere, single).position_mm;
            ASSERT_LT(glm::distance(a, b), 5e-3f);
        }
        if (count == 1003) {
            EXPECT_GT(valid, 200u);
        }
    }
    std::vector<Hit> too_few(1);
    EXPECT_THROW(tracer.closest(std::vector<TraceRay>(2), too_few), std::invalid_argument);
}

TEST(Tracer, RaysFromOnePointAnswerWhatSingleRaysAnswer) {
    const Mesh sphere = make_sphere({3.0, 4.0, 5.0}, 50.0, 40, "ball");
    const Tracer tracer(sphere);
    const glm::vec3 origin(3.0f, 4.0f, 300.0f);
    Random random(5);
    // No multiple of eight, and one without a direction among them
    std::vector<glm::vec3> directions;
    for (int k = 0; k < 203; ++k) {
        const glm::vec3 aim = 60.0f * random_direction(random) + glm::vec3(3.0f, 4.0f, 5.0f);
        directions.push_back(0.01f * static_cast<float>(1 + k % 7) * (aim - origin));
    }
    directions[100] = glm::vec3(0.0f);
    std::vector<Hit> hits(directions.size());
    tracer.closest_from(origin, directions, hits);
    int hit_count = 0;
    for (std::size_t k = 0; k < directions.size(); ++k) {
        const Hit single = k == 100 ? Hit{} : tracer.closest({origin, 0.0f, directions[k], 1e30f});
        ASSERT_EQ(hits[k].triangle, single.triangle) << k;
        if (!single.valid()) continue;
        ++hit_count;
        EXPECT_NEAR(hits[k].t, single.t, 1e-5f * single.t);
        EXPECT_NEAR(hits[k].barycentric.x, single.barycentric.x, 1e-4f);
    }
    EXPECT_GT(hit_count, 50);
    EXPECT_THROW(tracer.closest_from(origin, directions, std::span(hits).first(5)),
                 std::invalid_argument);
}

TEST(Tracer, LeavesTheCallersArithmeticAlone) {
    const Mesh wall = one_triangle({-100, -100, 50}, {100, -100, 50}, {0, 100, 50});
    const Tracer tracer(wall);
    tracer.closest({{0, 0, 0}, 0.0f, {0, 0, 1}, 1e30f});
    std::vector<TraceRay> rays(9);
    std::vector<Hit> hits(9);
    tracer.closest(rays, hits);
    volatile float smallest = std::numeric_limits<float>::min();
    EXPECT_GT(smallest / 2.0f, 0.0f) << "denormals are flushed after tracing";
}

TEST(Tracer, AnEmptySceneBlocksNothingAndWrongIndicesAreRefused) {
    const Tracer nothing{Mesh{}};
    EXPECT_FALSE(nothing.closest({}).valid());
    EXPECT_FALSE(nothing.occluded({}));
    Mesh wrong = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    wrong.triangles[0].z = 3;
    EXPECT_THROW(Tracer{wrong}, std::invalid_argument);
    EXPECT_THROW(surface_point(wrong, Hit{}), std::invalid_argument);
}

TEST(SurfacePoint, InterpolatesTheVertices) {
    Mesh mesh = one_triangle({0, 0, 0}, {100, 0, 0}, {0, 100, 0});
    mesh.normals = {glm::normalize(glm::vec3(-1, 0, 3)),
                    glm::normalize(glm::vec3(1, 0, 3)),
                    glm::normalize(glm::vec3(0, 1, 3))};
    mesh.triangle_part = {5};
    Hit hit;
    hit.triangle = 0;
    hit.barycentric = {0.2f, 0.3f};
    const SurfacePoint point = surface_point(mesh, hit);
    EXPECT_LT(glm::distance(point.position_mm, glm::vec3(20, 30, 0)), 1e-5f);
    EXPECT_LT(glm::distance(point.geometric_normal, glm::vec3(0, 0, 1)), 1e-6f);
    const glm::vec3 wanted =
        glm::normalize(0.5f * mesh.normals[0] + 0.2f * mesh.normals[1] + 0.3f * mesh.normals[2]);
    EXPECT_LT(glm::distance(point.normal, wanted), 1e-6f);
    EXPECT_NEAR(glm::dot(point.normal, glm::vec3(point.tangent)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::length(glm::vec3(point.tangent)), 1.0f, 1e-6f);
    EXPECT_EQ(point.uv, glm::vec2(0.2f, 0.3f));
    EXPECT_EQ(point.part, 5);
}

TEST(SurfacePoint, OppositeVertexNormalsLeaveTheTrianglesOwn) {
    Mesh mesh = one_triangle({0, 0, 0}, {100, 0, 0}, {0, 100, 0});
    mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
    Hit hit;
    hit.triangle = 0;
    hit.barycentric = {0.5f, 0.0f};
    EXPECT_EQ(surface_point(mesh, hit).normal, glm::vec3(0, 0, 1));
}

/// Leaves a random point of each triangle at a random grazing angle, down to a microradian.
int self_hits(
    Random& random, double place_mm, double size_mm, int triangles, int rays, int& tried) {
    int hit_again = 0;
    for (int m = 0; m < triangles; ++m) {
        const glm::dvec3 place =
            place_mm * glm::dvec3(random.normal(), random.normal(), random.normal());
        // Every fifth triangle is nearly in a coordinate plane, where single coordinates have no
        // error of their own.
        const double flat = std::pow(10.0, -1.25 * (m % 5));
        glm::vec3 corner[3];
        for (auto& c : corner) {
            c = glm::vec3(place + size_mm * glm::dvec3(flat * random.normal(),
                                                       random.normal(),
                                                       random.normal()));
        }
        if (glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0])) == 0.0f) continue;
        const Mesh mesh = one_triangle(corner[0], corner[1], corner[2]);
        const Tracer tracer(mesh);
        for (int k = 0; k < rays; ++k) {
            const float root = std::sqrt(random.uniform_float()), split = random.uniform_float();
            Hit hit;
            hit.triangle = 0;
            hit.barycentric = {root * (1.0f - split), root * split};
            const SurfacePoint point = surface_point(mesh, hit);
            const glm::dvec3 n(point.geometric_normal), s(point.tangent), t = glm::cross(n, s);
            const double around = 2.0 * std::numbers::pi * random.uniform();
            const double up = std::pow(10.0, -6.0 * random.uniform());
            const glm::vec3 direction(std::cos(up) * (std::cos(around) * s + std::sin(around) * t) +
                                      std::sin(up) * n);
            // Rounded to float the ray may point into the surface; then it should hit.
            if (glm::dot(glm::dvec3(direction), n) <= 0.0) continue;
            ++tried;
            const glm::vec3 origin = offset_origin(point.position_mm, point.geometric_normal);
            hit_again += tracer.occluded({origin, 0.0f, direction, 1e30f}) ? 1 : 0;
        }
    }
    return hit_again;
}

TEST(OffsetOrigin, NeverHitsItsOwnTriangleAgain) {
    Random random(25);
    int tried = 0;
    // From a screw to a wall, from the origin to ten kilometres away.
    for (const double place : {0.0, 100.0, 2000.0, 1e5, 1e7}) {
        for (const double size : {0.1, 1.0, 20.0, 500.0, 5000.0}) {
            EXPECT_EQ(self_hits(random, place, size, 60, 100, tried), 0) << place << " " << size;
        }
    }
    EXPECT_GT(tried, 100000);
}

TEST(OffsetOrigin, LeavesALeaningPlaneThroughTheOrigin) {
    // Coordinates near zero are exact to far less than the plane's own error there, which comes
    // from its corners half a metre away.
    Random random(26);
    int tried = 0;
    for (int m = 0; m < 1000; ++m) {
        glm::dvec3 corner[3], middle(0.0);
        for (auto& c : corner) {
            c = 500.0 * glm::dvec3(random_direction(random));
            middle += c / 3.0;
        }
        const Mesh mesh = one_triangle(glm::vec3(corner[0] - middle),
                                       glm::vec3(corner[1] - middle),
                                       glm::vec3(corner[2] - middle));
        const Tracer tracer(mesh);
        for (int k = 0; k < 20; ++k) {
            Hit hit;
            hit.triangle = 0;
            hit.barycentric = 1.0f / 3.0f + 1e-4f * glm::vec2(random.normal(), random.normal());
            const SurfacePoint point = surface_point(mesh, hit);
            const glm::dvec3 n(point.geometric_normal);
            const double up = std::pow(10.0, -6.0 * random.uniform());
            const glm::vec3 direction(std::cos(up) * glm::dvec3(point.tangent) + std::sin(up) * n);
            if (glm::dot(glm::dvec3(direction), n) <= 0.0) continue;
            ++tried;
            const glm::vec3 origin = offset_origin(point.position_mm, point.geometric_normal);
            ASSERT_FALSE(tracer.occluded({origin, 0.0f, direction, 1e30f})) << m << " " << k;
        }
    }
    EXPECT_GT(tried, 15000);
}

TEST(OffsetOrigin, StaysUnderAHundredthOfAMillimetreOnAMockUp) {
    const glm::vec3 p(400.0f, -300.0f, 900.0f), n(0.6f, 0.0f, 0.8f);
    const glm::vec3 moved = offset_origin(p, n) - p;
    EXPECT_GT(glm::dot(moved, n), 0.0f);
    EXPECT_LT(glm::length(moved), 0.01f);
}

}  // namespace
}  // namespace livery
