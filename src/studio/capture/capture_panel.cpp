#include "studio/capture/capture_panel.h"

#include <algorithm>
#include <cfloat>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/error.h"
#include "projection/picture_port.h"
#include "studio/calibration_panel.h"
#include "studio/kit/theme.h"
#include "studio/kit/widgets.h"
#include "studio/kit/words.h"
#include "studio/results.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

using Doing = CaptureView::Doing;

constexpr double kBetweenListings_s = 3.0;

bool is_busy(const CaptureView& view) {
    return view.doing == Doing::preflight || view.doing == Doing::fitting ||
           view.doing == Doing::capturing;
}

void list_what_there_is(Shell& shell) {
    CapturePanelState& state = *shell.studio.panels.capture;
    const double now_s = shell.studio.now_s;
    if (state.listed_at_s >= 0.0 && now_s - state.listed_at_s < kBetweenListings_s) return;
    state.listed_at_s = now_s;
    state.problem.clear();
    try {
        state.cameras = list_cameras();
    } catch (const FileError& error) {
        state.problem = error.what();
    }
}

/// The chosen monitor, while pictures reach it.
std::optional<Monitor> projector_monitor(const Shell& shell) {
    const Studio& studio = shell.studio;
    if (studio.projector->state() != ProjectorScreen::State::showing) return std::nullopt;
    return find_monitor(studio.monitors, shell.projector_monitor);
}

bool has_own_projector(const CameraChoice& choice) {
    return choice.kind == CameraChoice::Kind::bench;
}

/// Where the projector stands, as far as the calibration in use knows and the monitor agrees.
std::optional<View> known_pose(const Shell& shell) {
    const auto monitor = projector_monitor(shell);
    const auto& setup = shell.studio.setup;
    if (!monitor || !setup || !setup->calibration) return std::nullopt;
    const bool same = setup->view.width == monitor->width && setup->view.height == monitor->height;
    return same ? std::optional(setup->view) : std::nullopt;
}

CaptureSetup setup_of(const Shell& shell, const CameraChoice& choice) {
    const CapturePanelState& state = *shell.studio.panels.capture;
    CaptureSetup setup;
    setup.camera = choice;
    setup.product = shell.studio.product;
    if (const auto monitor = projector_monitor(shell)) {
        setup.projector =
            fmt::format("{} at {}x{}", monitor->name, monitor->width, monitor->height);
        setup.width = monitor->width;
        setup.height = monitor->height;
    }
    if (state.keeps_pose) setup.projector_view = known_pose(shell);
    Results* results = shell.results.get();
    ProjectorScreen* screen = shell.studio.projector.get();
    setup.projector_port = [results, screen](const Progress& progress, TellWait tell) {
        return show_on({[results](auto picture) { results->show_instead(std::move(picture)); },
                        [screen] { return screen->shown(); }},
                       progress,
                       std::move(tell));
    };
    return setup;
}

void choose(Shell& shell, const CameraChoice& choice) {
    CapturePanelState& state = *shell.studio.panels.capture;
    state.chosen = choice;
    state.selected.reset();
    shell.studio.capture->use(setup_of(shell, choice));
}

void connect(Shell& shell) {
    CapturePanelState& state = *shell.studio.panels.capture;
    state.address_problem.clear();
    try {
        choose(shell, camera_at_address(state.address));
    } catch (const std::invalid_argument& error) {
        state.address_problem = error.what();
    }
}

void ask_for_folder(Shell& shell) {
    FileQuestion question;
    question.kind = FileQuestion::Kind::folder;
    question.title = "Where will the photographs be copied?";
    question.action = "Choose";
    question.then = [&shell](const std::filesystem::path& folder) {
        choose(shell, {CameraChoice::Kind::folder, std::filesystem::absolute(folder).string()});
    };
    shell.studio.file_dialog->ask(std::move(question));
}

/// In the camera's own words; a list where it can be set from here.
void draw_setting(CaptureThread& capture, const CameraSetting& setting) {
    if (!setting.can_be_set || setting.choices.empty()) {
        dim_text(fmt::format("{}: {}.", setting.name, setting.value));
        return;
    }
    ImGui::SetNextItemWidth(em(9.0f));
    if (ImGui::BeginCombo(
            setting.name.c_str(), setting.value.c_str(), ImGuiComboFlags_HeightLarge)) {
        for (const std::string& choice : setting.choices) {
            if (ImGui::Selectable(choice.c_str(), choice == setting.value))
                capture.set(setting.name, choice);
            name_last_item("camera-" + setting.name + ":" + choice);
        }
        ImGui::EndCombo();
    }
    name_last_item("camera-" + setting.name);
}

