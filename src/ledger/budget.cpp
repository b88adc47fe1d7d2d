#include "ledger/budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

namespace {

/// Closer than this nobody can tell two errors apart: the cheaper one wins.
constexpr double kAlike = 1.01;

std::size_t index_of(Effect effect) { return static_cast<std::size_t>(effect); }

std::string predict_work(FramePlan& plan, const PriceList& list) {
    count_work(list.scene, counts_at(list.areas, plan.levels, list.costs), plan);
    if (PlannedPass* correction = find_pass(plan, PassKind::compensation)) {
        correction->work_items = list.areas.covered_pixels;
    }
    return predict_times(plan, list.costs);
}

FramePlan predicted_plan(const PriceList& list, const EffectLevels& levels) {
    FramePlan plan = plan_frame(list.scene, levels, list.stage);
    predict_work(plan, list);
    return plan;
}

/// Of one level of an effect: its own passes, at some level of the sub-samples.
struct Times {
    double first_frame_ms = 0.0, swap_ms = 0.0;
    bool known = true;
};

void add(Times& times, const PlannedPass& pass) {
    const double ms = pass.predicted_ms.value_or(0.0);
    times.known = times.known && pass.predicted_ms.has_value();
    times.first_frame_ms += ms;
    if (runs_every_frame(pass.id)) times.swap_ms += ms;
}

/// What every level takes by itself: a frame is the sum of those of its levels and of the rest.
struct TimesByLevel {
    std::array<std::vector<Times>, kEffects> own;
    Times rest;
};

TimesByLevel times_by_level(const PriceList& list, int sub_samples) {
    TimesByLevel times;
    EffectLevels dearest = dearest_levels();
    dearest[Effect::sub_samples] = sub_samples;
    for (const EffectInfo& info : effect_table()) {
        const bool samples = info.effect == Effect::sub_samples;
        for (int level = 0; level < static_cast<int>(info.levels.size()); ++level) {
            Times& own = times.own[index_of(info.effect)].emplace_back();
            if (samples && level != sub_samples) continue;
            EffectLevels levels = dearest;
            levels[info.effect] = level;
            for (const PlannedPass& pass : predicted_plan(list, levels).passes) {
                if (effect_of(pass.id) == info.effect) add(own, pass);
            }
        }
    }
    for (const PlannedPass& pass : predicted_plan(list, dearest).passes) {
        if (!effect_of(pass.id)) add(times.rest, pass);
    }
    return times;
}

bool is_of_environment(Effect effect) {
    return effect == Effect::occlusion || effect == Effect::mirrored_environment ||
           effect == Effect::reflected_occlusion;
}

/// Combinations that say the same as another one, or what the renderer does not have.
bool is_redundant(const EffectLevels& levels) {
    if (levels[Effect::environment] == 0) {
        return levels[Effect::occlusion] > 0 || levels[Effect::mirrored_environment] > 0 ||
               levels[Effect::reflected_occlusion] > 0;
    }
    // What is mirrored through parts has its own few nodes, whatever the level of those with rays
    return (levels[Effect::reflected_occlusion] == 0) !=
           (levels[Effect::mirrored_environment] < kMirrorsWithRays);
}

Times total_of(const TimesByLevel& times,
               const EffectLevels& levels,
               const std::array<bool, kEffects>& called) {
    Times sum = times.rest;
    const bool environment =
        levels[Effect::environment] > 0 && has_what_is_mirrored(levels, called);
    for (const EffectInfo& info : effect_table()) {
        if (!called[index_of(info.effect)]) continue;
        if (!environment && is_of_environment(info.effect)) continue;
        const Times& own =
            times.own[index_of(info.effect)][static_cast<std::size_t>(levels[info.effect])];
        sum.first_frame_ms += own.first_frame_ms;
        sum.swap_ms += own.swap_ms;
        sum.known = sum.known && own.known;
    }
    return sum;
}

/// Every combination of levels of the effects that the scene calls for.
template <typename Visit>
void each_combination(const std::array<bool, kEffects>& called, const Visit& visit) {
    EffectLevels levels = levels_of(Quality::normal);
    const auto from = [&](const auto& self, std::size_t e) -> void {
        if (e == kEffects) {
            if (!is_redundant(levels)) visit(levels);
            return;
        }
        const EffectInfo& info = effect_table()[e];
        const int last = static_cast<int>(info.levels.size()) - 1;
        if (!called[e]) {
            // Whatever it says: nothing runs
            levels.of[e] = is_of_environment(info.effect) ? 0 : levels_of(Quality::normal).of[e];
            return self(self, e + 1);
        }
        for (int level = info.effect == Effect::glints ? last : 0; level <= last; ++level) {
            levels.of[e] = level;
            self(self, e + 1);
        }
    };
    from(from, 0);
}

/// With one effect at another level, and along with it what the renderer has only together: many
/// nodes of mirrors have rays, few have none.
EffectLevels moved(EffectLevels levels, Effect effect, int level) {
    levels[effect] = level;
    int& nodes = levels[Effect::mirrored_environment];
    int& rays = levels[Effect::reflected_occlusion];
    if (effect == Effect::mirrored_environment) rays = level < kMirrorsWithRays ? 0 : 1;
    if (effect == Effect::reflected_occlusion) {
        nodes =
            level == 0 ? std::min(nodes, kMirrorsWithRays - 1) : std::max(nodes, kMirrorsWithRays);
    }
    return levels;
}

LevelPrice price_of(const PriceList& list, const EffectLevels& levels, int level) {
    return {level, time_of(list, levels), error_of(list, levels)};
}

}  // namespace

