// What a quality level costs, summed from the last bench.
#include "studio/quality_costs.h"

#include <gtest/gtest.h>

namespace livery {
namespace {

PassId shading(ReflectanceModel model, bool glints = false) {
    return {PassKind::shade, "", model, glints};
}

PassCost cost(const PassId& pass, Quality quality, double ms, double items) {
    PassCost one;
    one.pass = pass;
    one.quality = quality;
    one.ms = ms;
    one.work_items = items;
    return one;
}

TEST(QualityCost, PartsWhatIsSolvedFromWhatRunsEveryFrame) {
    std::vector<PassCost> costs{
        cost(PassKind::surface_map, Quality::normal, 1000.0, 0.0),
        cost(PassKind::light_visibility, Quality::normal, 400.0, 1000.0),
        cost(shading(ReflectanceModel::ggx), Quality::normal, 8.0, 600.0),
        cost(PassKind::resolve, Quality::normal, 2.0, 1000.0),
        cost(shading(ReflectanceModel::car_paint, true), Quality::normal, 9.0, 600.0),
        cost(PassKind::glint_places, Quality::normal, 3.0, 600.0),
        cost(PassKind::compensation, Quality::normal, 4.0, 1000.0),
        cost(PassKind::resolve, Quality::draft, 1.0, 0.0)};
    costs[3].error = 0.01;
    const auto sum = quality_cost(costs, Quality::normal, 500.0);
    ASSERT_TRUE(sum);
    EXPECT_DOUBLE_EQ(sum->solve_ms, 1200.0);
    EXPECT_DOUBLE_EQ(sum->frame_ms, 7.0);
    EXPECT_EQ(sum->error, 0.01);
    EXPECT_FALSE(quality_cost(costs, Quality::high, 500.0)) << "not timed";
    EXPECT_FALSE(quality_cost(costs, Quality::draft, 500.0)) << "for no known number of pixels";
    EXPECT_FALSE(quality_cost(costs, Quality::normal, 0.0));
}

TEST(MeasuredCosts, OutliveFramesThatChangeNothing) {
    FinishedFrame drawn;
    drawn.number = 1;
    drawn.done_at = std::chrono::steady_clock::time_point(std::chrono::seconds(1));
    drawn.ms_total = 30.0;
    drawn.plan.quality = Quality::normal;
    drawn.plan.passes.resize(3);
    drawn.plan.passes[0].id = {PassKind::shade, "body", ReflectanceModel::ggx};
    drawn.plan.passes[0].ms = 20.0;
    drawn.plan.passes[1].id = PassKind::surface_map;
    drawn.plan.passes[1].ms = 900.0;
    drawn.plan.passes[2].id = PassKind::environment_filter;
    MeasuredCosts measured;
    remember_costs(measured, drawn);
    EXPECT_TRUE(measured.newest_was_drawn);

    FinishedFrame same = drawn;
    same.done_at += std::chrono::seconds(1);  // the same frame once more
    same.ms_total = 0.1;
    for (PlannedPass& pass : same.plan.passes) pass.ms = 0.004;
    remember_costs(measured, same);
    EXPECT_FALSE(measured.newest_was_drawn);
    EXPECT_EQ(measured.total_ms, 30.0);
    show_last_measured(measured, same.plan);
    EXPECT_EQ(same.plan.passes[0].ms, 20.0);
    EXPECT_EQ(same.plan.passes[1].ms, 900.0);
    EXPECT_FALSE(same.plan.passes[2].ms) << "never ran";
    same.plan.quality = Quality::high;
    show_last_measured(measured, same.plan);
    EXPECT_FALSE(same.plan.passes[0].ms) << "not at that quality";
}

TEST(RememberCosts, OfOneFrameAddUpToItsTotal) {
    MeasuredCosts measured;
    FinishedFrame first;
    first.done_at = std::chrono::steady_clock::time_point(std::chrono::seconds(1));
    first.ms_total = 30.0;
    first.plan.quality = Quality::normal;
    first.plan.passes.resize(3);
    first.plan.passes[0].id = {PassKind::shade, "body", ReflectanceModel::ggx};
    first.plan.passes[0].ms = 20.0;
    first.plan.passes[1].id = PassKind::compensation;
    first.plan.passes[1].ms = 8.0;
    first.plan.passes[2].id = PassKind::surface_map;
    first.plan.passes[2].ms = 900.0;
    remember_costs(measured, first);
    // The next paint: little to shade, nothing to correct anew, nothing solved.
    FinishedFrame next = first;
    next.done_at += std::chrono::seconds(1);
    next.ms_total = 6.0;
    next.plan.passes[0].ms = 5.0;
    next.plan.passes[1].ms = 0.01;
    next.plan.passes[2].ms = 0.0;
    remember_costs(measured, next);
    show_last_measured(measured, next.plan);
    const double sum = *next.plan.passes[0].ms + *next.plan.passes[1].ms +
                       time_beside_passes_ms(measured, next.plan);
    EXPECT_DOUBLE_EQ(sum, measured.total_ms);
    EXPECT_DOUBLE_EQ(measured.total_ms, 6.0);
    EXPECT_EQ(next.plan.passes[2].ms, 900.0) << "solved once";
}

TEST(PredictDrawn, ScalesByTheFramesOwnWork) {
    FramePlan plan;
    plan.levels = levels_of(plan.quality);
    plan.quality = Quality::normal;
    plan.passes.resize(4);
    plan.passes[0].id = visibility_pass(0);
    plan.passes[0].work_items = 1e9;  // rays: the bench counts pixels
    plan.passes[1].id = {PassKind::shade, "body", ReflectanceModel::ggx};
    plan.passes[1].work_items = 300.0;
    plan.passes[2].id = PassKind::resolve;
    plan.passes[2].work_items = 500.0;
    plan.passes[3].id = PassKind::environment_filter;
    const std::vector<PassCost> costs{
        cost(PassKind::light_visibility, Quality::normal, 400.0, 1000.0),
        cost(shading(ReflectanceModel::ggx), Quality::normal, 8.0, 600.0),
        cost(PassKind::resolve, Quality::normal, 2.0, 1000.0),
        cost(PassKind::environment_filter, Quality::high, 9.0, 0.0)};
    EXPECT_FALSE(predict_drawn(plan, costs).empty());
    EXPECT_DOUBLE_EQ(*plan.passes[0].predicted_ms, 200.0);
    EXPECT_DOUBLE_EQ(*plan.passes[1].predicted_ms, 4.0);
    EXPECT_DOUBLE_EQ(*plan.passes[2].predicted_ms, 1.0);
    EXPECT_FALSE(plan.passes[3].predicted_ms);
    EXPECT_NE(plan.passes[3].unpredicted_because.find("at normal quality"), std::string::npos);
}

}  // namespace
}  // namespace livery