void draw_cameras(Shell& shell) {
    CapturePanelState& state = *shell.studio.panels.capture;
    heading("Camera");
    begin_disabled(is_busy(state.view));
    const std::string shown = state.chosen ? text_of(*state.chosen) : "Choose…";
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::BeginCombo("##camera", shown.c_str(), ImGuiComboFlags_HeightLarge)) {
        for (const ListedCamera& camera : state.cameras) {
            if (ImGui::Selectable(camera.name.c_str(), shown == camera.choice))
                choose(shell, parse_camera_choice(camera.choice));
            name_last_item("camera:" + camera.choice);
            if (!camera.problem.empty()) tooltip(camera.problem + "\n" + camera.fix);
        }
        ImGui::Separator();
        if (ImGui::Selectable("Any other: shoot, and copy the photographs into a folder…"))
            ask_for_folder(shell);
        name_last_item("camera:folder");
        ImGui::EndCombo();
    }
    name_last_item("camera");
    ImGui::SetNextItemWidth(-button_width("Connect") - ImGui::GetStyle().ItemSpacing.x);
    const bool entered = ImGui::InputTextWithHint("##address",
                                                  "on the network: ptpip:… or http://…",
                                                  &state.address,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    name_last_item("camera-address");
    tooltip(
        "A camera on the network. A still camera (PTP/IP): ptpip:HOST or ptpip:HOST:PORT. A "
        "network camera: the address of its video, http://… or rtsp://…");
    ImGui::SameLine();
    if (ImGui::Button("Connect") || entered) connect(shell);
    name_last_item("camera-connect");
    end_disabled();
    if (!state.address_problem.empty()) warning_text(sentence(state.address_problem));
    if (!state.problem.empty()) warning_text(state.problem);
    const CaptureView& view = state.view;
    if (view.doing == Doing::opening) dim_text("Being opened…");
    if (view.camera.empty()) return;
    dim_text(sentence(view.camera));
    begin_disabled(is_busy(state.view));
    for (const CameraSetting& setting : view.settings) draw_setting(*shell.studio.capture, setting);
    end_disabled();
    if (!view.curve.empty()) dim_text("Its 8-bit files are read with " + view.curve + ".");
    for (const std::string& warning : view.warnings) warning_text(sentence(warning));
}

/// True where there is something to show pictures on.
bool draw_projector(Shell& shell) {
    CapturePanelState& state = *shell.studio.panels.capture;
    heading("Projector");
    if (has_own_projector(*state.chosen)) {
        dim_text("The simulated bench has its own, whose place is known.");
        return true;
    }
    const auto monitor = projector_monitor(shell);
    if (!monitor) {
        warning_text("No projector shows pictures. Choose it in the bar below.");
        return false;
    }
    dim_text(fmt::format("{}, {} × {}.", monitor->name, monitor->width, monitor->height));
    for (const SignalWarning& warning : shell.signal_warnings) {
        warning_text(warning.what);
        tooltip(warning.cause + "\n" + warning.fix);
    }
    if (!known_pose(shell)) {
        dim_text(
            "Where it stands is not known: the whole picture is lit, and you are asked for the "
            "projector's camera file afterwards.");
        return true;
    }
    begin_disabled(is_busy(state.view));
    if (ImGui::Checkbox("it stands as in the calibration in use", &state.keeps_pose))
        choose(shell, *state.chosen);
    name_last_item("keeps-pose");
    tooltip("The mock-up alone is then lit, and what the camera does not see is predicted.");
    end_disabled();
    return true;
}

std::string time_text(double seconds) {
    return seconds < 60.0
               ? fmt::format("{:.0f} s", seconds)
               : fmt::format(
                     "{:.0f} min {:02.0f} s", std::floor(seconds / 60.0), std::fmod(seconds, 60.0));
}

