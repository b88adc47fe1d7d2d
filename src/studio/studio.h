// What the panels of the operator's window share: the session, the threads and their newest
// results, and what the pointer is over. One instance, main thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/ballots.h"
#include "gl/window.h"
#include "projection/projector_screen.h"
#include "session/bench_thread.h"
#include "session/frame_thread.h"
#include "session/preview_thread.h"
#include "session/session.h"

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
    Session session;
    std::shared_ptr<const Product> product;
    std::shared_ptr<const ProjectorSetup> setup;
    std::vector<Monitor> monitors;

    std::unique_ptr<FrameThread> frames;
    std::unique_ptr<PreviewThread> previews;
    std::unique_ptr<BenchThread> bench;
    std::unique_ptr<ProjectorScreen> projector;
    std::unique_ptr<PartPicker> picker;
    std::unique_ptr<BallotStore> ballots;

    // The newest results, taken over at the start of each frame of the window.
    std::shared_ptr<const FinishedFrame> frame;
    std::shared_ptr<const PreviewPicture> preview;
    std::shared_ptr<const BenchPhotograph> photograph;

    // What is shown; saved as the session's workspace.
    int shown_look = 0;
    std::optional<int> compared_look;  ///< B of A/B
    bool showing_b = false;            ///< the key is held
    bool wiping = false;
    double wipe_at = 0.5;
    std::optional<int> selected_part;
    StageView view = StageView::preview;

    /// What the pointer or the arrow keys are on: shown on the mock-up, not in the document. A
    /// panel sets it anew in every frame in which it still holds; Esc takes it back until the
    /// pointer is on something else.
    std::optional<SessionCommand> tried;

    std::vector<Notice> notices;
    float ui_scale = 1.0f;
};

/// Executes, shows the look that it is about, and turns what it throws into a notice.
void commit(Studio& studio, const SessionCommand& command);

/// Shows on the mock-up what committing would show, for this frame of the window.
void try_out(Studio& studio, const SessionCommand& command);

/// The document with what is being tried.
Document shown_document(const Studio& studio);

void notify(Studio& studio, Notice notice);

/// Remembers where the item just drawn is on the screen, under a name that does not depend on the
/// layout ("paint:solid red", "look:2", "undo"): for `--ui-map FILE`, by which tests and other
/// programs drive the window.
void name_last_item(const std::string& name);

// The panels, one file each: called once a frame of the window, each inside its own child region.
void draw_looks_panel(Studio& studio);
void draw_parts_panel(Studio& studio);
void draw_library_panel(Studio& studio);
void draw_paint_panel(Studio& studio);
void draw_lighting_panel(Studio& studio);
void draw_plan_panel(Studio& studio);
void draw_calibration_panel(Studio& studio);
void draw_stage(Studio& studio);  ///< the middle, with its view buttons and the wipe
/// The dialog; `open` is the caller's flag.
void draw_ballot_dialog(Studio& studio, bool& open);

}  // namespace livery
