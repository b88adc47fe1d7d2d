// Light between surfaces against closed forms.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "reference/scenes.h"

namespace livery {
namespace {

constexpr double kPi = std::numbers::pi;

/// A narrow look at one place of a surface.
View at_place(glm::dvec3 from, glm::dvec3 place) { return look_at(from, place, 2e-4, 8, 8); }

TEST(FurnaceWithInterreflection, AWhiteBoxUnderEvenLightVanishes) {
    // Whatever hides the sky is as bright as the sky, once light has bounced long enough.
    Scene scene = scene_of(open_box(), white_diffuse(1.0), {0.0, 20.0, 0.0});
    scene.environment = uniform_environment(1.0f);
    ReferenceOptions options;
    options.samples_per_pixel = 512;
    options.bounces = 1000;
    for (const glm::dvec3 place : {glm::dvec3(0, 0, 0), glm::dvec3(0.97, 0, 0.97)}) {
        const View view = at_place({0.3 * place.x, 20.0, 0.3 * place.z}, place);
        const PictureMean mean = mean_of(trace_reference(scene, view, options));
        EXPECT_NEAR(mean.colour.y, 1.0, 4.0 * mean.standard_error + 1e-4);
        EXPECT_LT(mean.standard_error, 0.004);
        // And is not, by far, in direct light alone: the test can fail.
        ReferenceOptions direct = options;
        direct.bounces = 0;
        EXPECT_LT(mean_of(trace_reference(scene, view, direct)).colour.y, 0.5);
    }
}

/// The same quads, those of odd number facing the other way; both sides of all show.
Mesh with_two_sides(Mesh mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (t / 2 % 2 == 0) continue;
        glm::uvec3& corners = mesh.triangles[t];
        std::swap(corners.y, corners.z);
        if (t % 2 == 0) continue;
        for (std::uint32_t k = 0; k < 4; ++k) {
            glm::vec3& normal = mesh.normals[2 * (t - 1) + k];
            normal = -normal;
        }
    }
    mesh.two_sided.assign(mesh.triangles.size(), true);
    return mesh;
}

TEST(FurnaceWithInterreflection, AWhiteBoxOfSheetsVanishesFromInsideAndOutside) {
    Scene scene = scene_of(with_two_sides(open_box()), white_diffuse(1.0), {0.0, 20.0, 0.0});
    scene.environment = uniform_environment(1.0f);
    ReferenceOptions options;
    options.samples_per_pixel = 256;
    options.bounces = 1000;
    for (const glm::dvec3 from : {glm::dvec3(0, 20, 0), glm::dvec3(15, 9, 12)}) {
        scene.eye_in_world_mm = from;
        const View view = look_at(from, {0.0, 1.0, 0.0}, 0.15, 24, 24);
        const PictureMean mean = mean_of(trace_reference(scene, view, options));
        EXPECT_NEAR(mean.colour.y, 1.0, 4.0 * mean.standard_error + 1e-4);
        EXPECT_LT(mean.standard_error, 0.004);
        // Taken for closed, its backs swallow light: the test can fail.
        Scene closed = scene;
        auto product = std::make_shared<Product>(*scene.product);
        product->mesh.two_sided.clear();
        closed.product = product;
        EXPECT_LT(mean_of(trace_reference(closed, view, options)).colour.y, 0.97);
    }
}

TEST(FacingPlates, OneBounceIsTheViewFactorOfTheLitRectangle) {
    // A wall from y = 2 to 6 is lit over the top of a lower one that faces it from 4 away and that
    // no light meets directly: one bounce alone, from a rectangle of even radiosity.
    constexpr float kWide = 5.0f, kApart = 4.0f;
    Mesh mesh;
    add_quad(mesh, {0, 2, kWide}, {0, 2, -kWide}, {0, 6, -kWide}, {0, 6, kWide});  // toward +x
    add_quad(mesh,
             {kApart, -2, -kWide},
             {kApart, -2, kWide},
             {kApart, 1, kWide},
             {kApart, 1, -kWide});  // toward -x
    Scene scene = scene_of(mesh, white_diffuse(0.6), {0, 0, 0});
    scene.lights = {light_toward({1.0, 1.0, 0.0}, 0.0)};
    // From a place 2 below the rectangle's lower edge, in its middle plane: two rectangles on each
    // side, of corners over the place's foot; F = 1/(2 pi) [atan(z/d) - d/h atan(z/h)] between
    // parallel planes, here as the difference of heights (Howell, configuration C-13 by parts).
    const double y = 0.0, d = kApart, z = kWide;
    const auto corner = [&](double height) {
        const double a = height / d, b = z / d;
        const double p = std::sqrt(1.0 + a * a), q = std::sqrt(1.0 + b * b);
        return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2.0 * kPi);
    };
    const double factor = 2.0 * (corner(6.0 - y) - corner(2.0 - y));
    const double lit = 0.6 * std::sqrt(0.5);
    ReferenceOptions options;
    options.samples_per_pixel = 4096;
    scene.eye_in_world_mm = {1.0, -20.0, 0.0};
    const View view = at_place(scene.eye_in_world_mm, {kApart, y, 0.0});
    options.bounces = 0;
    EXPECT_EQ(mean_of(trace_reference(scene, view, options)).colour.y, 0.0);
    options.bounces = 1;
    const PictureMean mean = mean_of(trace_reference(scene, view, options));
    EXPECT_NEAR(mean.colour.y, 0.6 * lit * factor, 4.0 * mean.standard_error + 1e-5);
    EXPECT_LT(mean.standard_error, 0.003 * mean.colour.y);
}

