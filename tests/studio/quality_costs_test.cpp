// What frames cost, as they were measured.
#include "studio/quality_costs.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace livery
