// The operator's window as a whole: the studio and everything that only the window itself needs.
// Main thread.
#pragma once

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "gl/handles.h"
#include "gl/window.h"
#include "live/orbit.h"
#include "mesh/mesh.h"
#include "studio/kit/question.h"
#include "studio/product/new_session.h"
#include "studio/studio.h"
#include "studio/window/preview_lag.h"
#include "studio/window/refinement.h"
#include "studio/window/trace.h"

namespace livery {

struct Results;

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

struct Shell {
    explicit Shell(Session session) : studio(std::move(session)) {}

    Studio studio;
    std::shared_ptr<Trace> trace = std::make_shared<Trace>();
    std::shared_ptr<Results> results;  ///< what the threads left for the main one
    Bounds product_bounds;
    std::optional<std::pair<double, double>> mock_up_columns;  ///< of the projector's picture

    // What was asked for.
    std::optional<FrameKey> asked_frame;
    std::optional<PreviewKey> asked_preview;
    PreviewLag preview_lag;
    std::optional<SetupKey> asked_setup;
    std::uint64_t frame_number = 0, preview_number = 0;
    Refinement refinement;
    std::shared_ptr<const FramePictures> photographed;  ///< the newest that the bench was to show
    glm::dvec3 photographed_from_mm{0.0};
    bool draws_in_software = false;
    std::string drawn_with;  ///< the devices, in a sentence or two
    double frame_asked_s = 0.0, preview_waits_until_s = 0.0;
    double opened_s = 0.0;  ///< steady clock
    bool calibrates_after_first_frame = false;
    std::map<std::tuple<std::string, double, double>, std::shared_ptr<const Environment>>
        environments;
    std::chrono::steady_clock::time_point input_at{};  ///< of the newest input in this frame
    bool calibrates_by_itself = false;                 ///< nobody asked for the one under way
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
    std::optional<int> tab_to_open;
    int open_tab = 0;
    int tab_step = 0;  ///< Tab was pressed: 1, with Shift: -1
    bool help_open = false, about_open = false, ballots_open = false;
    bool signal_test_open = false;
    bool capture_open = false, nudge_open = false, seats_open = false;
    std::unique_ptr<NewSession> new_session;      ///< its page; none: closed
    std::unique_ptr<NewSession> closed_page;      ///< its picture may be in this frame's drawing
    std::uint64_t new_sessions = 0;               ///< pages opened so far
    std::optional<Question> question;             ///< stands instead of the page meanwhile
    std::shared_ptr<OpenedSession> next_session;  ///< shared with the thread that opened it
    bool quit = false;
    bool clicked_a_view = false;
    float stage_x = 0.0f, stage_y = 0.0f;  ///< upper left corner of the stage, pixels
    double frame_ms = 0.0;                 ///< the window's own last frame
};

inline constexpr int kTabs = 6;  ///< of the column at the right

Orbit stage_orbit(const Shell& shell);

/// The view that the stage's picture is drawn from (preview and eye).
View stage_view(const Shell& shell, glm::dvec3 eye_mm);

// Drawn once a frame of the window, in app.cpp's order.
void draw_menu_bar(Shell& shell);
void draw_stage(Shell& shell);
void draw_projector_bar(Shell& shell);
void draw_status_line(Shell& shell);
void draw_notices(Shell& shell);
void draw_help(Shell& shell);
void draw_layout(Shell& shell);

}  // namespace livery
