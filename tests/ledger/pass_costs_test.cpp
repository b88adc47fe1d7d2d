#include <gtest/gtest.h>

#include "appearance/model_table.h"
#include "ledger/paint_cost.h"
#include "ledger/predictions.h"
#include "scene/library.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

TEST(PassCosts, ComeBackAsTheyWereWritten) {
    const TemporaryFolder folder;
    const auto file = folder / "bench.json";
    EXPECT_FALSE(read_pass_costs(file));
    for (const CostOrigin origin : {CostOrigin::measured, CostOrigin::scaled}) {
        write_pass_costs(
            file, {{{PassKind::surface_map, 2, 1.5, 0.5, 1000.0, 1.25}}, origin, "a renderer", 8});
        const auto costs = read_pass_costs(file);
        ASSERT_TRUE(costs && costs->passes.size() == 1);
        EXPECT_EQ(costs->passes[0].pass, PassId(PassKind::surface_map));
        EXPECT_EQ(costs->passes[0].level, 2);  // by its name
        EXPECT_EQ(costs->passes[0].ms, 1.5);
        EXPECT_EQ(costs->passes[0].fixed_ms, 0.5);
        EXPECT_EQ(costs->passes[0].fragments_per_pixel, 1.25);
        EXPECT_EQ(costs->origin, origin);
        EXPECT_EQ(costs->renderer, "a renderer");
        EXPECT_EQ(costs->threads, 8);
    }
}

TEST(PassCosts, OfWholeQualitiesAreNotTakenForThoseOfLevels) {
    EXPECT_FALSE(parse_pass_costs(R"({"format_version": 1, "passes": [
                     {"pass": "resolve", "quality": "high", "ms": 1, "work_items": 1}]})",
                                  "bench.json"));
    EXPECT_FALSE(parse_pass_costs(R"({"format_version": 2, "passes": [
                     {"pass": "resolve", "level": 0, "ms": 1, "work_items": 1}]})",
                                  "bench.json"));
}

TEST(PassCosts, KnowEveryPassAgain) {
    const TemporaryFolder folder;
    const auto file = folder / "bench.json";
    PassCosts costs;
    costs.threads = 1;
    for (const PassId& pass : {PassId(PassKind::path_tracer),
                               PassId(PassKind::light_visibility),
                               PassId(PassKind::shade, "", ReflectanceModel::lambert),
                               PassId(PassKind::shade, "", ReflectanceModel::car_paint, true),
                               PassId(PassKind::shade, "", ReflectanceModel::measured),
                               PassId(PassKind::compensation)}) {
        costs.passes.push_back({pass, 0, 1.0, 0.0, 2.0, {}});
    }
    write_pass_costs(file, costs);
    const auto read = read_pass_costs(file);
    ASSERT_TRUE(read);
    ASSERT_EQ(read->passes.size(), costs.passes.size());
    for (std::size_t i = 0; i < costs.passes.size(); ++i) {
        EXPECT_EQ(read->passes[i].pass, costs.passes[i].pass);
    }
}

TEST(PassCosts, WhatAnotherVersionTimedIsLeftOut) {
    const auto costs = parse_pass_costs(
        R"({"format_version": 3, "passes": [
            {"pass": "gone", "level": "", "ms": 1, "fixed_ms": 0, "work_items": 1},
            {"pass": "ambient-occlusion", "level": "gone", "ms": 1, "fixed_ms": 0, "work_items": 1},
            {"pass": "shade:ggx", "level": "", "ms": 2, "fixed_ms": 0, "work_items": 1}]})",
        "bench.json");
    ASSERT_TRUE(costs && costs->passes.size() == 1);
    EXPECT_EQ(costs->passes[0].pass, PassId(PassKind::shade, "", ReflectanceModel::ggx));
    EXPECT_EQ(costs->origin, CostOrigin::measured);
}

TEST(PassCosts, DependOnNeitherPartNorLight) {
    PassId shading(PassKind::shade, "body", ReflectanceModel::car_paint, true);
    shading.artwork = 2;
    EXPECT_EQ(cost_key(shading), PassId(PassKind::shade, "", ReflectanceModel::car_paint, true));
    EXPECT_EQ(cost_key(visibility_pass(3)), PassId(PassKind::light_visibility));
}