void draw_running(Shell& shell) {
    CaptureThread& capture = *shell.studio.capture;
    const CaptureView& view = shell.studio.panels.capture->view;
    progress_bar(view.fraction, fmt::format("{:.0f} %", 100.0 * view.fraction));
    name_last_item("capture-progress");
    if (view.waits_for_next) {
        if (ImGui::Button("It is taken: the next picture", {-FLT_MIN, em(3.0f)})) capture.next();
        name_last_item("capture-next");
    }
    const float half = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
    if (toggle_button(view.paused ? "Go on" : "Pause", view.paused, half))
        capture.set_paused(!view.paused);
    name_last_item("capture-pause");
    ImGui::SameLine();
    if (ImGui::Button("Stop", {half, 0.0f})) {
        capture.set_paused(false);
        capture.cancel();
    }
    name_last_item("capture-stop");
    tooltip(
        "What was photographed is kept: the capture goes on from there when it is started "
        "again, also after the program was closed.");
    // Below the buttons, which else would move with every line that is wrapped.
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

void draw_start(Shell& shell, bool can_show) {
    CaptureThread& capture = *shell.studio.capture;
    CapturePanelState& state = *shell.studio.panels.capture;
    const CaptureView& view = state.view;
    const bool by_hand = state.chosen->kind == CameraChoice::Kind::folder;
    begin_disabled(!can_show || view.doing == Doing::opening || (view.camera.empty() && !by_hand));
    if (!by_hand) {
        if (ImGui::Button("Look first", {-FLT_MIN, 0.0f})) capture.start_preflight();
        name_last_item("preflight");
        tooltip(
            "Finds in half a minute what would spoil a capture: a scaled picture, dynamic modes, "
            "focus, room light, flicker.");
        if (view.may_have_curve) {
            if (ImGui::Button("Fit the camera's curve", {-FLT_MIN, 0.0f}))
                capture.start_curve_fit();
            name_last_item("fit-curve");
            tooltip(
                "For a camera that gives no RAW: photographs white at other exposures and finds "
                "what its numbers mean. Kept for the next time.");
        }
    }
    const char* start = view.can_go_on && !by_hand ? "Go on with the capture" : "Start the capture";
    if (ImGui::Button(start, {-FLT_MIN, em(2.4f)})) capture.start_capture(!view.can_go_on);
    name_last_item("capture-start");
    if (view.can_go_on && !by_hand) {
        if (ImGui::Button("Take all anew", {-FLT_MIN, 0.0f})) capture.start_capture(true);
        name_last_item("capture-anew");
        tooltip("Forgets the photographs of the last capture.");
    }
    end_disabled();
    if (!view.why.empty()) {
        warning_text(sentence("refused: " + view.why));
        name_last_item("capture-refused");
        dim_text(sentence("what helps: " + view.fix));
        if (view.can_go_on && !by_hand)
            dim_text("The other photographs are kept. Choose one in the middle to take it again.");
    }
    if (view.finished) {
        std::string text = fmt::format("Calibrated: {} photographs taken, {} kept from before",
                                       view.taken,
                                       view.kept_from_before);
        if (!by_hand)
            text += fmt::format(
                ", in {:.1f} s, of which {:.1f} s in the camera and {:.1f} s in "
                "the projector",
                view.capture_s,
                view.camera_s,
                view.projector_s);
        dim_text(text + ".");
        name_last_item("capture-finished");
    }
}

}  // namespace

void take_capture(Shell& shell) {
    Studio& studio = shell.studio;
    if (!studio.capture) return;
    CapturePanelState& state = *studio.panels.capture;
    state.view = studio.capture->view();
    // Not when it is closed: the frame that is being drawn then shows them.
    if (!shell.capture_open) state.textures.clear();
    const bool busy = is_busy(state.view);
    if (std::exchange(state.was_busy, busy) && !busy) shell.results->show_instead(nullptr);
    if (!state.view.finished || *state.view.finished == state.taken) return;
    state.taken = *state.view.finished;
    stop_trying(studio);
    load_calibration(studio, state.taken);
    notify(studio,
           {Notice::Level::info, "The capture is done, and its calibration is in use.", "", ""});
}

void show_capture(Shell& shell, bool shown) {
    shell.capture_open = shown;
    CapturePanelState& state = *shell.studio.panels.capture;
    if (shown) {
        state.listed_at_s = -1.0;
        if (state.chosen) choose(shell, *state.chosen);
    } else {
        shell.studio.capture->close();
    }
}

void draw_capture_panel(Shell& shell) {
    list_what_there_is(shell);
    CapturePanelState& state = *shell.studio.panels.capture;
    ImGui::PushFont(large_font());
    ImGui::TextUnformatted("Capture");
    ImGui::PopFont();
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - button_width("Close"));
    begin_disabled(is_busy(state.view));
    if (ImGui::Button("Close")) {
        show_capture(shell, false);
        end_disabled();
        return;
    }
    name_last_item("capture-close");
    end_disabled();
    dim_text("Shows the patterns on the projector, photographs them, and makes the calibration.");
    draw_cameras(shell);
    if (!state.chosen) return;
    const bool can_show = draw_projector(shell);
    ImGui::Spacing();
    if (is_busy(state.view)) {
        draw_running(shell);
    } else {
        draw_start(shell, can_show);
    }
    if (!state.view.figures.empty()) {
        heading("Is the bench fit?");
        draw_figures(state.view.figures);
        for (const GradedFigure& figure : state.view.figures)
            if (figure.grade == Grade::bad) warning_text(figure.name + ": " + figure.fix);
    }
}

}  // namespace livery
