#include "ledger/machine_speed.h"

#include <algorithm>

#include "core/statistics.h"

namespace livery {

namespace {

constexpr std::size_t kKept = 31;
/// Of work by the shipped costs, before a factor is told from it.
constexpr double kEnough_ms = 20.0;

struct GroupTime {
    double shipped_ms = 0.0, here_ms = 0.0;
    bool enough() const { return shipped_ms >= kEnough_ms; }
    double factor() const { return here_ms / shipped_ms; }
};

/// Another paint solves a part of a pass again: what took less than half as long as it ever did is
/// not the whole of it.
double typical(const std::vector<double>& ratios) {
    const double largest = *std::max_element(ratios.begin(), ratios.end());
    std::vector<double> whole;
    std::copy_if(ratios.begin(), ratios.end(), std::back_inserter(whole), [&](double ratio) {
        return ratio >= 0.5 * largest;
    });
    return median(whole);
}

}  // namespace

void add_ratios(PassRatios& known, const FramePlan& drawn, const std::vector<PassCost>& shipped) {
    for (const PlannedPass& pass : drawn.passes) {
        if (!pass.ms || *pass.ms < kNothingToDo_ms || !(pass.work_items > 0.0)) continue;
        const PassCost* cost = find_cost(shipped, pass.id, drawn.levels);
        if (!cost) continue;
        const double shipped_ms = predicted_ms(*cost, pass.work_items);
        if (!(shipped_ms > 0.0)) continue;
        auto& of_pass = known.passes[{cost->pass, cost->level}];
        of_pass.shipped_ms = shipped_ms;
        if (of_pass.ratios.size() == kKept) of_pass.ratios.erase(of_pass.ratios.begin());
        of_pass.ratios.push_back(*pass.ms / shipped_ms);
    }
}

std::optional<PassCosts> scaled_costs(PassCosts shipped, const PassRatios& ratios) {
    GroupTime once, every_frame;
    for (const auto& [key, of_pass] : ratios.passes) {
        GroupTime& sums = runs_every_frame(key.first) ? every_frame : once;
        sums.shipped_ms += of_pass.shipped_ms;
        sums.here_ms += of_pass.shipped_ms * typical(of_pass.ratios);
    }
    if (!once.enough() && !every_frame.enough()) return std::nullopt;
    const GroupTime& known = once.enough() ? once : every_frame;
    for (PassCost& cost : shipped.passes) {
        const GroupTime& sums = runs_every_frame(cost.pass) ? every_frame : once;
        const double factor = (sums.enough() ? sums : known).factor();
        cost.ms *= factor;
        cost.fixed_ms *= factor;
    }
    shipped.origin = CostOrigin::scaled;
    return shipped;
}

}  // namespace livery
