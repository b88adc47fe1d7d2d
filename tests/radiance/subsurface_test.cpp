// Light that leaves translucent parts beside where it entered: against what must be kept.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "appearance/material_library.h"
#include "appearance/subsurface/exact_totals.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "gl/context.h"
#include "radiance/renderer.h"
#include "radiance/subsurface/slab_thickness.h"
#include "radiance/subsurface/subsurface_near.h"
#include "radiance/subsurface/subsurface_transport.h"
#include "radiance/translucent_scenes.h"
#include "scene/library.h"
#include "support/gl_device.h"
#include "support/small_meshes.h"
#include "support/thorough.h"
#include "tracing/ray_counters.h"

namespace livery {
namespace {

TEST(SubsurfaceTransport, CoversThePartAndGivesBackWhatEnters) {
    const Mesh mesh = make_sphere({0, 0, 0}, 25.0, 96, "ball");
    const Tracer tracer(mesh);
    const TranslucentMaterial marble = medium_named("marble");
    const float reach_mm = kernel_reach_mm(marble);
    // Red light goes farthest
    EXPECT_NEAR(reach_mm, 24.0f, 1.0f);
    const SubsurfaceTransport transport = solve_transport(mesh, tracer, 0, reach_mm, {200, true});
    const SubsurfaceKernel kernel = subsurface_kernel(marble, reach_mm, transport.near_mm);
    double area = 0.0;
    for (const float one : transport.area_mm2) area += static_cast<double>(one);
    EXPECT_NEAR(area, 4.0 * 3.14159265 * 625.0, 0.01 * area);
    const std::size_t count = transport.area_mm2.size();
    const double neighbours =
        static_cast<double>(transport.first.back()) / static_cast<double>(count);
    EXPECT_GT(neighbours, 100.0);
    EXPECT_LT(neighbours, 400.0);
    // Even light comes back as the total of a ball everywhere
    const glm::vec3 of_ball = total_at(kernel, 1.0f / 25.0f);
    for (int c = 0; c < 3; ++c) EXPECT_GT(of_ball[c], kernel.total[c] + 0.02f);
    EXPECT_EQ(total_at(kernel, 0.0f), kernel.total);
    EXPECT_LT(total_at(kernel, -0.04f).y, kernel.total.y);
    const std::vector<glm::vec3> even(count, glm::vec3(1.0f));
    const LeavingLight of_even = leaving_at_nodes(transport, kernel, even);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 value = of_even.from_afar[i] + of_even.near_share[i];
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(value[c], of_ball[c], 0.01f);
    }
    // On one side alone, about as much comes back in all
    std::vector<glm::vec3> half(count);
    glm::dvec3 entered(0.0), left(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const bool lit = transport.exchange.nodes.position_mm(i).x > 0.0f;
        half[i] = glm::vec3(lit ? 1.0f : 0.0f);
    }
    const auto leaving = leaving_at_nodes(transport, kernel, half);
    for (std::size_t i = 0; i < count; ++i) {
        const auto a = static_cast<double>(transport.area_mm2[i]);
        entered += a * glm::dvec3(half[i]);
        left += a * glm::dvec3(leaving.from_afar[i] + leaving.near_share[i] * half[i]);
    }
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(left[c] / entered[c], static_cast<double>(of_ball[c]), 0.01) << c;
    }
}

TEST(SubsurfaceTransport, IsSharedByMediaThatAreNearOneAnother) {
    EXPECT_EQ(shared_reach_mm(0.0f), 0.0f);
    float before = 0.0f;
    for (float reach_mm = 1e-3f; reach_mm < 1e4f; reach_mm *= 1.01f) {
        const float shared = shared_reach_mm(reach_mm);
        ASSERT_GE(shared, 0.99999f * reach_mm);
        ASSERT_LT(shared, 1.1893f * reach_mm);
        ASSERT_GE(shared, before);
        before = shared;
    }
    // A ball of which a designer drags the colour: rays between nodes are traced once
    Scene scene = shadowed_ball(translucent_paint(medium_named("marble")));
    const View view = look_at({0, 90, 10}, {0, 24.6, 4}, 0.36, 12, 12);
    const HeadlessContext context(tested_gl());
    const EffectLevels levels = levels_of(Quality::high);
    RadianceRenderer renderer(std::make_shared<const FrameGeometry>(scene.product, view),
                              false,
                              ShadingDevice::processor);
    const auto rays_for = [&](double absorption) {
        TranslucentMaterial medium = medium_named("marble");
        medium.sigma_a_per_mm *= absorption;
        scene.part_materials[0] = translucent_paint(medium);
        FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
        const RayCounters begin = ray_counters();
        renderer.render(scene, plan);
        return (ray_counters() - begin).occluded;
    };
    const auto first = rays_for(1.0);
    const float own = shared_reach_mm(kernel_reach_mm(medium_named("marble")));
    for (const double absorption : {1.01, 1.02, 0.99}) {
        TranslucentMaterial medium = medium_named("marble");
        medium.sigma_a_per_mm *= absorption;
        ASSERT_EQ(shared_reach_mm(kernel_reach_mm(medium)), own);
        EXPECT_LT(rays_for(absorption), first / 10) << absorption;
    }
}

