// The steps from cable to corrected picture: what each found, and the button to the next.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "studio/calibrate/calibration_panel.h"
#include "studio/capture/capture_panel.h"
#include "studio/studio.h"

namespace livery {

namespace {

struct StepWords {
    CaptureStep step;
    const char* name;
    const char* id;      ///< for other programs
    const char* item;    ///< of its button
    const char* action;  ///< on the button
    const char* meaning;
};
constexpr std::array<StepWords, kCaptureSteps> kSteps{
    {{CaptureStep::look,
      "Look",
      "look",
      "preflight",
      "Look first",
      "Finds in half a minute what would spoil a capture: a scaled picture, dynamic modes, focus, "
      "room light, flicker."},
     {CaptureStep::geometry,
      "Geometry",
      "geometry",
      "capture-geometry",
      "Photograph the geometry",
      "Stripes on the mock-up tell where projector, camera and mock-up stand."},
     {CaptureStep::colour,
      "Colours",
      "colour",
      "capture-start",
      "Photograph the colours",
      "Six colours on the mock-up tell what each projector pixel must show."},
     {CaptureStep::check,
      "Check",
      "check",
      "capture-check",
      "Check",
      "Shows corrected colours that nothing was fitted to, and photographs them."}}};

std::string time_text(double seconds) {
    return seconds < 60.0
               ? fmt::format("{:.0f} s", seconds)
               : fmt::format(
                     "{:.0f} min {:02.0f} s", std::floor(seconds / 60.0), std::fmod(seconds, 60.0));
}

void draw_running(Studio& studio) {
    CaptureThread& capture = *studio.capture;
    const CaptureView& view = studio.panels.of<CapturePanelState>().view;
    progress_bar(view.fraction, fmt::format("{:.0f} %", 100.0 * view.fraction));
    name_last_item("capture-progress");
    if (view.waits_for_next) {
        if (ImGui::Button("It is taken: the next picture", {-FLT_MIN, em(3.0f)})) capture.next();
        name_last_item("capture-next");
    }
    const float half = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
    if (named(toggle_button(view.paused ? "Go on" : "Pause", view.paused, half), "capture-pause"))
        capture.set_paused(!view.paused);
    ImGui::SameLine();
    if (named(ImGui::Button("Stop", {half, 0.0f}),
              "capture-stop",
              "What was photographed is kept: the capture goes on from there when it is started "
              "again, also after the program was closed.")) {
        capture.set_paused(false);
        capture.cancel();
    }
    // Below the buttons, which else would move with every line that is wrapped.
    if (!view.found_before.empty()) dim_text(sentence(view.found_before));
    std::string text = sentence(view.stage);
    text += fmt::format(" {} so far", time_text(view.elapsed_s));
    if (view.remaining_s && !view.waits_for_next)
        text += fmt::format(", about {} more", time_text(*view.remaining_s));
    dim_text(text + ".");
    if (!view.wait.why.empty()) {
        warning_text(sentence("it waits: " + view.wait.why));
        name_last_item("capture-waits");
        dim_text(sentence(view.wait.fix));
    }
}

/// The first step that is called for and not done. A look may be left out: once a later one is
/// done it is not asked for any more.
std::optional<CaptureStep> next_step(const CaptureView& view) {
    const bool begun = view.step(CaptureStep::geometry).done || view.step(CaptureStep::colour).done;
    for (const StepWords& words : kSteps) {
        const CaptureStepView& step = view.step(words.step);
        const bool left_out = words.step == CaptureStep::look && begun;
        if (step.called_for && !step.done && !left_out) return words.step;
    }
    return std::nullopt;
}

bool is_accepted(const CapturePanelState& state) {
    return state.view.finished && *state.view.finished == state.accepted;
}

/// Into use, if it can be told where its projector stands.
void accept(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    state.before = studio.session.document().calibration;
    state.accepted = *state.view.finished;
    stop_trying(studio);
    load_calibration(studio, state.accepted);
}

void draw_trouble(const CaptureView& view) {
    if (view.why.empty()) return;
    warning_text(sentence("refused: " + view.why));
    name_last_item("capture-refused");
    dim_text(sentence("what helps: " + view.fix));
    const bool kept = std::any_of(
        view.steps.begin(), view.steps.end(), [](const auto& step) { return step.can_go_on; });
    if (kept)
        dim_text("The other photographs are kept. Choose one in the middle to take it again.");
}

void draw_effort(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    struct Effort {
        const char* name;
        const char* item;
        int shots;
        const char* meaning;
    };
    static constexpr std::array<Effort, 3> kEfforts{
        {{"Quick", "effort-quick", 1, "One photograph of each colour."},
         {"Normal", "effort-normal", 2, "Two of each: a third less noise."},
         {"Best",
          "effort-best",
          4,
          "Four of each, half the noise, and fringes that tell places finer."}}};
    row_label("Effort");
    for (const Effort& effort : kEfforts) {
        if (effort.shots != kEfforts[0].shots) ImGui::SameLine();
        if (ImGui::RadioButton(effort.name, state.colour_shots == effort.shots) &&
            state.colour_shots != effort.shots) {
            state.colour_shots = effort.shots;
            CaptureSetup setup = capture_setup(studio, *state.chosen);
            studio.capture->use(std::move(setup));
        }
        name_last_item(effort.item);
        tooltip(effort.meaning);
    }
}

/// Beside Accept: what the corrected colours came to, or that nobody has looked.
void draw_what_check_found(const CaptureView& view) {
    const CaptureStepView& check = view.step(CaptureStep::check);
    if (!check.called_for) return;
    if (!check.done) {
        dim_text("Its corrected colours have not been checked.");
        return;
    }
    draw_figures(check.figures);
}

/// The large button: the next step, or the end.
void draw_next(Studio& studio, bool ready) {
    CaptureThread& capture = *studio.capture;
    const CapturePanelState& state = studio.panels.of<CapturePanelState>();
    const CaptureView& view = state.view;
    const bool by_hand = traits_of(*state.chosen).is_by_hand;
    const auto next = next_step(view);
    const bool finished = view.finished && view.step(CaptureStep::colour).done;
    begin_disabled(!ready);
    const ImVec2 large{-FLT_MIN, em(2.4f)};
    if (next) {
        const StepWords& words = kSteps[static_cast<std::size_t>(*next)];
        const CaptureStepView& step = view.step(*next);
        std::string label =
            step.can_go_on ? "Go on with: " + std::string(words.name) : words.action;
        if (step.expected_s >= 1.0 && !by_hand)
            label += fmt::format(" (about {})", time_text(step.expected_s));
        if (named(ImGui::Button(label.c_str(), large), "capture-next-step", words.meaning))
            capture.start(*next, false);
    }
    if (finished && !is_accepted(state)) {
        if (ImGui::Button("Accept: put it to use", next ? ImVec2{-FLT_MIN, 0.0f} : large))
            accept(studio);
        name_last_item("accept");
        tooltip("The calibration before is kept, and can be gone back to.");
        draw_what_check_found(view);
    }
    end_disabled();
    if (finished && is_accepted(state)) {
        dim_text("This calibration is in use.");
        name_last_item("accepted");
        if (button("Back to the one before", "revert", "", -FLT_MIN)) {
            commit(studio, SetCalibration{state.before.string()});
            studio.panels.of<CapturePanelState>().accepted.clear();
        }
    }
}

/// What the bench is like against how the calibration in use left it.
void draw_drift(Studio& studio, bool ready) {
    const CaptureView& view = studio.panels.of<CapturePanelState>().view;
    if (studio.session.document().calibration.empty() || !ready) return;
    if (ImGui::Button("Has anything moved since?", {-FLT_MIN, 0.0f}))
        studio.capture->look_for_drift(studio.session.document().calibration);
    name_last_item("look-for-drift");
    tooltip("Two photographs, against those that ended the calibration in use.");
    if (view.drift.empty()) return;
    draw_figures(view.drift);
    const OverallGrade grade = grade_of(view.drift);
    if (grade.grade == Grade::good) {
        dim_text("The bench is as it was calibrated.");
    } else {
        warning_text(sentence(grade.reason));
        dim_text(sentence(grade.fix));
    }
    name_last_item("drift");
}

/// After a bump: the calibration in use, carried to where the mock-up stands now.
void draw_find_again(Studio& studio, bool ready) {
    const CaptureView& view = studio.panels.of<CapturePanelState>().view;
    const std::string& in_use = studio.session.document().calibration;
    if (in_use.empty() || !ready) return;
    if (ImGui::Button("Find the bumped mock-up again", {-FLT_MIN, 0.0f}))
        studio.capture->find_mockup_again(in_use);
    name_last_item("find-again");
    tooltip(
        "Two photographs of stripes tell where it stands now; the calibration in use and its "
        "colours are carried there, as a calibration of its own. For bumps of some millimetres.");
    if (!view.reposed) return;
    draw_figures(view.found_again);
    const bool used =
        view.reposed->lexically_normal() == std::filesystem::path(in_use).lexically_normal();
    begin_disabled(used);
    if (ImGui::Button(used ? "In use" : "Put it to use", {-FLT_MIN, 0.0f}))
        commit(studio, SetCalibration{view.reposed->string()});
    name_last_item("accept-found-again");
    tooltip("Undo returns to the one before.");
    end_disabled();
}

void draw_step(Studio& studio, const StepWords& words, bool ready) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    const CaptureStepView& step = state.view.step(words.step);
    const bool now = is_busy(state.view) && state.view.doing_step == words.step;
    const OverallGrade grade = grade_of(step.figures);
    std::string shown = words.name;
    ImVec4 colour = colours::dim_text;
    const char* mark = "○";
    if (!step.called_for) {
        const bool by_hand = traits_of(*state.chosen).is_by_hand;
        shown += words.step != CaptureStep::geometry ? ": not here"
                 : by_hand                           ? ": with the colours"
                                                     : ": where it stands is given";
    } else if (now) {
        mark = "●";
        colour = colours::accent;
    } else if (step.done) {
        mark = "●";
        colour = colour_of(grade.grade);
        shown += ": " + to_string(grade.grade);
        if (step.seconds > 0.0) shown += fmt::format(", {}", time_text(step.seconds));
    } else if (step.can_go_on) {
        shown += ": stopped half-way, its photographs are kept";
    }
    ImGui::PushID(words.item);
    ImGui::TextColored(colour, "%s", mark);
    ImGui::SameLine();
    ImGui::TextUnformatted(shown.c_str());
    name_last_item(std::string("step:") + words.item);
    tooltip(words.meaning);
    const bool can_begin = words.step != CaptureStep::check ||
                           state.view.step(CaptureStep::colour).done;  // there is nothing to check
    if (step.called_for && can_begin && ready && !is_busy(state.view)) {
        const char* label = step.done ? "Again" : step.can_go_on ? "Go on" : "Do";
        const float anew =
            step.can_go_on ? button_width("Anew") + ImGui::GetStyle().ItemSpacing.x : 0.0f;
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - button_width(label) - anew);
        if (ImGui::SmallButton(label)) studio.capture->start(words.step, step.done);
        name_last_item(words.item);
        tooltip(step.done ? "Forgets what this step photographed, and what follows from it."
                          : "This step, and nothing after it.");
        if (step.can_go_on) {
            ImGui::SameLine();
            if (ImGui::SmallButton("Anew")) studio.capture->start(words.step, true);
            name_last_item(std::string(words.item) + "-anew");
            tooltip("Forgets what was photographed.");
        }
    }
    if (step.done && grade.grade != Grade::good) {
        warning_text(sentence(grade.reason));
        dim_text(sentence(grade.fix));
    }
    // The figures of what is good are there for those who ask.
    if (!step.figures.empty()) {
        const bool open = now || grade.grade != Grade::good;
        ImGui::SetNextItemOpen(open, ImGuiCond_Appearing);
        if (ImGui::TreeNode("Figures")) {
            draw_figures(step.figures);
            ImGui::TreePop();
        }
    }
    ImGui::PopID();
}

}  // namespace

