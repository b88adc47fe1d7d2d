// While nobody changes anything the mock-up's picture gets better: the levels of `high`, solved
// beside everything else and faded in.
#pragma once

#include <optional>

#include "live/frame_thread.h"
#include "live/solve_key.h"
#include "session/document.h"
#include "studio/kit/user_settings.h"

namespace livery {

struct Shell;

/// What is remembered of the frames that were asked for.
struct Refinement {
    bool on = false;                 ///< the newest was asked for at the finer levels
    double still_since_s = 0.0;      ///< since when nothing else was asked for
    std::optional<SolveKeys> light;  ///< of the newest, as the document has its levels
};

/// The user's setting; without one it does.
bool refines_while_still(const UserSettings& settings);
void set_refines_while_still(UserSettings& settings, bool on);

/// Each effect's level of the document or of `high`, whichever is finer; none: the document's are.
std::optional<EffectLevels> refined_levels(const Document& document);

/// A frame of something else is asked for: the finer levels stay for another paint in the same
/// light, which is solved; everything else begins with the document's.
void begin_anew(Shell& shell, const FrameDescription& described);
/// False when the finer levels are shown and no longer wanted.
bool stands_refined(const Shell& shell);
/// Whether the newest frame, all there and left alone for a while, is to be asked for once more.
bool refinement_is_due(const Shell& shell);

/// When refinement_is_due() may change by itself; 0: not at all.
double next_refinement_s(const Shell& shell);

}  // namespace livery