/// What is near does not depend on where the cubes lie that it is sought in: also not where their
/// sides fall on fragments, within the rounding of a place.
TEST(SubsurfaceNear, IsTheSameWhereverTheCubesLie) {
    SubsurfaceKernel kernel = subsurface_kernel(medium_named("marble"), 20.0f, 6.0f);
    const float reach = kernel.near_mm;
    constexpr int kSide = 24;
    const float step = reach / 4.0f;  // wider than what is taken together
    PixelSize pixels;
    pixels.from_mm = {0.0, 0.0, -1e7};
    pixels.at_one_mm = static_cast<double>(step) * 1e-7;
    const auto nearby = [&](float offset) {
        SurfaceMap map;
        std::vector<glm::vec3> entering;
        for (int k = 0; k < kSide * kSide; ++k) {
            Fragment& f = map.fragments.emplace_back();
            f.position_mm = {offset + step * static_cast<float>(k % kSide),
                             offset + step * static_cast<float>(k / kSide),
                             0.0f};
            f.normal = {0.0f, 0.0f, 1.0f};
            f.coverage = 1.0f;
            entering.emplace_back(k % 5 == 0 || k % kSide > kSide / 2 ? 1.0f : 0.0f);
        }
        map.part_begin = {0, static_cast<std::uint32_t>(map.fragments.size())};
        return entering_nearby(map, pixels, 0, kernel, entering);
    };
    const std::vector<glm::vec3> usual = nearby(0.37f * step);
    for (const float places : {0.0f, 1.0f, 3.0f, 17.0f, 1001.0f}) {
        for (const float direction : {-1e9f, 1e9f}) {
            // The next number below a side, and above
            const float offset = std::nextafter(places * reach, direction);
            const std::vector<glm::vec3> found = nearby(offset);
            for (std::size_t i = 0; i < usual.size(); ++i) {
                ASSERT_NEAR(found[i].y, usual[i].y, 5e-3f) << i << " at " << offset;
            }
        }
    }
}

TEST(SubsurfaceTransport, DoesNotGoThroughTheAir) {
    // Two balls a millimetre apart in one part: no light goes from one to the other
    Mesh mesh = make_sphere({-10.5, 0, 0}, 10.0, 48, "pair");
    append(mesh, make_sphere({10.5, 0, 0}, 10.0, 48, "other"), "");
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    mesh.parts.resize(1);
    const Tracer tracer(mesh);
    const auto across = [&](bool rejects_air) {
        const SubsurfaceTransport transport =
            solve_transport(mesh, tracer, 0, 6.0f, {200, rejects_air});
        const ExchangeNodes& nodes = transport.exchange.nodes;
        std::size_t pairs = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (std::size_t k = transport.first[i]; k < transport.first[i + 1]; ++k) {
                const float side = nodes.position_mm(i).x;
                pairs += side * nodes.position_mm(transport.other[k]).x < 0.0f ? 1u : 0u;
            }
        }
        return pairs;
    };
    const std::size_t all = across(false), left = across(true);
    EXPECT_GT(all, 1000u);
    EXPECT_LT(left, all / 50);
}