/// The inside of a sphere of radius 1 around the origin with a round hole of that polar angle
/// above.
Mesh sphere_inside(double hole_rad, int rings, int around) {
    Mesh mesh;
    mesh.parts.push_back({"part", "", glm::dvec3(0.5)});
    const auto vertex = [](double polar, double azimuth) {
        return glm::vec3(std::sin(polar) * std::cos(azimuth),
                         std::cos(polar),
                         std::sin(polar) * std::sin(azimuth));
    };
    for (int r = 0; r < rings; ++r) {
        const double top = hole_rad + (kPi - hole_rad) * r / rings;
        const double bottom = hole_rad + (kPi - hole_rad) * (r + 1) / rings;
        for (int k = 0; k < around; ++k) {
            const double left = 2.0 * kPi * k / around, right = 2.0 * kPi * (k + 1) / around;
            const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
            for (const glm::vec3& p : {vertex(top, left),
                                       vertex(top, right),
                                       vertex(bottom, right),
                                       vertex(bottom, left)}) {
                mesh.positions_mm.push_back(p);
                mesh.normals.push_back(-p);
                mesh.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
                mesh.uvs.emplace_back(0.0f);
            }
            mesh.triangles.emplace_back(first, first + 2, first + 1);
            mesh.triangles.emplace_back(first, first + 3, first + 2);
            mesh.triangle_part.insert(mesh.triangle_part.end(), 2, 0);
        }
    }
    return mesh;
}

TEST(IntegratingSphere, ItsWallIsAsBrightAsThePortEquationSays) {
    // Flux enters through the hole and meets the wall opposite; every other place sees
    // L = rho E / pi with E = rho Phi / (A (1 - rho (1 - f))), exactly, for the kernel between two
    // places of a sphere is 1/A everywhere. Facets of 1.4 degrees: about 1e-3 of area and kernel.
    const double hole = 0.35;
    for (const double rho : {0.5, 0.9}) {
        Scene scene = scene_of(sphere_inside(hole, 128, 256), white_diffuse(rho), {0, 0, 0});
        scene.lights = {light_toward({0.0, 1.0, 0.0}, 0.0)};
        // Radiance 1 of a white diffuser: pi of irradiance
        const double flux = kPi * kPi * std::sin(hole) * std::sin(hole);
        const double area = 4.0 * kPi, fraction = 0.5 * (1.0 - std::cos(hole));
        const double irradiance = rho * flux / (area * (1.0 - rho * (1.0 - fraction)));
        ReferenceOptions options;
        options.samples_per_pixel = 4096;
        options.bounces = 400;
        scene.eye_in_world_mm = {-0.3, 0.0, 0.0};
        const View view = at_place(scene.eye_in_world_mm, {1.0, 0.1, 0.0});
        const PictureMean mean = mean_of(trace_reference(scene, view, options));
        const double expected = rho * irradiance / kPi;
        EXPECT_NEAR(mean.colour.y, expected, 4.0 * mean.standard_error + 3e-3 * expected)
            << "albedo " << rho;
        EXPECT_LT(mean.standard_error, 0.01 * expected);
    }
}

TEST(DefaultBounces, AreEnoughForABrightGroove) {
    // What the default leaves out in a box of albedo .8, where light stays longest.
    Scene scene = scene_of(open_box(), white_diffuse(0.8), {0.0, 20.0, 0.0});
    scene.environment = uniform_environment(1.0f);
    ReferenceOptions options;
    options.samples_per_pixel = 1024;
    const View view = at_place({0.0, 20.0, 0.0}, {0.9, 0.0, 0.9});
    const PictureMean found = mean_of(trace_reference(scene, view, options));
    options.bounces = 1000;
    options.seed = 2;
    const PictureMean all = mean_of(trace_reference(scene, view, options));
    EXPECT_NEAR(found.colour.y,
                all.colour.y,
                3.0 * std::hypot(found.standard_error, all.standard_error) + 1e-3);
}

}  // namespace
}  // namespace livery
