#include "radiance/renderer.h"

#include <array>
#include <atomic>
#include <cmath>
#include <thread>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/model_table.h"
#include "core/colour.h"
#include "gl/context.h"
#include "gl/read_back.h"
#include "radiance/direct_oracle.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/renderer_fixture.h"
#include "radiance/shading.h"
#include "support/radiance_error.h"
#include "support/shading_devices.h"

namespace livery {
namespace {

LIVERY_ON_DEVICES(Renderer, ShadingDevice::processor, ShadingDevice::gl);

void print(const std::string& name, const RadianceError& e) {
    std::printf("    %-34s median %.5f p90 %.5f p99 %.5f largest %.4f bias %+.5f of %zu pixels\n",
                name.c_str(),
                e.median,
                e.p90,
                e.p99,
                e.largest,
                e.mean_signed,
                e.pixels);
}

TEST_P(Renderer, DirectLightAgreesWithBruteForce) {
    // What is asked of the program: median 2%, 99th percentile 10% of design white at alpha .02.
    // Asserted: three times what was measured when this was written.
    const View view = test_view(96, 72);
    std::vector<std::pair<ReflectanceModel, double>> cases = {{ReflectanceModel::ggx, 0.02},
                                                              {ReflectanceModel::ggx, 0.2},
                                                              {ReflectanceModel::clearcoat, 0.02},
                                                              {ReflectanceModel::car_paint, 0.02}};
    for (const ModelInfo& model : formula_models()) cases.emplace_back(model.model, 0.1);
    for (const auto& [model, alpha] : cases) {
        Scene scene = scene_of(two_spheres(), paint_of(model, alpha));
        scene.part_materials[1].film_nm = 320.0;  // where there are flakes
        scene.lights = {light_from({0.5, 0.8, 0.6}, 3.0 * kDegree_rad),
                        light_from({-0.9, 0.3, 0.5}, 0.0, 0.3)};
        const ImageF truth = kept_direct_light(scene, view, {12, 0});
        const RadianceError error = radiance_error(draw(scene, view), truth);
        print(fmt::format("{} alpha {}", model_info(model).name, alpha), error);
        EXPECT_LT(error.median, 0.001);
        EXPECT_LT(error.p99, 0.06);
        EXPECT_LT(std::abs(error.mean_signed), 2e-4) << "2% of a narrow lobe's light is 3e-4";
    }
}

TEST_P(Renderer, EnvironmentLightAgreesWithBruteForce) {
    // Asked: median 2%, 99th percentile 10% at alpha .02. The truth's own noise at 36 x 24 samples
    // is near .008.
    const View view = test_view(48, 36);
    for (const auto& [model, alpha] : {std::pair(ReflectanceModel::lambert, 0.5),
                                       std::pair(ReflectanceModel::ggx, 0.02),
                                       std::pair(ReflectanceModel::clearcoat, 0.02),
                                       std::pair(ReflectanceModel::car_paint, 0.02)}) {
        Scene scene = scene_of(two_spheres(), paint_of(model, alpha));
        scene.part_materials[1].film_nm = 320.0;  // where there are flakes
        scene.environment = studio();
        const ImageF truth = kept_direct_light(scene, view, {6, 24});
        for (const Quality quality : {Quality::draft, Quality::normal, Quality::high}) {
            const RadianceError error = radiance_error(draw(scene, view, quality), truth);
            print(fmt::format("{} alpha {} {}", model_info(model).name, alpha, to_string(quality)),
                  error);
            if (quality == Quality::draft) continue;
            EXPECT_LT(error.median, 0.02);
            EXPECT_LT(error.p99, 0.10);
            // The whole neither brighter nor darker
            EXPECT_LT(std::abs(error.mean_signed), 0.001);
        }
    }
}

TEST_P(Renderer, WhatIsNoNumberIsNeverBright) {
    // A light, or a pixel of the environment, that is no number: what it falls on is no number in
    // the picture, which the compensation shows black and counts.
    const View view = test_view(48, 36);
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const ReflectanceModel model : {ReflectanceModel::lambert,
                                         ReflectanceModel::ggx,
                                         ReflectanceModel::clearcoat,
                                         ReflectanceModel::car_paint,
                                         ReflectanceModel::ward_1992}) {
        for (const bool in_environment : {false, true}) {
            SCOPED_TRACE(::testing::Message() << model_info(model).name << in_environment);
            Scene scene = scene_of(two_spheres(), paint_of(model, 0.1));
            scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05), light_from({-0.9, 0.3, 0.5}, 0.0)};
            auto environment = std::make_shared<Environment>(*studio());
            scene.environment = environment;
            float brightest = 0.0f;
            for (const float value : draw(scene, view, Quality::draft).values) {
                brightest = std::max(brightest, value);
            }
            if (in_environment) {
                environment->radiance_working.at(200, 30, 1) = kNan;
            } else {
                scene.lights[0].radiance_rec709.y = static_cast<double>(kNan);
            }
            std::size_t none = 0;
            for (const float value : draw(scene, view, Quality::draft).values) {
                none += std::isnan(value) ? 1u : 0u;
                EXPECT_FALSE(value > 1.01f * brightest) << value;
            }
            EXPECT_GT(none, 0u);
        }
    }
}