/// Even light from behind: as much comes through a plate as adding and doubling says.
TEST(SubsurfaceTransport, LetsThroughWhatIsExact) {
    const Mesh mesh = plate_mesh(2.0f);
    const Tracer tracer(mesh);
    for (const char* name : {"marble", "skim milk", "skin 1"}) {
        TranslucentMaterial medium = medium_named(name);
        const auto sheet_mm = sheet_thickness_mm(tracer, mesh, 0, 20.0f);
        ASSERT_TRUE(sheet_mm) << name;
        EXPECT_NEAR(*sheet_mm, 2.0f, 0.01f);
        const float reach_mm = kernel_reach_mm(medium, sheet_mm);
        EXPECT_LT(reach_mm, kernel_reach_mm(medium));
        const SubsurfaceTransport transport =
            solve_transport(mesh, tracer, 0, reach_mm, {200, true});
        ASSERT_FALSE(transport.slabs_mm.empty()) << name;
        const SubsurfaceKernel kernel =
            subsurface_kernel(medium, reach_mm, transport.near_mm, transport.slabs_mm);
        const ExchangeNodes& nodes = transport.exchange.nodes;
        std::vector<glm::vec3> from_below(nodes.size(), glm::vec3(0.0f));
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes.normal(i).y < -0.9f) from_below[i] = glm::vec3(1.0f);
        }
        const LeavingLight leaving = leaving_at_nodes(transport, kernel, from_below);
        medium.thickness_mm = 2.0;
        glm::dvec3 through(0.0), back(0.0);
        for (int c = 0; c < 3; ++c) {
            const DiffuseTotals exact = exact_totals(medium_of(medium, c));
            through[c] = exact.transmittance;
            back[c] = exact.reflectance;
        }
        through = working_from_rec709() * through;
        back = working_from_rec709() * back;
        std::size_t tops = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const glm::vec3 at = nodes.position_mm(i);
            if (std::max(std::abs(at.x), std::abs(at.z)) > 15.0f) continue;
            const bool top = nodes.normal(i).y > 0.9f;
            tops += top ? 1u : 0u;
            const glm::vec3 found =
                leaving.from_afar[i] + (top ? glm::vec3(0.0f) : leaving.near_share[i]);
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(found[c], top ? through[c] : back[c], 0.004) << name << " " << c;
            }
        }
        EXPECT_GT(tops, 20u);
    }
}

/// Displaced light is neither lost nor gained: over a ball under one lamp as much enters as falls
/// on a plane's worth of it.
TEST(SubsurfaceTransport, DisplacesWhatEntersAslantAndLosesNothing) {
    const glm::vec3 paths(0.5f, 1.0f, 2.0f);
    const EnteredMedium straight{1.3, glm::vec3(0.0f), {}}, slanting{1.3, paths, {}};
    EXPECT_LT(entering_of_lamp(slanting, 1.0f, 0.04f).z, entering_of_lamp(straight, 1.0f, 0.04f).z);
    EXPECT_GT(entering_of_lamp(slanting, 0.2f, 0.04f).z, entering_of_lamp(straight, 0.2f, 0.04f).z);
    EXPECT_EQ(entering_of_lamp(slanting, 0.5f, 0.0f), entering_of_lamp(straight, 0.5f, 0.0f));
    glm::dvec3 all(0.0);
    double plain = 0.0;
    constexpr int kSteps = 2000;
    for (int k = 0; k < kSteps; ++k) {
        const float cosine = (static_cast<float>(k) + 0.5f) / kSteps;
        all += glm::dvec3(entering_of_lamp(slanting, cosine, 0.04f));
        plain += static_cast<double>(entering_of_lamp(straight, cosine, 0.04f).x);
    }
    // Fresnel's share is taken for even in the divergence: a tenth of a displacement of 6%
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(all[c] / plain, 1.0, 0.006) << c;
}

