// What the panels of the operator's window share: the session, the threads and their newest
// results, and what the pointer is over. One instance, main thread.
#pragma once

#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/ballots.h"
#include "gl/window.h"
#include "live/bench_thread.h"
#include "live/capture_thread.h"
#include "live/frame_thread.h"
#include "live/preview_thread.h"
#include "projection/projector_screen.h"
#include "session/session.h"
#include "studio/kit/background.h"
#include "studio/kit/file_dialog.h"
#include "studio/panel_states.h"

namespace livery {

/// What the middle of the window shows.
enum class StageView {
    preview,     ///< the product, orbiting
    eye,         ///< from the audience's eye
    projector,   ///< projector input as it goes out
    photograph,  ///< the bench's photograph: what the audience would see
};

/// Something to tell the operator: what happened, why, what to do.
struct Notice {
    enum class Level { info, warning, error };
    Level level = Level::info;
    std::string what, cause, fix;
    double shown_until_s = 0.0;  ///< 0: until dismissed
};

struct Studio {
    explicit Studio(Session opened) : session(std::move(opened)) {}

    Session session;
    std::shared_ptr<const Product> product;
    std::shared_ptr<const ProjectorSetup> setup;
    std::vector<Monitor> monitors;
    std::shared_ptr<DesktopWatch> desktop;  ///< names them, with their warnings; none in tests

    std::unique_ptr<FrameThread> frames;
    std::unique_ptr<PreviewThread> previews;
    std::unique_ptr<BenchThread> bench;
    std::unique_ptr<CaptureThread> capture;
    std::unique_ptr<ProjectorScreen> projector;
    std::unique_ptr<PartPicker> picker;
    std::unique_ptr<BallotStore> ballots;

    // The newest results, taken over at the start of each frame of the window.
    std::shared_ptr<const FinishedFrame> frame;
    std::shared_ptr<const PreviewPicture> preview;
    std::shared_ptr<const BenchPhotograph> photograph;

    // What is shown; saved as the session's workspace.
    int shown_look = 0;
    std::size_t shown_place = 0;       ///< its place in the list
    std::optional<int> compared_look;  ///< B of A/B
    bool chose_compared_look = false;  ///< else: the look shown before
    bool showing_b = false;            ///< the key is held
    bool wiping = false;
    double wipe_at = 0.5;
    std::optional<int> selected_part;
    StageView view = StageView::preview;

    /// What the pointer or the arrow keys went to: shown on the mock-up, not in the document. It is
    /// what try_out() was given in the frame before; Esc, undo and a change of look take it back
    /// until the pointer is on something else.
    std::optional<SessionCommand> tried;
    unsigned tried_item = 0;                   ///< which item gave it
    std::optional<SessionCommand> trying;      ///< given to try_out() in this frame
    unsigned trying_item = 0;                  ///< which item gave it
    float pointer_x = 0.0f, pointer_y = 0.0f;  ///< in the window, when it was last there
    bool pointer_was_there = false;
    std::optional<unsigned> untried_item;   ///< the item whose trial was taken back
    bool untried_item_still_there = false;  ///< in this frame
    bool gave_up = false;                   ///< Esc was pressed: no drag commits in this frame
    std::optional<int> hovered_part;        ///< in a list: shows in the preview
    std::optional<int> glowing_part;        ///< clicked: glows on the mock-up
    double glowing_until_s = 0.0;
    std::optional<int> renaming_look;  ///< its name is being typed
    double now_s = 0.0;                ///< steady clock, at the start of this frame of the window

    /// Until the mock-up has its first picture, but not for long: what can wait waits for that.
    bool opening = true;

    std::vector<Notice> notices;
    float ui_scale = 1.0f;
    std::unique_ptr<Background> background;
    UserSettings settings;
    std::unique_ptr<FileDialog> file_dialog;  ///< keeps its folders in `settings`
    PanelStates panels;
};

/// Executes, shows the look that it is about, and turns what it throws into a notice.
void commit(Studio& studio, const SessionCommand& command);

/// Shows on the mock-up what committing would show, for this frame of the window. To be called
/// right after the item that the pointer or the keyboard is on. Begins only when the pointer really
/// moved there or an arrow key led there (`by_arrow`, for items that follow the arrows by
/// themselves): focus that comes back, a list that opens or scrolls under a resting pointer and a
/// tab that is opened again try nothing.
void try_out(Studio& studio, const SessionCommand& command, bool by_arrow = false);

/// The same for what the person is doing right now, such as dragging: there is no doubt.
void try_held(Studio& studio, const SessionCommand& command);

/// For the slider, drag or colour field just drawn: tries `command` out while it is held and
/// commits once when it is let go; Esc while it is held gives it up.
void edit_with_last_item(Studio& studio, const SessionCommand& command);

/// Takes back what is being tried until the pointer is on something else.
void stop_trying(Studio& studio);

/// Shows a look of the document; the one shown before becomes B of A/B unless B was chosen.
void show_look(Studio& studio, int look);

/// After anything that may have deleted looks: shows a neighbour of one that is gone.
void keep_shown_looks_valid(Studio& studio);

/// Around everything that may try something out, once a frame of the window.
void begin_trials(Studio& studio);
void end_trials(Studio& studio);

constexpr double kGlow_s = 0.8;  ///< how long a part that was clicked is seen on the mock-up

/// Selects a part and lets it glow on the mock-up for a moment.
void select_part(Studio& studio, int part);

/// The document with what is being tried.
Document shown_document(const Studio& studio);

void notify(Studio& studio, Notice notice);
/// `what` did not come about, and why; nothing for Cancelled.
void notify_failure(Studio& studio, const std::string& what, const std::exception_ptr& why);

/// Remembers where the item just drawn is on the screen, under a name that does not depend on the
/// layout ("paint:solid red", "look:2", "undo"): for `--ui-map FILE`, by which tests and other
/// programs drive the window.
void name_last_item(const std::string& name);

// The panels, one file each: called once a frame of the window, each inside its own child region.
void draw_looks_panel(Studio& studio);
void draw_parts_panel(Studio& studio);
void draw_library_panel(Studio& studio);
void draw_paint_panel(Studio& studio);
void draw_artwork_panel(Studio& studio);
void draw_lighting_panel(Studio& studio);
void draw_plan_panel(Studio& studio);
void draw_calibration_panel(Studio& studio);
/// Instead of the tabs; `open` is the caller's flag.
void draw_ballot_panel(Studio& studio, bool& open);
/// How many letters, from A, are designs' now; 0 when nobody votes in that panel.
std::size_t ballot_letters(const Studio& studio);

}  // namespace livery