TEST(PassCosts, AreThoseOfTheLevel) {
    FramePlan plan;
    plan.levels = levels_of(Quality::normal);
    plan.passes.resize(2);
    plan.passes[0].id = PassKind::light_visibility;
    plan.passes[0].work_items = 20.0;
    plan.passes[1].id = PassKind::resolve;
    plan.passes[1].work_items = 10.0;
    const int soft = plan.levels[Effect::shadows];
    const std::vector<PassCost> costs{{PassKind::light_visibility, soft, 5.0, 1.0, 10.0, {}},
                                      {PassKind::resolve, 0, 1.0, 0.0, 10.0, {}}};
    EXPECT_EQ(predict_times(plan, costs), "");
    // 1 ms whatever there is to do, .4 ms an item
    EXPECT_DOUBLE_EQ(plan.passes[0].predicted_ms.value_or(0.0), 9.0);
    EXPECT_DOUBLE_EQ(plan.passes[1].predicted_ms.value_or(0.0), 1.0);
    EXPECT_TRUE(predicted_time(plan).complete);
    EXPECT_DOUBLE_EQ(predicted_time(plan).all_ms, 10.0);
    EXPECT_DOUBLE_EQ(predicted_time(plan).swap_ms, 1.0);
    plan.passes[0].predicted_ms.reset();
    plan.levels[Effect::shadows] = soft + 1;
    EXPECT_NE(predict_times(plan, costs), "");
    EXPECT_FALSE(plan.passes[0].predicted_ms.has_value());
    EXPECT_NE(plan.passes[0].unpredicted_because.find("at shadows=64 rays"), std::string::npos)
        << plan.passes[0].unpredicted_because;
    EXPECT_FALSE(predicted_time(plan).complete);
}

TEST(PassCosts, ABlackEnvironmentIsFilteredAsALitOne) {
    const std::vector<PassCost> costs{{PassKind::environment_filter, 1, 90.0, 0.0, 1000.0, {}}};
    EffectLevels levels = levels_of(Quality::normal);
    levels[Effect::environment] = 0;
    EXPECT_EQ(find_cost(costs, PassKind::environment_filter, levels), &costs[0]);
    EXPECT_EQ(find_cost(costs, PassKind::environment_irradiance, levels), nullptr);
}

TEST(PassCosts, ALevelThatIsNoneIsNamed) {
    EXPECT_TRUE(fails_with(
        [] {
            parse_pass_costs(R"({"format_version": 3, "passes": [
                                 {"pass": "a", "level": -1, "ms": 1, "work_items": 1}]})",
                             "bench.json");
        },
        {"bench.json: passes[0].level: ", "found -1"}));
}

TEST(PassCosts, SayWhatAPaintCosts) {
    const std::vector<PassCost> costs{
        {PassId(PassKind::shade, "", ReflectanceModel::ggx), 0, 3.0, 0.0, 1e6, {}},
        {PassId(PassKind::shade, "", ReflectanceModel::car_paint, true), 0, 8.0, 0.0, 1e6, {}},
        {PassId(PassKind::shade, "", ReflectanceModel::eon), 0, 3.0, 0.0, 0.0, {}}};
    Material paint;
    paint.model = ReflectanceModel::ggx;
    const PaintCost ggx = paint_cost(paint, costs);
    ASSERT_TRUE(ggx.ns_a_pixel);
    EXPECT_DOUBLE_EQ(*ggx.ns_a_pixel, 3.0);
    EXPECT_TRUE(ggx.why_not.empty());
    paint.model = ReflectanceModel::eon;
    const PaintCost eon = paint_cost(paint, costs);
    EXPECT_FALSE(eon.ns_a_pixel);
    EXPECT_EQ(eon.why_not, "nobody has timed eon");
    paint.model = ReflectanceModel::car_paint;
    EXPECT_EQ(paint_cost(paint, costs).why_not, "nobody has timed car-paint");
    paint.glint_density_per_mm2 = 100.0;
    EXPECT_DOUBLE_EQ(paint_cost(paint, costs).ns_a_pixel.value_or(0.0), 8.0);
}

TEST(ShippedCosts, KnowWhateverAShippedLookCallsFor) {
    const PassCosts shipped = shipped_pass_costs();
    EXPECT_EQ(shipped.origin, CostOrigin::shipped);
    const auto product = find_product("car");
    for (const std::string& name : shipped_looks()) {
        const Scene scene = make_scene(product, find_look(name), {0.0, 1000.0, 3000.0});
        for (const Quality quality : {Quality::draft, Quality::normal, Quality::high}) {
            for (const PlannedPass& pass :
                 plan_frame(scene, quality, FrameStage::projector).passes) {
                EXPECT_NE(find_cost(shipped.passes, pass.id, levels_of(quality)), nullptr)
                    << name << ", " << to_string(quality) << ": " << to_string(pass.id);
            }
        }
    }
    for (const ModelInfo& info : formula_models()) {
        Material paint;
        paint.model = info.model;
        EXPECT_TRUE(paint_cost(paint, shipped.passes).ns_a_pixel) << info.name;
    }
}

}  // namespace
}  // namespace livery
