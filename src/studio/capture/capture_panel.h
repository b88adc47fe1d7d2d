// Photographing with a camera, in the window: the column with what is asked for, and the stage with
// what is seen.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gl/handles.h"
#include "live/capture_thread.h"
#include "scene/data_sheet.h"

namespace livery {

struct Studio;

struct CapturePanelState {
    bool open = false;
    std::vector<ListedCamera> cameras;
    std::string problem;  ///< why they could not be listed
    double listed_at_s = -1.0;
    std::optional<CameraChoice> chosen;
    std::string address;          ///< of a camera on the network, being typed
    std::string address_problem;  ///< why it is none
    /// How the projector's place comes to be known.
    enum class Place { found, kept, told };
    std::optional<Place> place;           ///< chosen by hand; none: by what is known
    DataSheets sheets;                    ///< of projector and camera, as typed
    bool sheets_read = false;             ///< from the user's settings
    int colour_shots = 2;                 ///< photographs of each colour picture; of 4: fringes too
    std::optional<std::size_t> selected;  ///< a tile
    bool was_busy = false;
    std::filesystem::path accepted;  ///< the finished calibration that was put to use
    std::filesystem::path before;    ///< what was in use before it
    std::map<std::shared_ptr<const Image8>, Texture2D> textures;  ///< of what is on the window
    CaptureView view;  ///< as of this frame of the window
};

/// Takes over what the capture's thread has: its pictures off the projector when it is done. Once a
/// frame of the window.
void take_capture(Studio& studio);
/// Instead of the tabs while it is open.
void draw_capture_panel(Studio& studio);
/// Instead of the stage; false: it is not open.
bool draw_capture_stage(Studio& studio);
/// The steps: what each found, and the button to the next.
void draw_capture_steps(Studio& studio, bool can_show);
/// What the camera is opened for, by what the column says.
CaptureSetup capture_setup(const Studio& studio, const CameraChoice& choice);
/// "look", "geometry", "colour", "check": what is called for and not done; empty: nothing is.
std::string next_capture_step(const CaptureView& view);
/// All of them, by those names.
std::vector<std::pair<std::string, const CaptureStepView*>> named_capture_steps(
    const CaptureView& view);
/// Whether the capture's thread works for the calibration.
bool is_busy(const CaptureView& view);
/// Opens or closes both; the camera is let go with them.
void show_capture(Studio& studio, bool shown);

}  // namespace livery
