#include "ledger/effect_errors.h"

#include <algorithm>
#include <cmath>

#include "core/worst_error.h"

namespace livery {

namespace {

/// With no level missing, of all effects or of one alone.
bool is_whole(const SceneErrors& errors) {
    std::size_t effects = 0;
    for (std::size_t e = 0; e < kEffects; ++e) {
        const auto& levels = errors.at_level[e];
        if (levels.empty()) continue;
        if (levels.size() != effect_table()[e].levels.size()) return false;
        ++effects;
    }
    return is_of_all_effects(errors) || effects == 1;
}

}  // namespace

bool is_of_all_effects(const SceneErrors& errors) {
    // Which every scene calls for
    return !errors.at_level[static_cast<std::size_t>(Effect::sub_samples)].empty();
}

EffectErrors errors_like(EffectErrors errors, const std::array<bool, kEffects>& called_for) {
    constexpr auto kEnvironment = static_cast<std::size_t>(Effect::environment);
    const auto unlike = [&](const SceneErrors& scene) {
        return is_of_all_effects(scene) &&
               scene.at_level[kEnvironment].empty() == called_for[kEnvironment];
    };
    const bool any = std::any_of(errors.begin(), errors.end(), [&](const SceneErrors& scene) {
        return is_of_all_effects(scene) && !unlike(scene);
    });
    if (any) std::erase_if(errors, unlike);
    return errors;
}

bool has_what_is_mirrored(const EffectLevels& levels,
                          const std::array<bool, kEffects>& called_for) {
    const bool sky = called_for[static_cast<std::size_t>(Effect::environment)] &&
                     levels[Effect::environment] > 0;
    const bool parts = called_for[static_cast<std::size_t>(Effect::interreflection)] &&
                       levels[Effect::interreflection] > 0;
    return sky || parts;
}

EffectErrors errors_of(const std::vector<AccuracyRow>& rows) {
    EffectErrors errors;
    for (const AccuracyRow& row : rows) {
        if (!row.called_for) continue;
        const auto info =
            std::find_if(effect_table().begin(), effect_table().end(), [&](const EffectInfo& one) {
                return row.effect == one.name;
            });
        if (info == effect_table().end()) continue;  // a quality's
        auto scene = std::find_if(errors.begin(), errors.end(), [&](const SceneErrors& known) {
            return known.scene == row.scene;
        });
        if (scene == errors.end()) {
            scene = errors.insert(errors.end(), SceneErrors{row.scene, 0.0, {}});
        }
        auto& levels = scene->at_level[static_cast<std::size_t>(info->effect)];
        if (row.index != static_cast<int>(levels.size())) continue;  // one before it is missing
        levels.push_back(row.error.p95);
        // Only glints' own rows are drawn with single flakes, which the truth has not
        const bool whole = levels.size() == info->levels.size();
        if (whole && info->effect != Effect::glints) scene->dearest = row.error.p95;
    }
    std::erase_if(errors, [](const SceneErrors& scene) { return !is_whole(scene); });
    return errors;
}

double error_added(const SceneErrors& errors, Effect effect, int level) {
    const auto& levels = errors.at_level[static_cast<std::size_t>(effect)];
    if (levels.empty()) return 0.0;
    const double at = levels.at(static_cast<std::size_t>(level));
    const double added = at * at - levels.back() * levels.back();
    return effect == Effect::glints ? std::abs(added) : std::max(added, 0.0);
}

std::optional<double> error_of(const EffectErrors& errors,
                               const EffectLevels& levels,
                               const std::array<bool, kEffects>& called_for) {
    std::optional<double> worst;
    const bool environment =
        levels[Effect::environment] > 0 && has_what_is_mirrored(levels, called_for);
    double of_their_own = 0.0;
    for (const EffectInfo& info : effect_table()) {
        if (!called_for[static_cast<std::size_t>(info.effect)]) continue;
        double added = 0.0;
        for (const SceneErrors& scene : errors) {
            if (is_of_all_effects(scene)) continue;
            added = worse_of(added, error_added(scene, info.effect, levels[info.effect]));
        }
        of_their_own += added;
    }
    for (const SceneErrors& scene : errors) {
        if (!is_of_all_effects(scene)) continue;
        double squared = scene.dearest * scene.dearest + of_their_own;
        // Both say how exactly the environment is mirrored: one's loss is the other's
        double mirrored = 0.0;
        for (const EffectInfo& info : effect_table()) {
            if (!called_for[static_cast<std::size_t>(info.effect)]) continue;
            const double added = error_added(scene, info.effect, levels[info.effect]);
            const bool of_mirrors = info.effect == Effect::mirrored_environment ||
                                    info.effect == Effect::reflected_occlusion;
            if (!environment && (of_mirrors || info.effect == Effect::occlusion)) continue;
            if (of_mirrors) {
                mirrored = std::max(mirrored, added);
            } else {
                squared += added;
            }
        }
        worst = worse_of(worst.value_or(0.0), std::sqrt(squared + mirrored));
    }
    return worst;
}

}  // namespace livery
