// Session and stage in, results out: what runs between the window and the threads behind it.
#pragma once

#include "scene/scene.h"
#include "session/document.h"
#include "studio/studio.h"

namespace livery {

enum class ShadingDevice;

/// The contexts of the threads, one share group with the window's: they outlive the threads.
using Contexts = std::vector<std::unique_ptr<Window>>;

/// Starts the threads; the session, the product and the window's context are there, current.
Contexts start_threads(Studio& studio, const Window& window, ShadingDevice shading);
/// In the order in which one needs the other; with the window's context current.
void stop_threads(Studio& studio);

/// While the program opens without a projector: the window's picture is drawn before the mock-up's
/// light is solved, where one processor does both.
bool preview_goes_first(const Studio& studio);

/// A picture for the mock-up was asked for and has not reached the projector, if one shows.
bool is_frame_under_way(const Studio& studio);

/// At the start of each frame of the window: takes over what is new.
void take_results(Studio& studio);
/// Asks for a look of the document as it is, whatever is being tried or compared: its frame's
/// number. Nothing while files that its paints need are being read: ask again. Throws what makes it
/// impossible to draw.
std::optional<std::uint64_t> ask_for_look(Studio& studio, int look);
/// What to draw for a look of the document; shares environments that were read. Throws FileError.
Scene scene_for(Studio& studio, const Document& document, int look);
/// At its end: asks for what the changes call for; without `pictures` for the projector alone.
void ask_for_changes(Studio& studio, bool pictures);

/// Of the stage's picture: how it is turned, and the view that it is drawn from (preview and eye).
Orbit stage_orbit(const Studio& studio);
View stage_view(const Studio& studio, glm::dvec3 eye_mm);

// --- the preview behind what was changed ---

/// Longer than this behind, a picture is marked as such, seconds.
inline constexpr double kTellsLag_s = 0.5;

void note_asked(PreviewLag& lag, std::uint64_t number, StageView view, double now_s);
/// Whether a picture of that number is of the view that is open.
bool is_of_view(const PreviewLag& lag, std::uint64_t shown, StageView open);
/// Since when there is a change that the picture of that number does not show; none: it is the
/// newest.
std::optional<double> behind_since_s(PreviewLag& lag, std::uint64_t shown);

// --- the finer picture while nothing changes: the levels of `high`, solved beside everything else
// and faded in ---

/// The user's setting; without one it does.
bool refines_while_still(const UserSettings& settings);
void set_refines_while_still(UserSettings& settings, bool on);

/// What is on the mock-up was traced.
bool shows_reference(const Studio& studio);

/// Each effect's level of the document or of `high`, whichever is finer; none: the document's are.
std::optional<EffectLevels> refined_levels(const Document& document);

/// A frame of something else is asked for: the finer levels stay for another paint in the same
/// light, which is solved; everything else begins with the document's.
void begin_anew(Studio& studio, const WantedFrame& frame);
/// False when the finer levels are shown and no longer wanted.
bool stands_refined(const Studio& studio);
/// Whether the newest frame, all there and left alone for a while, is to be asked for once more.
bool refinement_is_due(const Studio& studio);

/// When refinement_is_due() may change by itself; 0: not at all.
double next_refinement_s(const Studio& studio);

}  // namespace livery