/// Juices and drinks scatter so little that light goes through a ball of them: no more leaves than
/// scatters, whatever diffusion, which knows of no such bodies, says.
TEST(SubsurfaceTransport, BallsOfAllShippedMediaGiveBackNoMoreThanScatters) {
    const Mesh mesh = make_sphere({0, 0, 0}, 25.0, 64, "ball");
    const Tracer tracer(mesh);
    const auto library = read_paint_library();
    for (const Material& paint : library->media) {
        SCOPED_TRACE(paint.name);
        const TranslucentMaterial& medium = *paint.medium;
        const float reach_mm = shared_reach_mm(kernel_reach_mm(medium));
        const SubsurfaceTransport transport =
            solve_transport(mesh, tracer, 0, reach_mm, {200, true});
        const SubsurfaceKernel kernel =
            subsurface_kernel(medium, reach_mm, transport.near_mm, {}, 1.0f);
        glm::dvec3 scatters;
        for (int c = 0; c < 3; ++c) {
            const ScatteringMedium channel = medium_of(medium, c);
            const double chord = 4.0 / 3.0 * 25.0 * channel.sigma_t_prime();
            scatters[c] = channel.albedo_prime() * -std::expm1(-chord);
        }
        scatters = working_from_rec709() * scatters;
        const glm::vec3 of_ball = total_at(kernel, 1.0f / 25.0f);
        const std::vector<glm::vec3> even(transport.area_mm2.size(), glm::vec3(1.0f));
        const LeavingLight leaving = leaving_at_nodes(transport, kernel, even);
        for (int c = 0; c < 3; ++c) {
            ASSERT_LE(of_ball[c], scatters[c] + 1e-6) << c;
            // Ten times smaller bodies give back neither more than scatters, nor nothing
            ASSERT_GE(total_at(kernel, 1.0f / 2.5f)[c], 0.0f) << c;
            for (std::size_t i = 0; i < even.size(); ++i) {
                const float left = leaving.from_afar[i][c] + leaving.near_share[i][c];
                ASSERT_GE(left, 0.0f) << c;
                // Curvatures at nodes are within a tenth of the ball's
                ASSERT_NEAR(left, of_ball[c], 0.01f + 0.1f * of_ball[c]) << c;
            }
        }
        // No step where the one way of telling the total goes over into the other
        glm::vec3 before = total_at(kernel, 0.01f);
        for (float curvature = 0.01f; curvature < 1.0f; curvature *= 1.02f) {
            const glm::vec3 total = total_at(kernel, curvature);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(total[c], before[c], 0.02f) << curvature;
            before = total;
        }
    }
}

/// Faces that cover one another, seams and rims put nodes in one place: none of what is made of
/// distances between them may be no number.
TEST(SubsurfaceTransport, IsFiniteOnAllPartsOfTheShippedProducts) {
    const TranslucentMaterial marble = medium_named("marble");
    for (const char* name : chosen<const char*>({"player", "sphere", "car"}, 1)) {
        const auto product = find_product(name);
        const Tracer tracer(product->mesh);
        for (std::size_t part = 0; part < product->mesh.parts.size(); ++part) {
            SCOPED_TRACE(std::string(name) + " " + product->mesh.parts[part].name);
            const float reach_mm = kernel_reach_mm(marble);
            const SubsurfaceTransport transport =
                solve_transport(product->mesh, tracer, part, reach_mm, {200, true});
            const float most = *std::max_element(transport.curvature_per_mm.begin(),
                                                 transport.curvature_per_mm.end());
            const SubsurfaceKernel kernel =
                subsurface_kernel(marble, reach_mm, transport.near_mm, transport.slabs_mm, most);
            const std::vector<glm::vec3> even(transport.area_mm2.size(), glm::vec3(1.0f));
            const LeavingLight leaving = leaving_at_nodes(transport, kernel, even);
            for (std::size_t i = 0; i < even.size(); ++i) {
                // The most that nodes a twentieth of near_mm apart can tell
                ASSERT_LT(std::abs(transport.curvature_per_mm[i]), 40.1f / transport.near_mm) << i;
                for (int c = 0; c < 3; ++c) {
                    const float left = leaving.from_afar[i][c] + leaving.near_share[i][c];
                    ASSERT_TRUE(left >= 0.0f && left <= 1.0001f) << i << ": " << left;
                }
            }
        }
    }
}

TEST(SubsurfaceTransport, TakesNoBallForASlab) {
    for (const float radius : {4.0f, 10.0f, 25.0f}) {
        const Mesh mesh = make_sphere({0, 0, 0}, static_cast<double>(radius), 64, "ball");
        const Tracer tracer(mesh);
        const SubsurfaceTransport transport = solve_transport(mesh, tracer, 0, 60.0f, {200, true});
        EXPECT_TRUE(transport.slabs_mm.empty()) << radius;
    }
}

}  // namespace
}  // namespace livery