TEST_P(Renderer, WhiteFurnace) {
    // A white diffuser in uniform light shows the light, whichever way it faces.
    Scene scene = scene_of(make_sphere({0, 0, 0}, 40.0, 64, "ball"),
                           paint_of(ReflectanceModel::lambert, 0.5));
    scene.part_materials[0].diffuse = glm::dvec3(1.0);
    Environment uniform;
    uniform.radiance_working = ImageF(32, 16, 3, 0.5f);
    scene.environment = std::make_shared<const Environment>(uniform);
    scene.exposure_ev = 1.0;
    const ImageF image = draw(scene, test_view(48, 36), Quality::draft);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        if (image.values[4 * i + 3] > 0.0f) {
            ASSERT_NEAR(image.values[4 * i], 1.0f, 2e-3f);
        }
    }
}

TEST_P(Renderer, GlossyPaintsInUniformLightShowTheirAlbedo) {
    // Whatever the lobe, light that is the same from everywhere is weighted by the albedo toward
    // the eye. The weights of the others are tested against quadrature with the reflectance source.
    const View view = test_view(48, 36);
    for (const ModelInfo& info : formula_models()) {
        if (info.same_from_all_sides) continue;
        const ReflectanceModel model = info.model;
        Scene scene = scene_of(make_sphere({0, 0, 0}, 40.0, 64, "ball"), paint_of(model, 0.1));
        scene.part_materials[0].film_nm = 320.0;
        Environment uniform;
        uniform.radiance_working = ImageF(32, 16, 3, 0.5f);
        scene.environment = std::make_shared<const Environment>(uniform);
        RadianceRenderer renderer = renderer_of(scene, view);
        FramePlan its_plan = plan(scene, Quality::normal);
        renderer.render(scene, its_plan);
        const ImageF image = renderer.read_back();
        const BsdfParameters paint = parameters_of(scene.part_materials[0]);
        // Paints whose lobes are mirrored one by one return what quadrature says of them, not the
        // fits that keep the layers below from returning too much; tabulated over the cosine's root
        constexpr std::size_t kSteps = 48;
        std::array<glm::vec3, kSteps + 1> mirrored;
        const bool own_lobes = has_own_shading(model);
        for (std::size_t k = 0; own_lobes && k <= kSteps; ++k) {
            f64::BsdfParameters p = widened(paint);
            p.diffuse = glm::dvec3(0.0);
            const double root = std::max(static_cast<double>(k) / kSteps, 0.01);
            const double cosine = root * root;
            const glm::dvec3 wo(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
            mirrored[k] = glm::vec3(directional_albedo(model, p, wo, 96));
        }
        // Mirrored lobes may be off by 1.5% at this level, together with the rest of the light by
        // less; a film's colour is taken at one angle of its lobe. Else half floats in three
        // places, 3 x 2^-11, and weights between cosines are interpolated.
        const bool film = model == ReflectanceModel::car_paint;
        const float tolerance = film ? 1.5e-2f : own_lobes ? 1e-2f : 6e-3f;
        int compared = 0;
        for (const Fragment& f : renderer.surface_map().fragments) {
            const glm::vec3 wo = glm::normalize(glm::vec3(scene.eye_in_world_mm) - f.position_mm);
            const float mu = glm::dot(wo, f.normal);
            if (f.coverage < 1.0f || mu < 0.1f) continue;
            const BsdfEnvironment weights = environment_weights(model, paint, mu);
            glm::vec3 glossy = weights.specular + weights.coat;
            if (own_lobes) {
                const float at = std::sqrt(mu) * kSteps;
                const auto below = std::min(static_cast<std::size_t>(at), kSteps - 1);
                const float share = at - static_cast<float>(below);
                glossy = (1.0f - share) * mirrored[below] + share * mirrored[below + 1];
            }
            const glm::vec3 expected = 0.5f * (weights.diffuse + glossy);
            const float* pixel = &image.values[4 * f.pixel];
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(pixel[c], expected[c], tolerance * expected[c]) << info.name;
            }
            ++compared;
        }
        EXPECT_GT(compared, 200);
    }
}

