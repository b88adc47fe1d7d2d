// The mock-up moved by hand until its lines, as the projector draws them, lie on it.
#include <cfloat>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "core/log.h"
#include "live/projector_setup.h"
#include "projection/projector_screen.h"
#include "scene/mockup_mask.h"
#include "scene/mockup_pose.h"
#include "studio/studio.h"

namespace livery {

namespace {

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

constexpr std::array<double, 3> kSteps_px{0.1, 1.0, 10.0};
constexpr double kCoarseMove = 10.0;  // with Shift

/// A direction: what a button says and which keys mean it.
struct Way {
    const char *item, *label, *meaning;
    double Nudge::*part;
    double sign;
    int key;
    bool ctrl;
};
constexpr std::array<Way, 12> kMoves{{
    {"left", "←", "To the left", &Nudge::right_px, -1.0, GLFW_KEY_LEFT, false},
    {"right", "→", "To the right", &Nudge::right_px, 1.0, GLFW_KEY_RIGHT, false},
    {"up", "↑", "Up", &Nudge::down_px, -1.0, GLFW_KEY_UP, false},
    {"down", "↓", "Down", &Nudge::down_px, 1.0, GLFW_KEY_DOWN, false},
    {"nearer", "+", "Nearer to the projector", &Nudge::nearer_px, 1.0, GLFW_KEY_PAGE_UP, false},
    {"farther", "−", "Away from the projector", &Nudge::nearer_px, -1.0, GLFW_KEY_PAGE_DOWN, false},
    {"turn-left", "←", "Its front to the left", &Nudge::yaw_px, -1.0, GLFW_KEY_LEFT, true},
    {"turn-right", "→", "Its front to the right", &Nudge::yaw_px, 1.0, GLFW_KEY_RIGHT, true},
    {"turn-up", "↑", "Its front up", &Nudge::pitch_px, -1.0, GLFW_KEY_UP, true},
    {"turn-down", "↓", "Its front down", &Nudge::pitch_px, 1.0, GLFW_KEY_DOWN, true},
    {"roll-right", "+", "Clockwise", &Nudge::roll_px, 1.0, GLFW_KEY_PAGE_UP, true},
    {"roll-left", "−", "Counter-clockwise", &Nudge::roll_px, -1.0, GLFW_KEY_PAGE_DOWN, true},
}};

NudgePanelState& nudge_of(Studio& studio) { return studio.panels.of<NudgePanelState>(); }

/// Loaded anew, for another design white say, it is still the one that is being moved.
bool is_of(const NudgePanelState& state, const ProjectorSetup& setup) {
    return state.setup && state.setup->calibration && setup.calibration &&
           state.setup->calibration->id == setup.calibration->id && state.setup->view == setup.view;
}

bool is_moved(const NudgePanelState& state) {
    return state.setup && state.view != state.setup->view;
}

void move(Studio& studio, const Way& way, double step_px) {
    NudgePanelState& state = nudge_of(studio);
    Nudge by;
    by.*way.part = way.sign * step_px;
    try {
        View to = nudged(state.view, studio.product_bounds, by);
        state.undo.push_back(std::exchange(state.view, to));
        state.redo.clear();
    } catch (const std::invalid_argument&) {
        tell_warning(studio,
                     "The mock-up would leave the projector's picture.",
                     "",
                     "Start over, or calibrate anew where it stands now.",
                     studio.now_s + 10.0);
    }
}

void step_back(std::vector<View>& from, std::vector<View>& to, View& view) {
    if (from.empty()) return;
    to.push_back(std::exchange(view, from.back()));
    from.pop_back();
}

void start_over(NudgePanelState& state) {
    if (!is_moved(state)) return;
    state.undo.push_back(std::exchange(state.view, state.setup->view));
    state.redo.clear();
}

/// As a calibration of its own, which is put to use.
void keep(Studio& studio) {
    NudgePanelState& state = nudge_of(studio);
    if (!is_moved(state) || state.keeping) return;
    state.keeping = true;
    studio.background->run(
        [&studio,
         from = std::filesystem::path(studio.session.document().calibration),
         view = state.view,
         product = studio.product](const Progress&) -> Background::Then {
            const auto folder = keep_nudged(from, view, product->mesh);
            return [&studio, folder] {
                nudge_of(studio).keeping = false;
                show_nudge(studio, false);
                commit(studio, SetCalibration{folder.string()});
                tell_info(studio,
                          "The moved mock-up is kept as a calibration of its own.",
                          "",
                          "Undo, or Calibrate > Go back to, returns to the one before.",
                          studio.now_s + 15.0);
            };
        },
        [&studio](const std::exception_ptr& why) {
            nudge_of(studio).keeping = false;
            notify_failure(studio, "The moved mock-up could not be kept.", why);
        });
}

void draw_way(Studio& studio, const Way& way, float width) {
    NudgePanelState& state = nudge_of(studio);
    if (ImGui::Button(fmt::format("{}##{}", way.label, way.item).c_str(), {width, 0.0f}))
        move(studio, way, state.step_px);
    name_last_item(fmt::format("nudge:{}", way.item));
    const KeyChord chord{way.key, way.ctrl, false};
    tooltip(fmt::format("{} by {:g} pixels ({}; with Shift ten times that)",
                        way.meaning,
                        state.step_px,
                        text_of(chord)));
}

/// Four arrows in a cross, plus and minus beside them, from `first` on.
void draw_cross(Studio& studio, std::size_t first, const char* title, const char* beside) {
    const float width = em(2.6f), gap = ImGui::GetStyle().ItemSpacing.x;
    const auto at = [&](std::size_t k) -> const Way& { return kMoves[first + k]; };
    heading(title);
    const float left = ImGui::GetCursorPosX();
    const auto column = [&](int k) {
        ImGui::SetCursorPosX(left + static_cast<float>(k) * (width + gap));
    };
    column(1);
    draw_way(studio, at(2), width);
    ImGui::SameLine();
    column(4);
    draw_way(studio, at(4), width);
    ImGui::SameLine();
    dim_text(beside);
    draw_way(studio, at(0), width);
    ImGui::SameLine();
    column(2);
    draw_way(studio, at(1), width);
    ImGui::SameLine();
    column(4);
    draw_way(studio, at(5), width);
    column(1);
    draw_way(studio, at(3), width);
}

void draw_history(NudgePanelState& state) {
    const float third = std::floor(
        (ImGui::GetContentRegionAvail().x - 2.0f * ImGui::GetStyle().ItemSpacing.x) / 3.0f);
    const auto step = [&](const char* label, const char* item, bool on, auto&& press) {
        begin_disabled(!on);
        if (button(label, item, "", third)) press();
        end_disabled();
    };
    step("Undo", "nudge:undo", !state.undo.empty(), [&] {
        step_back(state.undo, state.redo, state.view);
    });
    ImGui::SameLine();
    step("Redo", "nudge:redo", !state.redo.empty(), [&] {
        step_back(state.redo, state.undo, state.view);
    });
    ImGui::SameLine();
    step("Start over", "nudge:start-over", is_moved(state), [&] { start_over(state); });
}

void show_lines(Studio& studio) {
    show_instead(studio,
                 {nudge_of(studio).picture,
                  "The mock-up's lines, as the projector draws them",
                  {"showing the mock-up's lines", ProjectorWords::Mood::warning, "Esc ends it."}});
}

/// On the simulated bench, when somebody looks at that.
void photograph_lines(Studio& studio) {
    NudgePanelState& state = nudge_of(studio);
    if (studio.view != StageView::photograph || !studio.frame || !state.lines ||
        state.photographed == state.lines) {
        return;
    }
    state.photographed = state.lines;
    studio.bench->photograph(studio.frame->number,
                             state.lines,
                             eye_in_use_mm(shown_document(studio)),
                             studio.setup->design_white_y);
}

/// By how much the mock-up was moved so far.
MockupMotion nudged_so_far(const Studio& studio) {
    const NudgePanelState& state = studio.panels.of<NudgePanelState>();
    if (!state.setup) return {};
    return motion_between(state.setup->view, state.view, studio.product_bounds);
}

void show_nudge(Studio& studio, bool shown) {
    NudgePanelState& state = nudge_of(studio);
    if (shown == state.open) return;
    if (!shown) {
        state.open = false;
        show_instead(studio, {});
        studio.photographed.reset();
        state.photographed.reset();
        return;
    }
    if (!studio.setup || !studio.setup->calibration ||
        studio.session.document().calibration.empty()) {
        tell_warning(studio,
                     "There is no calibration whose mock-up could be moved.",
                     "Its pose is found by photographs first; by hand it is only corrected.",
                     "Calibrate first.",
                     studio.now_s + 15.0);
        return;
    }
    stop_trying(studio);
    if (studio.signal_test_open) show_signal_test(studio, false);
    if (!is_of(state, *studio.setup)) {
        const double step_px = state.step_px;
        state = {};
        state.step_px = step_px;
        state.view = studio.setup->view;
    }
    state.setup = studio.setup;
    state.open = true;
    studio.view = StageView::projector;
    show_lines(studio);
}

/// Takes over what was drawn and asks for what is to be drawn.
void take_nudge(Studio& studio) {
    NudgePanelState& state = nudge_of(studio);
    if (!state.open) return;
    if (!studio.setup || !is_of(state, *studio.setup)) return show_nudge(studio, false);
    photograph_lines(studio);
    if (state.drawing || (state.drawn && *state.drawn == state.view)) return;
    state.drawing = true;
    studio.background->run(
        [&studio, view = std::make_shared<const View>(state.view), product = studio.product](
            const Progress&) -> Background::Then {
            const auto lines =
                std::make_shared<const Image8>(wireframe_picture(product->mesh, *view));
            return [&studio, view, lines] {
                NudgePanelState& there = nudge_of(studio);
                there.drawing = false;
                there.drawn = view;
                there.lines = lines;
                there.picture = projector_picture(*lines, studio.frame_number);
                if (there.open) show_lines(studio);
            };
        },
        [&studio](const std::exception_ptr& why) {
            nudge_of(studio).drawing = false;
            show_nudge(studio, false);
            notify_failure(studio, "The mock-up's lines could not be drawn.", why);
        });
}

/// What a key means while the panel is open; true when it meant something.
bool nudge_key(Studio& studio, const KeyChord& chord) {
    NudgePanelState& state = nudge_of(studio);
    for (const Way& way : kMoves) {
        if (way.key != chord.key || way.ctrl != chord.ctrl) continue;
        move(studio, way, state.step_px * (chord.shift ? kCoarseMove : 1.0));
        return true;
    }
    if (chord.ctrl && chord.key == GLFW_KEY_Z && !chord.shift) {
        step_back(state.undo, state.redo, state.view);
    } else if (chord.ctrl && (chord.key == GLFW_KEY_Y || chord.key == GLFW_KEY_Z)) {
        step_back(state.redo, state.undo, state.view);
    } else {
        return false;
    }
    return true;
}

void draw_nudge_panel(Studio& studio) {
    NudgePanelState& state = nudge_of(studio);
    const float side = ImGui::GetFrameHeight();
    heading("Move the mock-up by hand");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - side);
    if (ImGui::Button("×##close-nudge", {side, 0.0f})) show_nudge(studio, false);
    name_last_item("nudge:close");
    tooltip("Back to the paints. What was moved stays here until it is kept.");
    dim_text(
        "The projector shows the mock-up's lines where Livery believes it to stand. Move them with "
        "the arrow keys until they lie on the mock-up; green is its outline.");
    row_label("Step");
    for (const double step_px : kSteps_px) {
        if (step_px != kSteps_px.front()) ImGui::SameLine();
        if (toggle_button(fmt::format("{:g} px", step_px).c_str(), state.step_px == step_px))
            state.step_px = step_px;
        name_last_item(fmt::format("nudge:step-{:g}", step_px));
    }
    draw_cross(studio, 0, "Move", "nearer, farther");
    draw_cross(studio, 6, "Turn", "clockwise, back");
    heading("So far");
    dim_text(sentence(in_words(nudged_so_far(studio))));
    name_last_item("nudge:so-far");
    draw_history(state);
    ImGui::Spacing();
    begin_disabled(!is_moved(state) || state.keeping);
    if (ImGui::Button("Keep as a new calibration", {-FLT_MIN, 0.0f})) keep(studio);
    name_last_item("nudge:keep");
    tooltip(
        "Colours stay with their projector pixels; the calibration before is kept. A millimetre "
        "is corrected well; a mock-up that was moved farther wants its colours photographed anew.");
    end_disabled();
    dim_text(
        "Arrows move, Ctrl+arrows turn, PgUp and PgDn bring nearer and farther; Shift takes "
        "ten steps at once. Esc leaves.");
}

void describe_nudge(const Studio& studio, MapState& state) {
    const NudgePanelState& nudge = studio.panels.of<NudgePanelState>();
    state["nudge"] = map_text(nudge.open ? in_words(nudged_so_far(studio)) : "closed");
    state["nudge_drawn"] = map_text(nudge.drawn && *nudge.drawn == nudge.view);
}

bool is_nudge_open(const Studio& studio) { return studio.panels.of<NudgePanelState>().open; }

}  // namespace

Panel nudge_panel() {
    return {.name = "nudge",
            .place = PanelPlace::column,
            .draw = draw_nudge_panel,
            .is_open = is_nudge_open,
            .show = show_nudge,
            .step = take_nudge,
            .press =
                [](Studio& s, const KeyChord& chord, bool) {
                    return is_nudge_open(s) && nudge_key(s, chord) ? EventUse::step
                                                                   : EventUse::passed_on;
                },
            .esc_closes = true,
            .holds_picture = is_nudge_open,
            .describe = describe_nudge,
            .actions =
                [] {
                    Action nudge =
                        panel_action("nudge", "nudge", "Projector", "Move the mock-up by hand…");
                    nudge.enabled = [](const Studio& s) { return !is_open(s, "capture"); };
                    return std::vector{nudge};
                }};
}

}  // namespace livery
