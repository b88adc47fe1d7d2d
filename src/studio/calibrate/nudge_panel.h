// The mock-up moved by hand until its lines, as the projector draws them, lie on it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "projection/projector_screen.h"
#include "scene/mockup_pose.h"

namespace livery {

struct KeyChord;
struct ProjectorSetup;
struct Studio;

struct NudgePanelState {
    bool open = false;
    /// The calibration that is being moved: its views are kept while it is in use, also while the
    /// panel is closed.
    std::shared_ptr<const ProjectorSetup> setup;
    View view;                          ///< of the projector, as moved so far
    std::vector<View> undo, redo;       ///< newest last
    double step_px = 1.0;               ///< of a button or a key
    bool drawing = false;               ///< lines are on their way
    std::shared_ptr<const View> drawn;  ///< what the newest lines were drawn from
    std::shared_ptr<const Image8> lines;
    std::shared_ptr<const ProjectorPicture> picture;  ///< the lines as a texture
    std::shared_ptr<const Image8> photographed;       ///< the newest that the bench was to show
    bool keeping = false;
};

/// Opens or closes the panel; while it is open the projector shows the lines. Says in a notice why
/// it does not open.
void show_nudge(Studio& studio, bool shown);
/// Takes over what was drawn and asks for what is to be drawn. Once a frame of the window, with its
/// context current.
void take_nudge(Studio& studio);
/// Instead of the tabs while it is open.
void draw_nudge_panel(Studio& studio);
/// What a key means while the panel is open; true when it meant something.
bool nudge_key(Studio& studio, const KeyChord& chord);
/// By how much the mock-up was moved so far.
MockupMotion nudged_so_far(const Studio& studio);

}  // namespace livery
