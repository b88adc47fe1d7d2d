// What the panels of the operator's window share: the session, the threads and their newest
// results, what the pointer is over, and the controls that they are drawn with. One instance, main
// thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "evaluation/ballots.h"
#include "gl/handles.h"
#include "gl/window.h"
#include "live/bench_thread.h"
#include "live/capture_thread.h"
#include "live/frame_description.h"
#include "live/frame_thread.h"
#include "live/orbit.h"
#include "live/preview_thread.h"
#include "mesh/mesh.h"
#include "projection/projector_screen.h"
#include "session/session.h"
#include "studio/kit/background.h"
#include "studio/kit/file_dialog.h"
#include "studio/kit/widgets.h"
#include "studio/panel.h"
#include "studio/projector.h"

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

struct OpenedSession;

/// How a picture lies on the stage when it is not drawn for it.
struct PictureZoom {
    double factor = 1.0;      ///< 1: fitted
    double x = 0.5, y = 0.5;  ///< the picture's point in the middle of the stage, 0 to 1
};

struct StageState {
    std::optional<Orbit> orbit;  ///< none: the product from its front quarter
    double eye_zoom = 1.0;
    PictureZoom projector, photograph;
    int width = 0, height = 0;  ///< of the picture, pixels; 0: not drawn yet
    bool dragged = false;
    bool dragging_wipe = false, wipe_lit = false;
    Texture2D photograph_texture;
    std::shared_ptr<const BenchPhotograph> photograph_in_texture;
};

/// What the mock-up shows now, as far as it makes a difference: a new frame is asked for when it
/// changes.
struct FrameKey {
    std::uint64_t revision = 0;
    std::string tried;
    int look = 0;
    std::optional<int> wipe_to;
    double wipe_at = 0.5;
    std::optional<int> glowing_part;
    std::shared_ptr<const ProjectorSetup> setup;
    bool operator==(const FrameKey&) const = default;
};

struct PreviewKey {
    std::uint64_t revision = 0;
    std::string tried;
    int look = 0;
    StageView view = StageView::preview;
    std::array<double, 7> camera{};  ///< of the orbit, and the eye's zoom
    int width = 0, height = 0;
    std::optional<int> highlighted_part;
    std::optional<int> wipe_to;
    double wipe_at = 0.5;
    bool operator==(const PreviewKey&) const = default;
};

struct SetupKey {
    std::string calibration, bench;
    double design_white_percentile = 0.0;
    GamutMapping gamut_mapping = GamutMapping::strict;
    bool operator==(const SetupKey&) const = default;
};

/// A rectangle of the window, in its pixels.
struct StageFrame {
    float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;
};

/// What a click on a paint paints.
enum class PaintTarget { part, rest, product };

/// Whether the preview's newest picture is of the view that is open, and how long it has been
/// behind what was changed.
struct PreviewLag {
    struct Asked {
        std::uint64_t number = 0;
        double at_s = 0.0;
    };
    std::deque<Asked> asked;           ///< not seen to be answered
    std::optional<StageView> view;     ///< of the last that was asked for
    std::uint64_t first_of_view = 0;   ///< earlier pictures are of another view
    std::optional<double> held_since;  ///< seconds: a change has not even been asked for
};

/// While nobody changes anything the mock-up's picture gets better; what is remembered of the
/// frames that were asked for.
struct Refinement {
    bool on = false;                 ///< the newest was asked for at the finer levels
    double still_since_s = 0.0;      ///< since when nothing else was asked for
    std::optional<SolveKeys> light;  ///< of the newest, as the document has its levels
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
    PaintTarget paint_target = PaintTarget::part;
    int arrows_taken_in_frame = -1;  ///< of Dear ImGui: the arrow keys were among swatches then
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

    std::shared_ptr<Trace> trace = std::make_shared<Trace>();
    std::shared_ptr<Results> results;  ///< what the threads left for the main one
    Bounds product_bounds;
    std::optional<std::pair<double, double>> mock_up_columns;  ///< of the projector's picture