std::string next_capture_step(const CaptureView& view) {
    const auto next = next_step(view);
    return next ? kSteps[static_cast<std::size_t>(*next)].id : "";
}

std::vector<std::pair<std::string, const CaptureStepView*>> named_capture_steps(
    const CaptureView& view) {
    std::vector<std::pair<std::string, const CaptureStepView*>> steps;
    for (const StepWords& words : kSteps) steps.emplace_back(words.id, &view.step(words.step));
    return steps;
}

void draw_capture_steps(Studio& studio, bool can_show) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    const CaptureView& view = state.view;
    const bool by_hand = traits_of(*state.chosen).is_by_hand;
    const bool ready =
        can_show && view.doing != CaptureView::Doing::opening && (!view.camera.empty() || by_hand);
    if (is_busy(view)) {
        draw_running(studio);
    } else {
        if (!by_hand) draw_effort(studio);
        draw_next(studio, ready);
        draw_trouble(view);
        if (!view.finished || is_accepted(state)) {
            draw_drift(studio, ready && !by_hand);
            draw_find_again(studio, ready && !by_hand);
        }
    }
    heading("Steps");
    for (const StepWords& words : kSteps) draw_step(studio, words, ready);
    if (!view.compared.empty()) {
        heading("Against the one in use");
        draw_figures(view.compared);
        name_last_item("compared");
    }
    if (view.finished && !by_hand) {
        dim_text(fmt::format(
            "Calibrated: {} photographs taken, {} kept from before, in {:.1f} s, of which {:.1f} s "
            "in the camera and {:.1f} s in the projector.",
            view.taken,
            view.kept_from_before,
            view.capture_s,
            view.camera_s,
            view.projector_s));
        name_last_item("capture-finished");
    }
    if (!is_busy(view) && view.may_have_curve && ready) {
        if (ImGui::Button("Fit the camera's curve", {-FLT_MIN, 0.0f}))
            studio.capture->start_curve_fit();
        name_last_item("fit-curve");
        tooltip(
            "For a camera that gives no RAW: photographs white at other exposures and finds what "
            "its numbers mean. Kept for the next time.");
    }
}

}  // namespace livery
