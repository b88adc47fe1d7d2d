// What the renderer runs, and what it leaves out: nothing is solved or drawn twice.
#include <atomic>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "radiance/renderer_fixture.h"
#include "support/shading_devices.h"

namespace livery {
namespace {

using RendererPasses = Renderer;

LIVERY_ON_BOTH_DEVICES(RendererPasses);

TEST_P(RendererPasses, UnchangedSceneRunsNothing) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::clearcoat, 0.05));
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05)};
    RadianceRenderer renderer = renderer_of(scene, test_view(64, 48));
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    const auto first = renderer.counters();
    EXPECT_EQ(first.passes_run, 6);  // surface map, visibility, directions, two parts, resolve
    EXPECT_EQ(first.programs, in_opengl() ? 2 : 0);
    const ImageF before = renderer.read_back();
    FramePlan again = plan(scene);
    renderer.render(scene, again);
    EXPECT_EQ(renderer.counters().passes_run, first.passes_run);
    EXPECT_EQ(renderer.counters().textures, first.textures);
    EXPECT_EQ(renderer.counters().fragments_shaded, first.fragments_shaded);
    for (const PlannedPass& pass : again.passes) EXPECT_EQ(pass.ms, 0.0) << to_string(pass.id);
    EXPECT_EQ(renderer.read_back().values, before.values);
}

TEST_P(RendererPasses, PaintSwapShadesOnlyItsPart) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::ggx, 0.1));
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05)};
    RadianceRenderer renderer = renderer_of(scene, test_view(64, 48));
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    const auto before = renderer.counters();
    scene.part_materials[1].diffuse = {0.1, 0.5, 0.2};
    FramePlan next = plan(scene);
    renderer.render(scene, next);
    const auto after = renderer.counters();
    EXPECT_EQ(after.passes_run - before.passes_run, 2);  // one part, resolve
    const auto& begin = renderer.surface_map().part_begin;
    EXPECT_EQ(after.fragments_shaded - before.fragments_shaded,
              static_cast<int>(begin[2] - begin[1]));
    EXPECT_EQ(after.programs, before.programs);

    // The same picture as drawn from nothing
    const ImageF fresh = draw(scene, test_view(64, 48));
    EXPECT_EQ(renderer.read_back().values, fresh.values);
}

TEST_P(RendererPasses, SolvesAheadAndPreparesWithoutDrawing) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::ggx, 0.1));
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05)};
    const auto geometry = std::make_shared<const FrameGeometry>(scene.product, test_view(64, 48));
    RadianceRenderer renderer(geometry, false, GetParam());
    FramePlan ahead = plan(scene);
    std::thread([&] { renderer.solve(scene, ahead); }).join();
    EXPECT_GT(*find_pass(ahead, visibility_pass(0))->ms, 0.0);
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    EXPECT_EQ(*find_pass(its_plan, visibility_pass(0))->ms, 0.0);
    const ImageF before = renderer.read_back();
    EXPECT_EQ(before.values, draw(scene, test_view(64, 48)).values);

    // Another model's program and light are made, and the picture still stands.
    const Scene plain = scene_of(two_spheres(), paint_of(ReflectanceModel::lambert, 0.1));
    Scene other = scene;
    other.part_materials = plain.part_materials;
    const auto counters = renderer.counters();
    FramePlan prepared = plan(other);
    renderer.prepare(other, prepared);
    EXPECT_EQ(renderer.counters().programs, counters.programs + (in_opengl() ? 1 : 0));
    FramePlan again = plan(scene);
    renderer.render(scene, again);
    EXPECT_EQ(renderer.counters().fragments_shaded, counters.fragments_shaded);
    EXPECT_EQ(renderer.read_back().values, before.values);
    FramePlan swapped = plan(other);
    renderer.render(other, swapped);
    EXPECT_EQ(*find_pass(swapped, PassKind::diffuse_light)->ms, 0.0);
    EXPECT_EQ(renderer.read_back().values, draw(other, test_view(64, 48)).values);
}

