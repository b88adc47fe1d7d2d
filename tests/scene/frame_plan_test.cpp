#include "scene/frame_plan.h"

#include <set>

#include <gtest/gtest.h>

#include "scene/grey_environment.h"

namespace livery {
namespace {

Product two_part_product() {
    Product product;
    product.mesh = make_sphere({0, 0, 0}, 10.0, 4, "body");
    append(product.mesh, make_sphere({30, 0, 0}, 10.0, 4, "wheels"), "");
    return product;
}

/// Two diffuse parts, no light, no environment.
Scene bare_scene() {
    Scene scene;
    scene.product = std::make_shared<const Product>(two_part_product());
    scene.part_materials.resize(2);
    return scene;
}

DirectionalLight light(double angle_rad, double radiance = 1.0) {
    DirectionalLight result;
    result.angle_rad = angle_rad;
    result.radiance_rec709 = glm::dvec3(radiance);
    return result;
}

std::set<std::string> passes(const FramePlan& plan) {
    std::set<std::string> names;
    for (const PlannedPass& pass : plan.passes) names.insert(to_string(pass.id));
    return names;
}

FramePlan told_plan(const Scene& scene, Quality quality, FrameStage stage) {
    FramePlan plan = plan_frame(scene, quality, stage);
    say_why(scene, plan);
    return plan;
}

std::string why(const FramePlan& plan, const std::string& name) {
    for (const PlannedPass& pass : plan.passes) {
        if (to_string(pass.id) == name) return pass.why;
    }
    for (const SkippedPass& pass : plan.skipped) {
        if (to_string(pass.id) == name) return pass.why;
    }
    return "not listed";
}

TEST(FramePlan, DiffuseSceneWithoutLightNeedsFewKindsOfPass) {
    const FramePlan plan = told_plan(bare_scene(), Quality::high, FrameStage::radiance);
    EXPECT_EQ(passes(plan),
              (std::set<std::string>{"surface-map",
                                     "diffuse-light",
                                     "shade:body:lambert",
                                     "shade:wheels:lambert",
                                     "resolve"}));
    EXPECT_EQ(why(plan, "key-visibility"), "the look has no light");
    EXPECT_EQ(why(plan, "ambient-occlusion"), "no environment in the look");
    EXPECT_EQ(why(plan, "environment-filter"), "no environment in the look");
    EXPECT_EQ(why(plan, "shade:*:ggx"), "no part uses GGX");
    EXPECT_EQ(why(plan, "shade:*:clearcoat"), "no paint has a clear coat");
    EXPECT_EQ(why(plan, "directions"), "every paint looks the same from every side");
    EXPECT_EQ(why(plan, "compensation"), "the frame stops at radiance");
}

TEST(FramePlan, LightsSayTheirNamesAndWidths) {
    Scene scene = bare_scene();
    scene.lights = {light(3.0 * 3.14159265358979 / 180.0), light(0.0), light(0.1, 0.0)};
    const FramePlan plan = told_plan(scene, Quality::normal, FrameStage::projector);
    EXPECT_EQ(why(plan, "key-visibility"), "the look has a key light 3° wide: soft shadows");
    EXPECT_EQ(why(plan, "fill-visibility"), "the look has a fill light, a point: sharp shadows");
    EXPECT_EQ(why(plan, "light-3-visibility"), "the light-3 light is black");
    EXPECT_EQ(find_pass(plan, visibility_pass(2)), nullptr);
    ASSERT_NE(find_pass(plan, PassKind::compensation), nullptr);
    const FramePlan draft = told_plan(scene, Quality::draft, FrameStage::radiance);
    EXPECT_EQ(why(draft, "key-visibility"),
              "the look has a key light 3° wide; draft shows its shadows sharp");
}

TEST(FramePlan, SaysWhetherFlakesGlintAndHowLargeTheyAreDrawn) {
    Scene scene = bare_scene();
    scene.environment = grey_environment();
    Material& paint = scene.part_materials[0];
    paint.name = "gold";
    paint.model = ReflectanceModel::car_paint;
    FramePlan plan = told_plan(scene, Quality::normal, FrameStage::radiance);
    EXPECT_EQ(why(plan, "glint-places"), "no paint of the scene has glints");
    paint.glint_density_per_mm2 = 1000.0;
    scene.lights = {light(0.1, 0.0)};
    plan = told_plan(scene, Quality::normal, FrameStage::radiance);
    EXPECT_EQ(why(plan, "glint-places"), "flakes glint under lights; the look has none");
    EXPECT_EQ(why(plan, "shade:body:car-paint"), "gold is a car paint with flakes");
    scene.lights.push_back(light(0.1));
    plan = told_plan(scene, Quality::normal, FrameStage::radiance);
    EXPECT_EQ(why(plan, "glint-places"),
              "how much of the product a pixel covers, and how many flakes: once for a pose");
    EXPECT_EQ(
        why(plan, "shade:body:car-paint+glints"),
        "gold is a car paint with flakes, which glint: 1000 on a square millimetre, physical");
    paint.glint_scale = 30.0;
    plan = told_plan(scene, Quality::normal, FrameStage::radiance);
    EXPECT_EQ(why(plan, "shade:body:car-paint+glints"),
              "gold is a car paint with flakes, which glint: 1000 on a square millimetre, "
              "exaggerated 30 times");
    // Of another model they mean nothing.
    paint.model = ReflectanceModel::clearcoat;
    plan = told_plan(scene, Quality::normal, FrameStage::radiance);
    EXPECT_EQ(why(plan, "glint-places"), "no paint of the scene has glints");
}

TEST(FramePlan, EnvironmentCallsOnlyForWhatThePaintsUse) {
    Scene scene = bare_scene();
    scene.environment = grey_environment();
    FramePlan plan = told_plan(scene, Quality::normal, FrameStage::radiance);
    EXPECT_TRUE(passes(plan).contains("environment-irradiance"));
    EXPECT_TRUE(passes(plan).contains("ambient-occlusion"));
    EXPECT_FALSE(passes(plan).contains("environment-filter"));
    EXPECT_EQ(why(plan, "environment-filter"), "no part mirrors the environment: all are diffuse");

    scene.part_materials[1].model = ReflectanceModel::clearcoat;
    scene.part_materials[1].name = "Garnet Red";
    plan = told_plan(scene, Quality::normal, FrameStage::radiance);
    EXPECT_EQ(why(plan, "environment-filter"), "part wheels mirrors the environment");
    EXPECT_EQ(why(plan, "reflection-occlusion"), "part wheels may mirror other parts");
    EXPECT_EQ(why(plan, "directions"), "the gloss of part wheels depends on where the eye is");
    EXPECT_EQ(why(plan, "shade:wheels:clearcoat"), "Garnet Red is a paint under a clear coat");
    EXPECT_EQ(why(plan, "shade:*:ggx"), "no part uses GGX");

    plan = told_plan(scene, Quality::draft, FrameStage::radiance);
    EXPECT_EQ(why(plan, "ambient-occlusion"),
              "joints are darker than what they join; draft looks at nothing else");
    EXPECT_EQ(find_pass(plan, PassKind::reflection_occlusion), nullptr);
    EXPECT_NE(find_pass(plan, PassKind::environment_filter), nullptr);

    Environment dark = *scene.environment;
    dark.scale = 0.0;
    scene.environment = std::make_shared<const Environment>(dark);
    plan = told_plan(scene, Quality::normal, FrameStage::radiance);
    EXPECT_EQ(why(plan, "environment-irradiance"), "no environment in the look");
}

TEST(FramePlan, EveryPassIsEitherPlannedOrSkippedNeverBoth) {
    for (const bool lit : {false, true}) {
        for (const bool environment : {false, true}) {
            for (const auto model :
                 {ReflectanceModel::lambert, ReflectanceModel::ggx, ReflectanceModel::clearcoat}) {
                for (const auto quality :
                     {Quality::draft, Quality::normal, Quality::high, Quality::reference}) {
                    Scene scene = bare_scene();
                    if (lit) scene.lights = {light(0.05)};
                    if (environment) scene.environment = grey_environment();
                    scene.part_materials[0].model = model;
                    const FramePlan plan = told_plan(scene, quality, FrameStage::projector);
                    std::set<std::string> names = passes(plan);
                    EXPECT_EQ(names.size(), plan.passes.size()) << "a pass is listed twice";
                    for (const SkippedPass& pass : plan.skipped) {
                        EXPECT_TRUE(names.insert(to_string(pass.id)).second) << to_string(pass.id);
                        EXPECT_FALSE(pass.why.empty());
                    }
                    for (const PlannedPass& pass : plan.passes) EXPECT_FALSE(pass.why.empty());
                    EXPECT_EQ(plan.quality, quality);
                }
            }
        }
    }
}

TEST(FramePlan, ReferenceIsThePathTracer) {
    const FramePlan plan = told_plan(bare_scene(), Quality::reference, FrameStage::radiance);
    EXPECT_EQ(passes(plan), (std::set<std::string>{"path-tracer"}));
}

TEST(FramePlan, QualityNamesRoundTripAndWrongOnesAreNamed) {
    for (const char* name : {"draft", "normal", "high", "reference"}) {
        EXPECT_EQ(to_string(parse_quality(name)), name);
    }
    try {
        parse_quality("ultra");
        FAIL() << "accepted";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(),
                     "quality \"ultra\" is not one of draft, normal, high, reference");
    }
}

TEST(FramePlan, RefusesMaterialsThatDoNotMatchTheParts) {
    Scene scene = bare_scene();
    scene.part_materials.resize(1);
    EXPECT_THROW(plan_frame(scene, Quality::normal, FrameStage::radiance), std::invalid_argument);
    scene.product = nullptr;
    EXPECT_THROW(plan_frame(scene, Quality::normal, FrameStage::radiance), std::invalid_argument);
}

}  // namespace
}  // namespace livery
