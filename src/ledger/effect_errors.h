// How far each level of each effect leaves a picture from the truth: what the last accuracy suite
// measured, scene by scene.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ledger/accuracy/rows.h"
#include "scene/effects.h"

namespace livery {

/// Of one scene of the ledger, CIEDE2000 at the 95th percentile of its pixels. A scene that is for
/// one effect alone has that effect's levels and no others.
struct SceneErrors {
    std::string scene;
    double dearest = 0.0;  ///< every effect at its last level
    /// By effect and level, all others at their last; empty where the scene does not call for it.
    std::array<std::vector<double>, kEffects> at_level;
};
using EffectErrors = std::vector<SceneErrors>;

/// Whether it has the levels of whatever it calls for, and is not for one effect alone.
bool is_of_all_effects(const SceneErrors& errors);

/// Without those of scenes that have an environment where the effects that are called for tell of
/// none, or the other way about; all of them, where no others are known. Scenes for one effect
/// alone remain.
EffectErrors errors_like(EffectErrors errors, const std::array<bool, kEffects>& called_for);
/// Whether a scene at those levels has anything but lamps for mirrors to show.
bool has_what_is_mirrored(const EffectLevels& levels, const std::array<bool, kEffects>& called_for);

/// Of those scenes whose rows are all there.
EffectErrors errors_of(const std::vector<AccuracyRow>& rows);

/// What an effect's level adds to what all effects at their last level leave, squared. Errors of
/// different effects fall on different pixels and directions: they add up as squares. Glints have
/// no truth, since the path tracer draws them as a smooth lobe: what they change counts.
double error_added(const SceneErrors& errors, Effect effect, int level);

/// Of the levels, in the scene of the ledger where it is largest, and on top of it what each effect
/// that has scenes of its own adds most there; effects that `called_for` denies add nothing. None
/// without a scene.
std::optional<double> error_of(const EffectErrors& errors,
                               const EffectLevels& levels,
                               const std::array<bool, kEffects>& called_for);

std::filesystem::path effect_errors_file();  ///< in the user's folder
void write_effect_errors(const std::filesystem::path& file, const EffectErrors& errors);
/// Throws FileError for a malformed text.
EffectErrors parse_effect_errors(const std::string& text, const std::filesystem::path& file);
/// What was measured here, if it tells of as many effects as there are, else what was shipped:
/// errors hardly depend on the machine.
EffectErrors known_effect_errors();

}  // namespace livery
