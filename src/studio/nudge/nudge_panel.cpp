#include "studio/nudge/nudge_panel.h"

#include <array>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "core/log.h"
#include "live/projector_setup.h"
#include "projection/projector_screen.h"
#include "scene/mockup_mask.h"
#include "studio/kit/background.h"
#include "studio/kit/theme.h"
#include "studio/kit/widgets.h"
#include "studio/kit/words.h"
#include "studio/projector_control.h"
#include "studio/results.h"
#include "studio/window/actions.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

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

NudgePanelState& state_of(Shell& shell) { return *shell.studio.panels.nudge; }

/// Loaded anew, for another design white say, it is still the one that is being moved.
bool is_of(const NudgePanelState& state, const ProjectorSetup& setup) {
    return state.setup && state.setup->calibration && setup.calibration &&
           state.setup->calibration->id == setup.calibration->id && state.setup->view == setup.view;
}

bool is_moved(const NudgePanelState& state) {
    return state.setup && state.view != state.setup->view;
}

void move(Shell& shell, const Way& way, double step_px) {
    NudgePanelState& state = state_of(shell);
    Nudge by;
    by.*way.part = way.sign * step_px;
    try {
        View to = nudged(state.view, shell.product_bounds, by);
        state.undo.push_back(std::exchange(state.view, to));
        state.redo.clear();
    } catch (const std::invalid_argument&) {
        notify(shell.studio,
               {Notice::Level::warning,
                "The mock-up would leave the projector's picture.",
                "",
                "Start over, or calibrate anew where it stands now.",
                shell.studio.now_s + 10.0});
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
void keep(Shell& shell) {
    Studio& studio = shell.studio;
    NudgePanelState& state = state_of(shell);
    if (!is_moved(state) || state.keeping) return;
    state.keeping = true;
    studio.background->run(
        [&shell,
         from = std::filesystem::path(studio.session.document().calibration),
         view = state.view,
         product = studio.product](const Progress&) -> Background::Then {
            const auto folder = keep_nudged(from, view, product->mesh);
            return [&shell, folder] {
                state_of(shell).keeping = false;
                show_nudge(shell, false);
                commit(shell.studio, SetCalibration{folder.string()});
                notify(shell.studio,
                       {Notice::Level::info,
                        "The moved mock-up is kept as a calibration of its own.",
                        "",
                        "Undo, or Calibrate > Go back to, returns to the one before.",
                        shell.studio.now_s + 15.0});
            };
        },
        [&shell](const std::exception_ptr& why) {
            state_of(shell).keeping = false;
            notify_failure(shell.studio, "The moved mock-up could not be kept.", why);
        });
}

void draw_way(Shell& shell, const Way& way, float width) {
    NudgePanelState& state = state_of(shell);
    if (ImGui::Button(fmt::format("{}##{}", way.label, way.item).c_str(), {width, 0.0f}))
        move(shell, way, state.step_px);
    name_last_item(fmt::format("nudge:{}", way.item));
    const KeyChord chord{way.key, way.ctrl, false};
    tooltip(fmt::format("{} by {:g} pixels ({}; with Shift ten times that)",
                        way.meaning,
                        state.step_px,
                        text_of(chord)));
}

/// Four arrows in a cross, plus and minus beside them, from `first` on.
void draw_cross(Shell& shell, std::size_t first, const char* title, const char* beside) {
    const float width = em(2.6f), gap = ImGui::GetStyle().ItemSpacing.x;
    const auto at = [&](std::size_t k) -> const Way& { return kMoves[first + k]; };
    heading(title);
    const float left = ImGui::GetCursorPosX();
    const auto column = [&](int k) {
        ImGui::SetCursorPosX(left + static_cast<float>(k) * (width + gap));
    };
    column(1);
    draw_way(shell, at(2), width);
    ImGui::SameLine();
    column(4);
    draw_way(shell, at(4), width);
    ImGui::SameLine();
    dim_text(beside);
    draw_way(shell, at(0), width);
    ImGui::SameLine();
    column(2);
    draw_way(shell, at(1), width);
    ImGui::SameLine();
    column(4);
    draw_way(shell, at(5), width);
    column(1);
    draw_way(shell, at(3), width);
}

void draw_history(NudgePanelState& state) {
    const float third = std::floor(
        (ImGui::GetContentRegionAvail().x - 2.0f * ImGui::GetStyle().ItemSpacing.x) / 3.0f);
    const auto button = [&](const char* label, const char* item, bool on, auto&& press) {
        begin_disabled(!on);
        if (ImGui::Button(label, {third, 0.0f})) press();
        name_last_item(item);
        end_disabled();
    };
    button("Undo", "nudge:undo", !state.undo.empty(), [&] {
        step_back(state.undo, state.redo, state.view);
    });
    ImGui::SameLine();
    button("Redo", "nudge:redo", !state.redo.empty(), [&] {
        step_back(state.redo, state.undo, state.view);
    });
    ImGui::SameLine();
    button("Start over", "nudge:start-over", is_moved(state), [&] { start_over(state); });
}

}  // namespace

MockupMotion nudged_so_far(const Shell& shell) {
    const NudgePanelState& state = *shell.studio.panels.nudge;
    if (!state.setup) return {};
    return motion_between(state.setup->view, state.view, shell.product_bounds);
}

void show_nudge(Shell& shell, bool shown) {
    Studio& studio = shell.studio;
    NudgePanelState& state = state_of(shell);
    if (shown == shell.nudge_open) return;
    if (!shown) {
        shell.nudge_open = false;
        shell.results->show_instead(nullptr);
        shell.photographed.reset();
        state.photographed.reset();
        return;
    }
    if (!studio.setup || !studio.setup->calibration ||
        studio.session.document().calibration.empty()) {
        notify(studio,
               {Notice::Level::warning,
                "There is no calibration whose mock-up could be moved.",
                "Its pose is found by photographs first; by hand it is only corrected.",
                "Calibrate first.",
                studio.now_s + 15.0});
        return;
    }
    stop_trying(studio);
    if (shell.signal_test_open) show_signal_test(shell, false);
    if (!is_of(state, *studio.setup)) {
        const double step_px = state.step_px;
        state = {};
        state.step_px = step_px;
        state.view = studio.setup->view;
    }
    state.setup = studio.setup;
    shell.nudge_open = true;
    studio.view = StageView::projector;
    if (state.picture) shell.results->show_instead(state.picture);
}

void take_nudge(Shell& shell) {
    NudgePanelState& state = state_of(shell);
    Studio& studio = shell.studio;
    if (!shell.nudge_open) return;
    if (!studio.setup || !is_of(state, *studio.setup)) return show_nudge(shell, false);
    if (state.drawing || (state.drawn && *state.drawn == state.view)) return;
    state.drawing = true;
    studio.background->run(
        [&shell, view = std::make_shared<const View>(state.view), product = studio.product](
            const Progress&) -> Background::Then {
            const auto lines =
                std::make_shared<const Image8>(wireframe_picture(product->mesh, *view));
            return [&shell, view, lines] {
                NudgePanelState& there = state_of(shell);
                there.drawing = false;
                there.drawn = view;
                there.lines = lines;
                there.picture = projector_picture(*lines, shell.frame_number);
                if (shell.nudge_open) shell.results->show_instead(there.picture);
            };
        },
        [&shell](const std::exception_ptr& why) {
            state_of(shell).drawing = false;
            show_nudge(shell, false);
            notify_failure(shell.studio, "The mock-up's lines could not be drawn.", why);
        });
}

bool nudge_key(Shell& shell, const KeyChord& chord) {
    NudgePanelState& state = state_of(shell);
    for (const Way& way : kMoves) {
        if (way.key != chord.key || way.ctrl != chord.ctrl) continue;
        move(shell, way, state.step_px * (chord.shift ? kCoarseMove : 1.0));
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

void draw_nudge_panel(Shell& shell) {
    NudgePanelState& state = state_of(shell);
    const float side = ImGui::GetFrameHeight();
    heading("Move the mock-up by hand");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - side);
    if (ImGui::Button("×##close-nudge", {side, 0.0f})) show_nudge(shell, false);
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
    draw_cross(shell, 0, "Move", "nearer, farther");
    draw_cross(shell, 6, "Turn", "clockwise, back");
    heading("So far");
    dim_text(sentence(in_words(nudged_so_far(shell))));
    name_last_item("nudge:so-far");
    draw_history(state);
    ImGui::Spacing();
    begin_disabled(!is_moved(state) || state.keeping);
    if (ImGui::Button("Keep as a new calibration", {-FLT_MIN, 0.0f})) keep(shell);
    name_last_item("nudge:keep");
    tooltip(
        "Colours stay with their projector pixels; the calibration before is kept. A millimetre "
        "is corrected well; a mock-up that was moved farther wants its colours photographed anew.");
    end_disabled();
    dim_text(
        "Arrows move, Ctrl+arrows turn, PgUp and PgDn bring nearer and farther; Shift takes "
        "ten steps at once. Esc leaves.");
}

}  // namespace livery
