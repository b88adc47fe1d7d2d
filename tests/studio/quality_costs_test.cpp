// What frames cost, as they were measured.
#include "studio/frame/quality_costs.h"

#include <gtest/gtest.h>

#include "core/paths.h"
#include "studio/panels_fixture.h"

namespace livery {
namespace {

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

using KnownCosts = Panels;

TEST_F(KnownCosts, OnAFreshMachineAreTheShippedOnesUntilFramesScaleThem) {
    Studio studio = make_studio();
    const PassCosts shipped = pass_costs(studio);
    EXPECT_EQ(shipped.origin, CostOrigin::shipped);
    EXPECT_TRUE(studio.panels.of<PlanPanelState>().problem.empty());
    // A frame that took three times as long as the shipped costs say
    FramePlan drawn =
        plan_frame(scene_of(studio.session.document(), studio.shown_look, studio.product),
                   Quality::normal,
                   FrameStage::projector);
    for (PlannedPass& pass : drawn.passes) {
        const PassCost* cost = find_cost(shipped.passes, pass.id, drawn.levels);
        if (!cost) continue;
        pass.work_items = cost->work_items;
        pass.ms = 3.0 * predicted_ms(*cost, pass.work_items);
    }
    scale_costs(studio, drawn);
    const PassCosts& scaled = pass_costs(studio);
    EXPECT_EQ(scaled.origin, CostOrigin::scaled);
    for (std::size_t k = 0; k < shipped.passes.size(); ++k) {
        EXPECT_NEAR(scaled.passes[k].ms, 3.0 * shipped.passes[k].ms, 1e-6 * scaled.passes[k].ms);
    }
    // What a bench measured meanwhile stays, and so does what is no costs file
    const PassCosts measured{{shipped.passes[0]}, CostOrigin::measured, "r", 2};
    write_pass_costs(pass_costs_file(), measured);
    keep_scaled_costs(studio);
    EXPECT_EQ(known_pass_costs().origin, CostOrigin::measured);
    write_text_file(pass_costs_file(), "{");
    keep_scaled_costs(studio);
    EXPECT_EQ(read_text_file(pass_costs_file()), "{");
    std::filesystem::remove(pass_costs_file());
    // The next start, and the command line, have them
    keep_scaled_costs(studio);
    Studio later = make_studio();
    EXPECT_EQ(pass_costs(later).origin, CostOrigin::scaled);
    EXPECT_NEAR(pass_costs(later).passes[0].ms, scaled.passes[0].ms, 1e-6);
}

TEST_F(KnownCosts, MeasuredOnesStayAndAMalformedFileIsSaid) {
    write_pass_costs(pass_costs_file(),
                     {{{PassKind::resolve, 0, 1.0, 0.0, 10.0, {}}}, CostOrigin::measured, "r", 2});
    Studio studio = make_studio();
    FramePlan drawn;
    drawn.levels = levels_of(Quality::normal);
    drawn.passes.resize(1);
    drawn.passes[0].id = PassKind::resolve;
    drawn.passes[0].ms = drawn.passes[0].work_items = 1000.0;
    scale_costs(studio, drawn);
    EXPECT_EQ(pass_costs(studio).origin, CostOrigin::measured);
    EXPECT_EQ(pass_costs(studio).passes.at(0).ms, 1.0);
    keep_scaled_costs(studio);
    EXPECT_EQ(known_pass_costs().origin, CostOrigin::measured);

    write_text_file(pass_costs_file(), "{");
    Studio other = make_studio();
    EXPECT_EQ(pass_costs(other).origin, CostOrigin::shipped);
    EXPECT_NE(other.panels.of<PlanPanelState>().problem.find("bench.json"), std::string::npos);
}

}  // namespace
}  // namespace livery