TEST_P(RendererPasses, AStopBetweenTwoPassesLosesNothing) {
    const View view = test_view(48, 36);
    Scene first = scene_of(two_spheres(), paint_of(ReflectanceModel::clearcoat, 0.1));
    first.part_materials[1] = paint_of(ReflectanceModel::lambert, 0.1);
    first.lights = {light_from({0.5, 0.8, 0.6}, 0.05), light_from({-0.5, 0.8, 0.6}, 0.0)};
    first.environment = studio();
    Scene second = first;
    second.lights = {light_from({-0.2, 0.9, 0.6}, 0.0), first.lights[1]};
    auto turned = std::make_shared<Environment>(*first.environment);
    turned->rotation_rad += 1.0;
    second.environment = turned;
    second.eye_in_world_mm.x += 50.0;
    const ImageF first_alone = draw(first, view), second_alone = draw(second, view);
    RadianceRenderer renderer = renderer_of(first, view);
    FramePlan its_plan = plan(first);
    renderer.render(first, its_plan);
    int stopped = 0;
    bool shows_first = true;
    for (bool through = false; !through;) {
        const Scene& next = shows_first ? second : first;
        std::atomic<bool> stop{false};
        int stages = 0;
        const int last_stage = stopped / 2;
        const Progress progress{[&](double, std::string_view) { stop = stages++ == last_stage; },
                                &stop};
        FramePlan abandoned = plan(next);
        try {
            renderer.solve(next, abandoned, progress);
            through = true;
        } catch (const Cancelled&) {
            ++stopped;
        }
        // On to what was begun after every other stop, back to what was there after the others
        if (stopped % 2 == 1) shows_first = !shows_first;
        const Scene& shown = shows_first ? first : second;
        FramePlan last = plan(shown);
        renderer.render(shown, last);
        EXPECT_EQ(renderer.read_back().values, (shows_first ? first_alone : second_alone).values)
            << stopped;
    }
    EXPECT_GE(stopped, 4);
}

TEST_P(RendererPasses, ATurnedOrDimmedEnvironmentIsNotFilteredAgain) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::ggx, 0.1));
    scene.environment = studio();
    RadianceRenderer renderer = renderer_of(scene, test_view(48, 36));
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    auto turned = std::make_shared<Environment>(*scene.environment);
    turned->rotation_rad += 1.0;
    turned->scale *= 0.5;
    scene.environment = turned;
    FramePlan next = plan(scene);
    renderer.render(scene, next);
    EXPECT_EQ(*find_pass(next, PassKind::environment_filter)->ms, 0.0);
    EXPECT_GT(*find_pass(next, PassKind::mirrored_environment)->ms, 0.0);
    EXPECT_EQ(renderer.read_back().values, draw(scene, test_view(48, 36)).values);
}

TEST_P(RendererPasses, ADraftOfANewLightKeepsTheBetterEnvironmentWhereAsked) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::ggx, 0.1));
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.0)};
    scene.environment = studio();
    const View view = test_view(48, 36);
    RadianceRenderer renderer(
        std::make_shared<const FrameGeometry>(scene.product, view), true, GetParam());
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    scene.lights[0].direction = {0.0, 0.6, 0.8};
    FramePlan draft = plan(scene, Quality::draft);
    renderer.render(scene, draft);
    EXPECT_EQ(*find_pass(draft, PassKind::environment_irradiance)->ms, 0.0);
    EXPECT_EQ(*find_pass(draft, PassKind::mirrored_environment)->ms, 0.0);
    // Points at infinity take a ray a sub-sample at every level but draft.
    FramePlan whole = plan(scene);
    renderer.render(scene, whole);
    EXPECT_EQ(*find_pass(whole, PassKind::ambient_occlusion)->ms, 0.0);
    EXPECT_EQ(renderer.read_back().values, draw(scene, view).values);
}

TEST_P(RendererPasses, WhatIsNotInThePlanCostsNothing) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::lambert, 0.5));
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05), light_from({0, 1, 0}, 0.0, 0.0)};
    RadianceRenderer renderer = renderer_of(scene, test_view(64, 48));
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    // One shading program for both parts, and resolve; the black light is not solved.
    EXPECT_EQ(renderer.counters().programs, in_opengl() ? 2 : 0);
    EXPECT_EQ(renderer.counters().passes_run, 6);
    // The shaded fragments and the light on diffuse parts; in OpenGL the target and two of resolve
    EXPECT_EQ(renderer.counters().textures, in_opengl() ? 5 : 2);
    EXPECT_EQ(static_cast<std::size_t>(renderer.counters().passes_run), its_plan.passes.size());
}

TEST_P(RendererPasses, EveryPlannedPassIsTimedAndCounted) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::ggx, 0.1));
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05)};
    scene.part_materials[1] = paint_of(ReflectanceModel::lambert, 0.5);
    RadianceRenderer renderer = renderer_of(scene, test_view(64, 48));
    FramePlan its_plan = plan(scene);
    renderer.count_work(scene, its_plan);
    for (const PlannedPass& pass : its_plan.passes)
        EXPECT_GT(pass.work_items, 0.0) << to_string(pass.id);
    renderer.render(scene, its_plan);
    for (const PlannedPass& pass : its_plan.passes) {
        ASSERT_TRUE(pass.ms.has_value()) << to_string(pass.id);
        EXPECT_GT(*pass.ms, 0.0) << to_string(pass.id);
    }
}

}  // namespace
}  // namespace livery
