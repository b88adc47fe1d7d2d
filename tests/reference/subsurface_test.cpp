// Walks in translucent parts: how much light comes out of what is flat is solved exactly, and what
// absorbs nothing returns all of it.
#include <cmath>

#include <gtest/gtest.h>

#include "appearance/subsurface/exact_totals.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "core/parallel.h"
#include "reference/scenes.h"
#include "reference/subsurface_walk.h"
#include "tracing/closed_part.h"

namespace livery {
namespace {

TranslucentMaterial medium_with(glm::dvec3 sigma_a,
                                glm::dvec3 sigma_s_prime,
                                double g,
                                double eta) {
    TranslucentMaterial medium;
    medium.name = "medium";
    medium.sigma_a_per_mm = sigma_a;
    medium.sigma_s_prime_per_mm = sigma_s_prime;
    medium.g = g;
    medium.eta = eta;
    return medium;
}

Mesh box(float half_mm, float height_mm) {
    Mesh mesh;
    const float a = half_mm, h = height_mm;
    add_quad(mesh, {-a, h, a}, {a, h, a}, {a, h, -a}, {-a, h, -a});
    add_quad(mesh, {-a, 0, -a}, {a, 0, -a}, {a, 0, a}, {-a, 0, a});
    add_quad(mesh, {-a, 0, a}, {a, 0, a}, {a, h, a}, {-a, h, a});
    add_quad(mesh, {a, 0, -a}, {-a, 0, -a}, {-a, h, -a}, {a, h, -a});
    add_quad(mesh, {a, 0, a}, {a, 0, -a}, {a, h, -a}, {a, h, a});
    add_quad(mesh, {-a, 0, -a}, {-a, 0, a}, {-a, h, a}, {-a, h, -a});
    return mesh;
}

/// Means over walks that enter along the normal at the origin's top, and their standard errors.
struct Totals {
    glm::dvec3 reflected{0.0}, transmitted{0.0}, reflected_se{0.0}, transmitted_se{0.0};
};
Totals walked_totals(const TranslucentMaterial& material,
                     const Boundary& boundary,
                     double top_mm,
                     int walks) {
    const WalkMedium medium = walk_medium(material);
    std::vector<WalkResult> results(static_cast<std::size_t>(walks));
    parallel_for(results.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            Random random(7, k);
            BoundaryPoint start;
            start.position = {0.1, top_mm, 0.2};
            start.geometric_normal = {0.0, 1.0, 0.0};
            results[k] = walk_inside(medium,
                                     boundary,
                                     boundary.inside_of(start),
                                     {0.0, -1.0, 0.0},
                                     random.uniform(),
                                     nullptr,
                                     {},
                                     random);
        }
    });
    Totals totals;
    glm::dvec3 squares[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};
    for (const WalkResult& result : results) {
        if (!result.left) continue;
        const bool up = result.at.geometric_normal.y > 0.5;
        (up ? totals.reflected : totals.transmitted) += result.weight;
        squares[up ? 0 : 1] += result.weight * result.weight;
    }
    const auto finish = [&](glm::dvec3& mean, glm::dvec3& error, const glm::dvec3& square) {
        mean /= walks;
        error = glm::sqrt((square / static_cast<double>(walks) - mean * mean) /
                          static_cast<double>(walks));
    };
    finish(totals.reflected, totals.reflected_se, squares[0]);
    finish(totals.transmitted, totals.transmitted_se, squares[1]);
    return totals;
}

void expect_totals(const TranslucentMaterial& material, const Totals& found) {
    for (int c = 0; c < 3; ++c) {
        const ScatteringMedium medium = medium_of(material, c);
        const DiffuseTotals exact = exact_totals(medium);
        const UnscatteredLight unscattered = unscattered_light(medium);
        EXPECT_NEAR(found.reflected[c],
                    exact.reflectance + unscattered.reflected,
                    3.0 * found.reflected_se[c] + 1e-4)
            << material.name << " channel " << c;
        EXPECT_NEAR(found.transmitted[c],
                    exact.transmittance + unscattered.transmitted,
                    3.0 * found.transmitted_se[c] + 1e-4)
            << material.name << " channel " << c;
    }
}