TEST_P(Renderer, PixelOfTwoPartsIsTheirMeanByCoverage) {
    // A ball in uniform light 1 of which one half is of albedo .2, the other of .8: convex, so that
    // no part hides light from the other.
    Mesh ball = make_sphere({0, 0, 0}, 40.0, 128, "one half");
    ball.parts.push_back(ball.parts.front());
    ball.parts.back().name = "other half";
    for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
        const glm::vec3 at = ball.positions_mm[ball.triangles[t].x];
        ball.triangle_part[t] = 0.3f * at.x + at.y > 0.0f ? 1 : 0;
    }
    Scene scene = scene_of(std::move(ball), paint_of(ReflectanceModel::lambert, 0.5));
    scene.part_materials[0].diffuse = glm::dvec3(0.2);
    scene.part_materials[1].diffuse = glm::dvec3(0.8);
    Environment uniform;
    uniform.radiance_working = ImageF(32, 16, 3, 1.0f);
    scene.environment = std::make_shared<const Environment>(uniform);
    RadianceRenderer renderer = renderer_of(scene, test_view(128, 96));
    FramePlan its_plan = plan(scene, Quality::draft);
    renderer.render(scene, its_plan);
    const ImageF image = renderer.read_back();
    std::vector<float> light(image.pixel_count(), 0.0f), covered(image.pixel_count(), 0.0f);
    for (const Fragment& f : renderer.surface_map().fragments) {
        light[f.pixel] += f.coverage * (f.part == 0 ? 0.2f : 0.8f);
        covered[f.pixel] += f.coverage;
    }
    int mixed = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (covered[i] == 0.0f) continue;
        const float expected = light[i] / covered[i];
        ASSERT_NEAR(image.values[4 * i], expected, 2e-3f * expected);
        mixed += expected > 0.21f && expected < 0.79f ? 1 : 0;
    }
    EXPECT_GE(mixed, 5);
}

TEST_P(Renderer, RowsGoDownAndCoverageIsTheSurfaceMaps) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::lambert, 0.5));
    scene.lights = {light_from({0, 1, 0.2}, 0.0)};
    const View view = test_view(96, 72);
    RadianceRenderer renderer = renderer_of(scene, view);
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    const ImageF image = renderer.read_back();
    ASSERT_EQ(image.width, 96);
    ASSERT_EQ(image.height, 72);
    const SurfaceMap& map = renderer.surface_map();
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            ASSERT_NEAR(image.at(x, y, 3), map.coverage.at(x, y), 5e-4) << x << ' ' << y;
            if (map.coverage.at(x, y) == 0.0f) {
                ASSERT_EQ(image.at(x, y, 0), 0.0f);
            }
        }
    }
    // Every fully covered pixel of one fragment has Lambert's value at its own place, rounded to
    // half floats three times (light, fragment, pixel), by 2^-11 at most.
    const glm::dvec3 albedo = working_from_rec709() * scene.part_materials[0].diffuse;
    const glm::dvec3 toward = scene.lights[0].direction;
    int compared = 0;
    for (const Fragment& f : map.fragments) {
        const double cosine = glm::dot(glm::dvec3(f.normal), toward);
        if (f.coverage < 1.0f || cosine < 0.8) continue;
        const int x = static_cast<int>(f.pixel) % 96, y = static_cast<int>(f.pixel) / 96;
        const double expected = albedo.x * cosine * (working_from_rec709() * glm::dvec3(1.0)).x;
        if (image.at(x, y, 0) == 0.0f) continue;  // under the small sphere
        EXPECT_NEAR(image.at(x, y, 0), expected, 1.5e-3 * expected);
        ++compared;
    }
    EXPECT_GT(compared, 50);
}

