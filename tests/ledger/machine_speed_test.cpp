#include "ledger/machine_speed.h"

#include <gtest/gtest.h>

namespace livery {
namespace {

const int kSoft = levels_of(Quality::normal)[Effect::shadows];

/// A pass that is solved once and one of every frame, 100 ms and 40 ms for 10 items.
PassCosts some_costs() {
    return {{{PassKind::light_visibility, kSoft, 100.0, 20.0, 10.0, {}},
             {PassKind::resolve, 0, 40.0, 0.0, 10.0, {}}},
            CostOrigin::shipped,
            "another",
            2};
}

FramePlan drawn(std::optional<double> visibility_ms, std::optional<double> resolve_ms) {
    FramePlan plan;
    plan.levels = levels_of(Quality::normal);
    plan.passes.resize(2);
    plan.passes[0].id = visibility_pass(1);
    plan.passes[1].id = PassKind::resolve;
    plan.passes[0].ms = visibility_ms;
    plan.passes[1].ms = resolve_ms;
    for (PlannedPass& pass : plan.passes) pass.work_items = 10.0;
    return plan;
}

TEST(MachineSpeed, ScalesWhatIsSolvedOnceAndWhatEveryFrameRunsApart) {
    PassRatios ratios;
    const PassCosts shipped = some_costs();
    add_ratios(ratios, drawn(300.0, 20.0), shipped.passes);
    const auto scaled = scaled_costs(shipped, ratios);
    ASSERT_TRUE(scaled);
    EXPECT_EQ(scaled->origin, CostOrigin::scaled);
    EXPECT_DOUBLE_EQ(scaled->passes[0].ms, 300.0);
    EXPECT_DOUBLE_EQ(scaled->passes[0].fixed_ms, 60.0);
    EXPECT_DOUBLE_EQ(scaled->passes[1].ms, 20.0);
}

TEST(MachineSpeed, IsThatOfTheOtherPassesWhereSomeDidNotRun) {
    PassRatios ratios;
    const PassCosts shipped = some_costs();
    add_ratios(ratios, drawn(std::nullopt, 80.0), shipped.passes);
    const auto scaled = scaled_costs(shipped, ratios);
    ASSERT_TRUE(scaled);
    EXPECT_DOUBLE_EQ(scaled->passes[0].ms, 200.0);
    EXPECT_DOUBLE_EQ(scaled->passes[1].ms, 80.0);
}

TEST(MachineSpeed, IsNotToldFromPartsOfAPassNorFromOneDisturbance) {
    PassRatios ratios;
    const PassCosts shipped = some_costs();
    // Another paint solves a little again, the fourth frame was disturbed
    for (const double ms : {110.0, 5.0, 108.0, 190.0, 8.0, 2.0, 111.0, 0.01, 6.0}) {
        add_ratios(ratios, drawn(ms, 40.0), shipped.passes);
    }
    const auto scaled = scaled_costs(shipped, ratios);
    ASSERT_TRUE(scaled);
    EXPECT_NEAR(scaled->passes[0].ms, 110.0, 2.0);
    EXPECT_DOUBLE_EQ(scaled->passes[1].ms, 40.0);
}

TEST(MachineSpeed, IsNotToldFromNextToNothing) {
    PassRatios ratios;
    const PassCosts shipped = some_costs();
    EXPECT_FALSE(scaled_costs(shipped, ratios));
    FramePlan plan = drawn(1.0, 1.0);
    for (PlannedPass& pass : plan.passes) pass.work_items = 0.0;
    add_ratios(ratios, plan, shipped.passes);
    EXPECT_FALSE(scaled_costs(shipped, ratios));
    plan = drawn(std::nullopt, 1.0);
    plan.passes[1].work_items = 2.0;  // 8 ms of work
    add_ratios(ratios, plan, shipped.passes);
    EXPECT_FALSE(scaled_costs(shipped, ratios));
}

}  // namespace
}  // namespace livery