PriceList make_price_list(const Scene& scene,
                          FrameStage stage,
                          FrameCounts areas,
                          std::vector<PassCost> costs,
                          EffectErrors errors) {
    PriceList list{scene, stage, std::move(areas), std::move(costs), std::move(errors), {}};
    for (const EffectInfo& info : effect_table()) {
        list.called_for[index_of(info.effect)] = calls_for(scene, info.effect);
    }
    // The planner looks at the parts' albedos and shapes too
    const FramePlan plan = plan_frame(scene, dearest_levels(), stage);
    for (const auto& [pass, effect] :
         {std::pair(PassKind::interreflection, Effect::interreflection),
          std::pair(PassKind::mirrored_environment, Effect::mirrored_environment),
          std::pair(PassKind::reflection_occlusion, Effect::reflected_occlusion)}) {
        if (!find_pass(plan, pass)) list.called_for[index_of(effect)] = false;
    }
    list.errors = errors_like(std::move(list.errors), list.called_for);
    return list;
}

PredictedTime time_of(const PriceList& list, const EffectLevels& levels) {
    return predicted_time(predicted_plan(list, levels));
}

double error_of(const PriceList& list, const EffectLevels& levels) {
    return error_of(list.errors, levels, list.called_for).value_or(0.0);
}

std::string predict(FramePlan& plan, const PriceList& list) {
    const std::string note = predict_work(plan, list);
    predict_errors(plan, list.called_for, list.errors);
    return note;
}

PricedFrame priced(const PriceList& list, const EffectLevels& levels) {
    PricedFrame frame;
    frame.levels = levels;
    FramePlan plan = plan_frame(list.scene, levels, list.stage);
    frame.note = predict_work(plan, list);
    frame.time = predicted_time(plan);
    const auto& called = list.called_for;
    frame.error = error_of(list, levels);
    for (const EffectInfo& info : effect_table()) {
        EffectPrice& price = frame.effects.emplace_back();
        price.effect = info.effect;
        price.called_for = called[index_of(info.effect)];
        const int level = levels[info.effect];
        price.chosen = {level, frame.time, frame.error};
        if (!price.called_for) continue;
        for (const PlannedPass& pass : plan.passes) {
            if (effect_of(pass.id) == info.effect) price.own_ms += pass.predicted_ms.value_or(0.0);
        }
        double added = 0.0;
        for (const SceneErrors& errors : list.errors) {
            added = std::max(added, error_added(errors, info.effect, level));
        }
        price.added = std::sqrt(added);
        if (info.effect == Effect::interreflection && level == 0) {
            price.bound = exchange_bound(list.scene).de00;
        }
        if (level + 1 < static_cast<int>(info.levels.size())) {
            price.next = price_of(list, moved(levels, info.effect, level + 1), level + 1);
        }
        if (level > 0) price.off = price_of(list, moved(levels, info.effect, 0), 0);
    }
    return frame;
}