/// A part of each model, one of them seen only at pixels that it shares, in every light.
Scene every_model(bool with_environment) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::clearcoat, 0.03));
    scene.part_materials[0].alpha = {0.2, 0.35};
    scene.part_materials[0].coat_transmittance = {0.3, 0.6, 0.9};
    scene.part_materials[1] = paint_of(ReflectanceModel::ggx, 0.12);
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05), light_from({-0.5, 0.8, 0.6}, 0.0, 0.4)};
    if (with_environment) scene.environment = studio();
    return scene;
}

TEST_P(Renderer, BothDevicesDrawTheSame) {
    const View view = test_view(96, 72);
    for (const bool with_environment : {false, true}) {
        Scene scene = every_model(with_environment);
        for (const auto model :
             {ReflectanceModel::ggx, ReflectanceModel::lambert, ReflectanceModel::car_paint}) {
            scene.part_materials[1] = paint_of(model, 0.12);
            scene.part_materials[1].film_nm = 320.0;
            const ImageF one = draw(scene, view, Quality::normal, GetParam());
            const ImageF other = draw(scene,
                                      view,
                                      Quality::normal,
                                      in_opengl() ? ShadingDevice::processor : ShadingDevice::gl);
            // Half floats hold a fragment in OpenGL, and a pixel's sum after each of its fragments:
            // 2^-11 each, six for a pixel of five.
            for (std::size_t i = 0; i < one.values.size(); ++i) {
                ASSERT_NEAR(one.values[i], other.values[i], 3e-3f * (0.01f + one.values[i])) << i;
            }
        }
    }
}

TEST_P(Renderer, TheTextureIsThePicture) {
    Scene scene = every_model(false);
    RadianceRenderer renderer = renderer_of(scene, test_view(48, 36));
    for (const double exposure : {0.0, 1.0}) {
        scene.exposure_ev = exposure;
        FramePlan its_plan = plan(scene);
        renderer.render(scene, its_plan);
        const ImageF wanted = renderer.read_back();
        const ImageF texture = read_floats(renderer.texture(), 48, 36, 4);
        for (std::size_t i = 0; i < wanted.values.size(); ++i) {
            ASSERT_NEAR(texture.values[i], wanted.values[i], 1e-3f * (1e-3f + wanted.values[i]));
        }
    }
}

TEST_P(Renderer, APictureOutlivesTheNextFrames) {
    Scene scene = every_model(false);
    RadianceRenderer renderer = renderer_of(scene, test_view(48, 36));
    std::vector<std::shared_ptr<const ImageF>> pictures;
    std::vector<ImageF> copies;
    for (int k = 0; k < 7; ++k) {
        scene.part_materials[1].diffuse = glm::dvec3(0.1 * k);
        FramePlan its_plan = plan(scene);
        renderer.render(scene, its_plan);
        if (k == 3) {
            pictures.clear();
            copies.clear();
        }
        pictures.push_back(renderer.picture());
        copies.push_back(renderer.read_back());
        for (std::size_t i = 0; i < copies.size(); ++i) {
            EXPECT_EQ(pictures[i]->values, copies[i].values) << k << " " << i;
        }
    }
}

TEST_P(Renderer, RefusesAnotherProductsSceneAnotherPlanAndTheReferenceLevel) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::ggx, 0.1));
    RadianceRenderer renderer = renderer_of(scene, test_view(32, 24));
    const Scene other = scene_of(two_spheres(), paint_of(ReflectanceModel::ggx, 0.1));
    FramePlan its_plan = plan(other);
    EXPECT_THROW(renderer.render(other, its_plan), std::invalid_argument);
    Scene lambert = scene;
    lambert.part_materials[0].model = ReflectanceModel::lambert;
    its_plan = plan(scene);
    try {
        renderer.render(lambert, its_plan);
        FAIL() << "accepted";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(),
                     "the plan has no pass \"shade:body:lambert\": it is of another scene");
    }
    its_plan = plan(scene, Quality::reference);
    EXPECT_THROW(renderer.render(scene, its_plan), std::invalid_argument);
}

}  // namespace
}  // namespace livery