TEST(SubsurfaceWalk, HalfSpacesReturnTheirExactTotals) {
    const PlaneBoundary plane({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
    for (const char* name : {"marble", "ketchup", "skin 1"}) {
        TranslucentMaterial material = read_translucent_material(name);
        for (const double g : {0.0, 0.7}) {
            material.g = g;
            SCOPED_TRACE(g);
            expect_totals(material, walked_totals(material, plane, 0.0, 8000));
        }
    }
    TranslucentMaterial one = medium_with({0.5, 0.1, 0.01}, glm::dvec3(1.0), 0.0, 1.0);
    one.name = "no index step";
    expect_totals(one, walked_totals(one, plane, 0.0, 8000));
}

TEST(SubsurfaceWalk, SlabsReturnAndLetThroughTheirExactTotals) {
    const Mesh mesh = box(500.0f, 2.0f);
    const Tracer tracer(mesh);
    ASSERT_TRUE(is_closed(mesh, 0));
    const PartBoundary slab(mesh, tracer, 0);
    for (const char* name : {"marble", "skin 1"}) {
        TranslucentMaterial material = read_translucent_material(name);
        material.thickness_mm = 2.0;
        expect_totals(material, walked_totals(material, slab, 2.0, 8000));
    }
    // A part that is open is a sheet under the plane that touches it
    const PlaneBoundary sheet({0.0, 2.0, 0.0}, {0.0, 1.0, 0.0}, 2.0);
    TranslucentMaterial material = read_translucent_material("marble");
    material.thickness_mm = 2.0;
    expect_totals(material, walked_totals(material, sheet, 2.0, 8000));
}

TEST(SubsurfaceWalk, OpenPartsAreToldFromClosedOnes) {
    EXPECT_TRUE(is_closed(make_sphere({0, 0, 0}, 10.0, 16, "ball"), 0));
    EXPECT_FALSE(is_closed(floor_mesh(1.0f), 0));
    EXPECT_FALSE(is_closed(open_box(), 0));
}

/// A ball of 8 mm from afar.
Scene ball(const TranslucentMaterial& medium) {
    Scene scene =
        scene_of(make_sphere({0, 0, 0}, 8.0, 64, "ball"), translucent_paint(medium), {0, 0, 600});
    return scene;
}
View ball_view(int size) { return look_at({0, 0, 600}, {0, 0, 0}, 0.03, size, size); }

TEST(SubsurfaceFurnace, WhatAbsorbsNothingVanishes) {
    for (const double eta : {1.0, 1.5}) {
        Scene scene = ball(medium_with(glm::dvec3(0.0), {0.5, 1.0, 2.0}, 0.0, eta));
        scene.environment = uniform_environment(1.0f);
        ReferenceOptions options;
        options.samples_per_pixel = 8;
        const PictureMean mean = mean_of(trace_reference(scene, ball_view(24), options));
        ASSERT_GT(mean.pixels, 200);
        for (int c = 0; c < 3; ++c) {
            // What the mirrored lobe's fit has too little or too much (microfacet.glsl)
            EXPECT_NEAR(mean.colour[c], 1.0, 4.0 * mean.standard_error + 6e-3)
                << "index " << eta << " channel " << c;
        }
    }
}

TEST(SubsurfaceLamps, ReachWhatTheSameLightAllAroundDoes) {
    // Half of the sky, as a lamp and as an environment: found through the boundary, or at the end
    // of the walk.
    const TranslucentMaterial medium = medium_with({0.05, 0.2, 1.0}, {1.0, 1.5, 2.0}, 0.3, 1.4);
    ReferenceOptions options;
    options.samples_per_pixel = 64;
    Scene lamp = ball(medium);
    DirectionalLight half = light_toward({0.0, 1.0, 0.0}, 3.14159265358979);
    half.radiance_rec709 = glm::dvec3(1.0);
    lamp.lights = {half};
    Scene sky = ball(medium);
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(64, 32, 3, 0.0f);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 64; ++x) {
            for (int c = 0; c < 3; ++c) environment->radiance_working.at(x, y, c) = 1.0f;
        }
    }
    sky.environment = environment;
    const PictureMean of_lamp = mean_of(trace_reference(lamp, ball_view(20), options));
    const PictureMean of_sky = mean_of(trace_reference(sky, ball_view(20), options));
    const double error = std::hypot(of_lamp.standard_error, of_sky.standard_error);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(of_lamp.colour[c], of_sky.colour[c], 4.0 * error + 2e-3) << c;
    }
    EXPECT_LT(error, 0.02 * of_sky.colour.y);
}

TEST(SubsurfaceLamps, OnAnOpenPartDoWhatTheyDoOnAHalfSpace) {
    TranslucentMaterial medium = read_translucent_material("marble");
    ReferenceOptions options;
    options.samples_per_pixel = 32;
    const View view = look_at({0, 500, 0.01}, {0, 0, 0}, 0.02, 12, 12);
    Scene scene = scene_of(floor_mesh(200.0f), translucent_paint(medium), {0, 500, 0.01});
    scene.lights = {light_toward({0.2, 1.0, 0.1}, 0.0)};
    const PictureMean walked = mean_of(trace_reference(scene, view, options));
    scene.part_materials[0] = albedo_paint(scene.part_materials[0]);
    const PictureMean flat = mean_of(trace_reference(scene, view, options));
    for (int c = 0; c < 3; ++c) {
        // A Lambert lobe under an interface is 1% off there, and so is the total off the normal
        EXPECT_NEAR(walked.colour[c] / flat.colour[c], 1.0, 0.03) << c;
    }
}

TEST(SubsurfaceHazards, AreFinite) {
    ReferenceOptions options;
    options.samples_per_pixel = 2;
    const std::vector<TranslucentMaterial> media{
        medium_with(glm::dvec3(0.0), glm::dvec3(1.0), 0.0, 1.5),
        medium_with(glm::dvec3(1e-4), glm::dvec3(0.9999), 0.0, 1.3),
        medium_with(glm::dvec3(0.1), glm::dvec3(1.0), 0.0, 1.0),
        medium_with(glm::dvec3(1e-4), glm::dvec3(1e-4), 0.0, 1.5),  // thin: a thousandth of a path
        medium_with(glm::dvec3(0.01), glm::dvec3(0.1), 0.99, 1.5),
        medium_with(glm::dvec3(1.0), glm::dvec3(0.0), 0.0, 1.5),
        medium_with(glm::dvec3(0.0), glm::dvec3(0.0), 0.0, 1.5),
        medium_with({0.0, 0.0, 1e3}, {0.0, 1e3, 1.0}, -0.9, 2.4),
    };
    for (std::size_t k = 0; k < media.size(); ++k) {
        Scene scene = ball(media[k]);
        scene.environment = uniform_environment(0.5f);
        scene.lights = {light_toward({0.3, 1.0, 0.4}, 0.0), light_toward({-1.0, 0.2, 0.4}, 0.1)};
        const ImageF picture = trace_reference(scene, ball_view(10), options).radiance_working;
        for (const float value : picture.values) {
            ASSERT_TRUE(std::isfinite(value)) << "medium " << k;
            ASSERT_GE(value, 0.0f) << "medium " << k;
        }
    }
}

}  // namespace
}  // namespace livery
