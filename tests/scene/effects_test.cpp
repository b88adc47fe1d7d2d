#include "scene/effects.h"

#include <set>

#include <gtest/gtest.h>

#include "appearance/material_library.h"
#include "appearance/parameter_table.h"
#include "scene/frame_plan.h"
#include "scene/grey_environment.h"

namespace livery {
namespace {

Scene sphere_scene() {
    Product product;
    product.mesh = make_sphere({0, 0, 0}, 10.0, 8, "body");
    Scene scene;
    scene.product = std::make_shared<const Product>(std::move(product));
    scene.part_materials.resize(1);
    return scene;
}

TEST(EffectTable, StandsInOrderWithNamesOfItsOwn) {
    std::set<std::string> names;
    ASSERT_EQ(effect_table().size(), kEffects);
    for (std::size_t k = 0; k < kEffects; ++k) {
        const EffectInfo& info = effect_table()[k];
        EXPECT_EQ(static_cast<std::size_t>(info.effect), k);
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_GE(info.levels.size(), 2u) << info.name;
        std::set<std::string> levels;
        for (const EffectLevel& level : info.levels) {
            EXPECT_TRUE(levels.insert(level.name).second) << info.name << " " << level.name;
        }
    }
}

TEST(EffectLevels, OfDearerQualitiesAreNoneLower) {
    const EffectLevels draft = levels_of(Quality::draft), normal = levels_of(Quality::normal),
                       high = levels_of(Quality::high);
    for (std::size_t k = 0; k < kEffects; ++k) {
        EXPECT_LE(draft.of[k], normal.of[k]) << effect_table()[k].name;
        EXPECT_LE(normal.of[k], high.of[k]) << effect_table()[k].name;
    }
    for (const Quality quality : {Quality::draft, Quality::normal, Quality::high}) {
        EXPECT_NO_THROW(check_levels(levels_of(quality)));
        EXPECT_EQ(nearest_quality(levels_of(quality)), quality);
    }
    EXPECT_THROW(levels_of(Quality::reference), std::invalid_argument);
}

TEST(EffectLevels, AreRefusedWhereTheirEffectHasNone) {
    for (const EffectInfo& info : effect_table()) {
        EffectLevels levels = levels_of(Quality::normal);
        levels[info.effect] = static_cast<int>(info.levels.size());
        EXPECT_THROW(check_levels(levels), std::invalid_argument) << info.name;
        EXPECT_THROW(plan_frame(sphere_scene(), levels, FrameStage::radiance),
                     std::invalid_argument)
            << info.name;
        levels[info.effect] = -1;
        EXPECT_THROW(check_levels(levels), std::invalid_argument) << info.name;
    }
}

TEST(AtLevels, LeavesOutWhatIsLeftOutAndNothingElse) {
    Scene scene = sphere_scene();
    scene.environment = grey_environment();
    scene.lights.emplace_back();
    Material& paint = scene.part_materials[0];
    paint.model = ReflectanceModel::car_paint;
    paint.glint_density_per_mm2 = 1000.0;
    paint.film_nm = 300.0;
    EffectLevels levels = levels_of(Quality::high);
    Scene same = at_levels(scene, levels);
    EXPECT_EQ(same.environment, scene.environment);
    EXPECT_TRUE(same_reflectance(same.part_materials[0], paint));
    for (const Effect effect : {Effect::glints, Effect::film, Effect::environment}) {
        EXPECT_TRUE(calls_for(scene, effect));
        levels[effect] = 0;
        EXPECT_FALSE(calls_for(at_levels(scene, levels), effect));
        levels[effect] = 1;
    }
}

TEST(AtLevels, ThePlanSaysWhatIsLeftOut) {
    Scene scene = sphere_scene();
    scene.environment = grey_environment();
    scene.lights.emplace_back();
    EffectLevels levels{};
    FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
    say_why(scene, plan);
    const auto why = [&](PassId id) -> std::string {
        for (const SkippedPass& pass : plan.skipped) {
            if (pass.id == id) return pass.why;
        }
        return "not skipped";
    };
    EXPECT_EQ(why(visibility_pass(0)), "the key light is drawn without shadows");
    EXPECT_EQ(why(PassKind::ambient_occlusion), "the environment is left out");
    EXPECT_EQ(plan.levels, levels);
    EXPECT_EQ(plan.quality, Quality::draft);
}

/// Two plates of two parts, one over the other, face to face.
Mesh facing_plates(double apart_mm) {
    Mesh mesh;
    const auto plate = [&](float y, float up, const char* name) {
        const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
        for (const glm::vec2 at : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
            mesh.positions_mm.emplace_back(at.x, y, at.y);
            mesh.normals.emplace_back(0.0f, up, 0.0f);
            mesh.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
            mesh.uvs.emplace_back(0.0f);
        }
        const bool flipped = up < 0.0f;
        mesh.triangles.emplace_back(first, first + (flipped ? 1 : 2), first + (flipped ? 2 : 1));
        mesh.triangles.emplace_back(first, first + (flipped ? 2 : 3), first + (flipped ? 3 : 2));
        mesh.triangle_part.insert(
            mesh.triangle_part.end(), 2, static_cast<std::uint16_t>(mesh.parts.size()));
        mesh.parts.push_back({name, "", glm::dvec3(0.5)});
    };
    plate(0.0f, 1.0f, "floor");
    plate(static_cast<float>(apart_mm), -1.0f, "roof");
    return mesh;
}

TEST(PartExchange, OfFacingPlatesIsTheFormFactor) {
    // At the middle of a square of side 2 under another at 2: four squares of side 1 over a corner
    const double a = 0.5, p = std::sqrt(1.0 + a * a);
    const double middle = 4.0 * 2.0 * (a / p * std::atan(a / p)) / (2.0 * 3.14159265358979);
    const PartExchange exchange = part_exchange(facing_plates(2.0));
    for (const auto& [to, from] : {std::pair{0, 1}, {1, 0}}) {
        const auto found = static_cast<double>(
            exchange.of(static_cast<std::size_t>(to), static_cast<std::size_t>(from)));
        EXPECT_LE(found, 1.05 * middle);
        EXPECT_GE(found, 0.85 * middle);
    }
    EXPECT_EQ(exchange.of(0, 0), 0.0f);
}

TEST(PartExchange, OfWhatIsConvexIsNone) {
    const PartExchange exchange = part_exchange(make_sphere({0, 0, 0}, 10.0, 16, "ball"));
    EXPECT_LT(exchange.of(0, 0), 1e-6f);
}

TEST(Interreflection, IsCalledForByWhatFacesEachOtherAndIsBright) {
    Scene scene;
    Product product;
    product.mesh = facing_plates(2.0);
    product.exchange = part_exchange(product.mesh);
    scene.product = std::make_shared<const Product>(std::move(product));
    scene.part_materials.resize(2);
    scene.lights.emplace_back();
    const auto planned = [&] { return plan_frame(scene, Quality::high, FrameStage::radiance); };
    for (Material& paint : scene.part_materials) paint.diffuse = glm::dvec3(0.8);
    EXPECT_NE(find_pass(planned(), PassKind::interreflection), nullptr);
    EXPECT_NEAR(exchange_bound(scene).share, 0.8 * 0.24, 0.03);
    const auto skipped = [&](const FramePlan& plan) {
        for (const SkippedPass& pass : plan.skipped) {
            if (pass.id == PassKind::interreflection) return pass;
        }
        return SkippedPass{PassKind::interreflection, "runs"};
    };
    // Left out by a level, it says what that costs at most.
    const SkippedPass left_out = skipped(plan_frame(scene, Quality::draft, FrameStage::radiance));
    ASSERT_TRUE(left_out.error_bound.has_value());
    EXPECT_GT(*left_out.error_bound, 2.0);
    // Where all is black nobody sees it.
    for (Material& paint : scene.part_materials) paint.diffuse = glm::dvec3(0.01);
    ASSERT_TRUE(skipped(planned()).error_bound.has_value());
    EXPECT_LT(*skipped(planned()).error_bound, 0.25);
    // Nor without light, nor on what is convex.
    scene.lights.clear();
    const auto why = [&](const Scene& of) {
        FramePlan plan = plan_frame(of, Quality::high, FrameStage::radiance);
        say_why(of, plan);
        return skipped(plan).why;
    };
    EXPECT_EQ(why(scene), "no part has light to send on");
    Scene ball = sphere_scene();
    ball.lights.emplace_back();
    EXPECT_EQ(why(ball), "no part faces another, or itself");
}

/// Why the plan lists the pass, or does not.
std::string told(const Scene& scene, FramePlan plan, const PassId& id) {
    say_why(scene, plan);
    if (const PlannedPass* pass = find_pass(plan, id)) return "runs: " + pass->why;
    for (const SkippedPass& pass : plan.skipped) {
        if (pass.id == id) return "skipped: " + pass.why;
    }
    return "neither";
}

TEST(Subsurface, IsCalledForWhereLightGoesFarEnough) {
    Scene scene = sphere_scene();
    scene.lights.emplace_back();
    const auto at = [&](EffectLevels levels) {
        return told(scene, plan_frame(scene, levels, FrameStage::radiance), PassKind::subsurface);
    };
    EffectLevels levels = levels_of(Quality::high);
    EXPECT_EQ(at(levels), "skipped: no part is translucent");
    EXPECT_FALSE(calls_for(scene, Effect::subsurface));

    scene.part_materials[0] = find_material("marble");
    EXPECT_TRUE(calls_for(scene, Effect::subsurface));
    const double reach = subsurface_reach_mm(scene.part_materials[0], 1.0);
    EXPECT_GT(reach, 5.0);  // red light goes farthest
    EXPECT_LT(reach, 10.0);
    EXPECT_EQ(at(levels),
              "runs: nine tenths of the light that enters part body leaves it within 7.1 mm");
    EXPECT_TRUE(at_levels(scene, levels).part_materials[0].medium);
    levels[Effect::subsurface] = 0;
    EXPECT_EQ(at(levels),
              "skipped: nine tenths of the light that enters part body leaves it within 7.1 mm; "
              "left out");
    EXPECT_EQ(at_levels(scene, levels).part_materials[0].model, ReflectanceModel::ggx);

    levels = levels_of(Quality::high);
    scene.lights.clear();
    EXPECT_EQ(at(levels), "skipped: no light enters any part");
    // A mock-up of 1:100
    scene.lights.emplace_back();
    Product small = *scene.product;
    small.product_scale = 100.0;
    scene.product = std::make_shared<const Product>(small);
    EXPECT_EQ(at(levels),
              "skipped: of the light that enters translucent parts nine tenths leave within 0.3 "
              "mm, or less than 0.05% leaves at all");
    EXPECT_EQ(at_levels(scene, levels).part_materials[0].model, ReflectanceModel::ggx);
    // A drink through which light goes and hardly ever comes back
    scene.part_materials[0] = find_material("merlot");
    EXPECT_EQ(subsurface_reach_mm(scene.part_materials[0], 1.0), 0.0);
    scene.part_materials[0] = find_material("marble");
    EXPECT_NEAR(subsurface_reach_mm(scene.part_materials[0], 100.0), reach / 100.0, 1e-9);
}

TEST(Subsurface, IsNotOfArtwork) {
    Scene scene = sphere_scene();
    scene.lights.emplace_back();
    PartArtwork artwork;
    artwork.material = find_material("marble");
    scene.artwork = {artwork};
    EXPECT_EQ(
        told(scene, plan_frame(scene, Quality::high, FrameStage::radiance), PassKind::subsurface),
        "skipped: no part is translucent");
    EXPECT_EQ(at_levels(scene, levels_of(Quality::high)).artwork[0].material.model,
              ReflectanceModel::ggx);
}

}  // namespace
}  // namespace livery