std::vector<EffectLevels> combinations(const PriceList& list) {
    std::vector<EffectLevels> all;
    each_combination(list.called_for, [&](const EffectLevels& levels) { all.push_back(levels); });
    return all;
}

EffectLevels levels_within(const PriceList& list, const Budget& budget) {
    const auto& called = list.called_for;
    std::vector<TimesByLevel> by_samples;
    for (int k = 0; k < static_cast<int>(effect_info(Effect::sub_samples).levels.size()); ++k) {
        by_samples.push_back(times_by_level(list, k));
    }
    struct Candidate {
        EffectLevels levels;
        Times times;
        double error = 0.0;
    };
    std::vector<Candidate> fitting;
    std::optional<Times> cheapest;
    double least = std::numeric_limits<double>::infinity();
    each_combination(called, [&](const EffectLevels& levels) {
        const Times times = total_of(
            by_samples[static_cast<std::size_t>(levels[Effect::sub_samples])], levels, called);
        if (!times.known) return;
        if (!cheapest || times.first_frame_ms < cheapest->first_frame_ms) cheapest = times;
        if (times.first_frame_ms > budget.first_frame_ms.value_or(times.first_frame_ms) ||
            times.swap_ms > budget.swap_ms.value_or(times.swap_ms)) {
            return;
        }
        const double error = error_of(list.errors, levels, called).value_or(0.0);
        least = std::min(least, error);
        fitting.push_back({levels, times, error});
    });
    if (!cheapest) {
        throw Refused("no budget: nobody has timed what this scene calls for",
                      "run livery bench --suite costs, or choose --quality");
    }
    if (fitting.empty()) {
        throw Refused(fmt::format("no levels fit the budget; the cheapest are predicted to take "
                                  "{:.1f} ms for a first frame, {:.1f} ms a paint",
                                  cheapest->first_frame_ms,
                                  cheapest->swap_ms),
                      "allow more time, or lower the resolution");
    }
    std::erase_if(fitting, [&](const Candidate& one) { return one.error > kAlike * least; });
    return std::min_element(fitting.begin(),
                            fitting.end(),
                            [](const Candidate& a, const Candidate& b) {
                                return a.times.first_frame_ms < b.times.first_frame_ms;
                            })
        ->levels;
}

std::string text_of(const PricedFrame& frame) {
    std::string text;
    for (const EffectPrice& price : frame.effects) {
        const EffectInfo& info = effect_info(price.effect);
        const auto name = [&](int level) {
            return info.levels.at(static_cast<std::size_t>(level)).name;
        };
        if (!price.called_for) {
            text += fmt::format("{:<22}{:<14} not called for: costs nothing\n", info.name, "-");
            continue;
        }
        text += fmt::format("{:<22}{:<14}{:9.1f} ms  leaves {:.2f}",
                            info.name,
                            name(price.chosen.level),
                            price.own_ms,
                            price.added);
        if (price.bound)
            text += fmt::format(" ({:.1f} at most, by the parts' albedos)", *price.bound);
        if (price.next) {
            text += fmt::format("; {}: {:+.1f} ms, error {:+.2f}",
                                name(price.next->level),
                                price.next->time.all_ms - price.chosen.time.all_ms,
                                price.next->error - price.chosen.error);
        }
        if (price.off)
            text += fmt::format("; without: error {:+.2f}", price.off->error - frame.error);
        text += "\n";
    }
    return text + fmt::format(
                      "predicted: {:.1f} ms for the first frame, {:.1f} ms a paint, CIEDE2000 "
                      "{:.2f} or less on 95% of the product\n",
                      frame.time.all_ms,
                      frame.time.swap_ms,
                      frame.error);
}

}  // namespace livery