    // What was asked for.
    std::optional<FrameKey> asked_frame;
    std::optional<PreviewKey> asked_preview;
    PreviewLag preview_lag;
    std::optional<SetupKey> asked_setup;
    /// The session's revision and the trial that it was read off.
    std::pair<std::uint64_t, std::string> asked_setup_of;
    std::uint64_t frame_number = 0, preview_number = 0;
    Refinement refinement;
    std::shared_ptr<const FramePictures> photographed;  ///< the newest that the bench was to show
    glm::dvec3 photographed_from_mm{0.0};

    bool draws_in_software = false;
    std::string drawn_with;  ///< the devices, in a sentence or two
    double frame_asked_s = 0.0, preview_waits_until_s = 0.0;
    double opened_s = 0.0;  ///< steady clock
    std::map<std::tuple<std::string, double, double>, std::shared_ptr<const Environment>>
        environments;
    std::chrono::steady_clock::time_point input_at{};  ///< of the newest input in this frame
    std::uint64_t problem_number = 0;                  ///< of the frame whose problem was told
    std::string not_drawn;  ///< why there is no frame of what should be shown; else empty
    std::map<int, std::vector<std::string>> told_problems;  ///< of what looks need, by look

    // The projector.
    std::string projector_monitor;     ///< chosen; empty: none
    bool projector_was_there = false;  ///< that one, since the start
    std::vector<SignalWarning> signal_warnings;
    std::unique_ptr<MonitorNumbers> monitor_numbers;
    double monitor_numbers_until_s = 0.0;
    bool only_screen_is_projector = false;  ///< the chosen one, which therefore stays dark
    bool black = false, frozen = false;
    bool signal_test_open = false;
    ShownInstead instead;
    std::string other_product;  ///< why the correction is another product's; empty: it is not

    // The window.
    Window* window = nullptr;       ///< none in tests
    bool window_must_move = false;  ///< it may lie on the projector
    StageState stage;
    float left_width_em = 15.5f, right_width_em = 26.5f;
    std::string layout_seen;         ///< as text; remembered when it rests
    double layout_rests_at_s = 0.0;  ///< 0: it is remembered
    double save_again_at_s = 0.0;    ///< 0: everything is saved, or there is no file
    double user_scale = 1.0;
    std::string last_action;  ///< id of the last one that ran
    int actions_run = 0;
    std::optional<double> fixed_scale;  ///< --ui-scale
    std::string tab_to_open;            ///< a panel's name; empty: the one that is open
    std::string open_tab;
    int tab_step = 0;                             ///< Tab was pressed: 1, with Shift: -1
    std::optional<Question> question;             ///< stands before all but the file dialog
    std::shared_ptr<OpenedSession> next_session;  ///< shared with the thread that opened it
    bool quit = false;
    bool clicked_a_view = false;
    float stage_x = 0.0f, stage_y = 0.0f;  ///< upper left corner of the stage, pixels
    double frame_ms = 0.0;                 ///< the window's own last frame
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

/// Nothing may be edited now, and why (Panel::locks_editing); refuse_editing() tells so.
std::optional<Notice> editing_lock(const Studio& studio);
bool is_editing_locked(const Studio& studio);
bool refuse_editing(Studio& studio);

/// Around everything that may try something out, once a frame of the window.
void begin_trials(Studio& studio);
void end_trials(Studio& studio);

constexpr double kGlow_s = 0.8;  ///< how long a part that was clicked is seen on the mock-up

/// Selects a part and lets it glow on the mock-up for a moment.
void select_part(Studio& studio, int part);

/// The document with what is being tried.
Document shown_document(const Studio& studio);

void notify(Studio& studio, Notice notice);
void tell_info(Studio& studio,
               std::string what,
               std::string cause = "",
               std::string fix = "",
               double until_s = 0.0);
void tell_warning(Studio& studio,
                  std::string what,
                  std::string cause = "",
                  std::string fix = "",
                  double until_s = 0.0);
void tell_error(Studio& studio, std::string what, std::string cause = "", std::string fix = "");
/// What an exception says.
std::string in_words(const std::exception_ptr& why);
/// `what` did not come about, and why; nothing for Cancelled.
void notify_failure(Studio& studio, const std::string& what, const std::exception_ptr& why);
/// Work on the background thread; a notice says `what_failed` when it does.
void in_background(Studio& studio, std::string what_failed, Background::Work work);

}  // namespace livery
