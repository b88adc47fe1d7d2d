#include "studio/capture/capture_panel.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <charconv>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/error.h"
#include "projection/projector_screen.h"
#include "scene/data_sheet.h"
#include "studio/kit/theme.h"
#include "studio/kit/user_settings.h"
#include "studio/kit/widgets.h"
#include "studio/kit/words.h"
#include "studio/nudge/nudge_panel.h"
#include "studio/projector_words.h"
#include "studio/results.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

struct Field {
    const char* name;
    double DataSheets::*value;
};
constexpr std::array<Field, 5> kFields{{{"throw-ratio", &DataSheets::throw_ratio},
                                        {"lens-shift", &DataSheets::lens_shift},
                                        {"focal-mm", &DataSheets::focal_mm},
                                        {"sensor-width-mm", &DataSheets::sensor_width_mm},
                                        {"lens-distance-mm", &DataSheets::lens_distance_mm}}};

/// What was typed last; all but the lens shift 0: nothing was.
DataSheets kept_data_sheets(const UserSettings& settings) {
    DataSheets sheets{0.0, 0.5, 0.0, 0.0, 0.0};
    for (const Field& field : kFields) {
        const std::string text = setting(settings, field.name);
        double value = 0.0;
        const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
        if (read.ec == std::errc()) sheets.*field.value = value;
    }
    return sheets;
}

void keep_data_sheets(UserSettings& settings, const DataSheets& sheets) {
    for (const Field& field : kFields)
        keep_setting(settings, field.name, fmt::format("{}", sheets.*field.value));
}

}  // namespace

bool is_busy(const CaptureView& view) {
    using Doing = CaptureView::Doing;
    return view.doing == Doing::preflight || view.doing == Doing::fitting ||
           view.doing == Doing::capturing || view.doing == Doing::checking;
}

namespace {

using Doing = CaptureView::Doing;

constexpr double kBetweenListings_s = 3.0;

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

bool are_whole(const DataSheets& sheets) {
    return sheets.throw_ratio > 0.0 && sheets.focal_mm > 0.0 && sheets.sensor_width_mm > 0.0 &&
           sheets.lens_distance_mm > 0.0;
}

using Place = CapturePanelState::Place;

/// As chosen, while it can be; else what needs the least of people.
Place place_of(const Shell& shell) {
    const CapturePanelState& state = *shell.studio.panels.capture;
    const bool known = known_pose(shell).has_value(), own = has_own_projector(*state.chosen);
    if (state.place == Place::kept && known) return Place::kept;
    if (state.place && *state.place != Place::kept) return *state.place;
    if (own) return Place::found;
    return known ? Place::kept : are_whole(state.sheets) ? Place::found : Place::told;
}

}  // namespace

CaptureSetup capture_setup(const Shell& shell, const CameraChoice& choice) {
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
    const Place place = place_of(shell);
    if (place == Place::kept) setup.projector_view = known_pose(shell);
    if (place == Place::found && are_whole(state.sheets)) setup.data_sheets = state.sheets;
    setup.colour_shots = state.colour_shots;
    setup.places = state.colour_shots >= 4 ? PlaceCode::gray_and_phase : PlaceCode::gray;
    setup.in_use = shell.studio.session.document().calibration;
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

namespace {

void choose(Shell& shell, const CameraChoice& choice) {
    CapturePanelState& state = *shell.studio.panels.capture;
    state.chosen = choice;
    state.selected.reset();
    shell.studio.capture->use(capture_setup(shell, choice));
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
    for (const std::string& warning : view.warnings) warning_text(sentence(warning));
}

/// What is seldom needed once the camera is there.
void draw_camera_settings(Shell& shell) {
    const CaptureView& view = shell.studio.panels.capture->view;
    if (view.camera.empty()) return;
    heading("Camera's settings");
    dim_text(sentence(view.camera));
    begin_disabled(is_busy(view));
    for (const CameraSetting& setting : view.settings) draw_setting(*shell.studio.capture, setting);
    end_disabled();
    if (!view.curve.empty()) dim_text("Its 8-bit files are read with " + view.curve + ".");
}

/// The five figures that photographs do not tell.
void draw_data_sheets(Shell& shell) {
    CapturePanelState& state = *shell.studio.panels.capture;
    DataSheets& sheets = state.sheets;
    bool changed = false;
    const auto row = [&](const char* label,
                         const char* item,
                         double& value,
                         const char* format,
                         const char* meaning) {
        row_label(label);
        ImGui::SetNextItemWidth(em(7.0f));
        ImGui::InputDouble(fmt::format("##{}", item).c_str(), &value, 0.0, 0.0, format);
        changed |= ImGui::IsItemDeactivatedAfterEdit();
        name_last_item(item);
        tooltip(meaning);
    };
    row("Throw ratio",
        "sheet-throw",
        sheets.throw_ratio,
        "%.3f",
        "The projector's distance over the width of its picture, at the zoom that is set.");
    row("Lens shift",
        "sheet-shift",
        sheets.lens_shift,
        "%.3f",
        "How far the picture's middle lies over the lens's axis, in picture heights: 0.5 where "
        "the lower edge is as high as the lens.");
    row("Focal length",
        "sheet-focal",
        sheets.focal_mm,
        "%.1f mm",
        "The camera's, as its lens or its files say; not the one for small film.");
    row("Sensor width",
        "sheet-sensor",
        sheets.sensor_width_mm,
        "%.2f mm",
        "Of the camera's sensor: 36 mm for small film, about 22 to 24 mm for APS-C.");
    row("Lens to lens",
        "sheet-distance",
        sheets.lens_distance_mm,
        "%.0f mm",
        "From the projector's lens to the camera's, by a tape.");
    if (!changed) return;
    keep_data_sheets(shell.studio.settings, sheets);
    choose(shell, *state.chosen);
}

/// How the projector's place comes to be known.
void draw_place(Shell& shell) {
    CapturePanelState& state = *shell.studio.panels.capture;
    const Place place = place_of(shell);
    begin_disabled(is_busy(state.view));
    const auto offer = [&](Place which, const char* label, const char* item, const char* meaning) {
        if (ImGui::RadioButton(label, place == which) && place != which) {
            state.place = which;
            choose(shell, *state.chosen);
        }
        name_last_item(item);
        tooltip(meaning);
    };
    offer(Place::found,
          "find where it stands, from photographs",
          "place-found",
          "Gray code on the mock-up, its mesh, and the data sheets of projector and camera.");
    if (known_pose(shell))
        offer(Place::kept,
              "it stands as in the calibration in use",
              "place-kept",
              "The mock-up alone is lit, and what the camera does not see is predicted.");
    if (!has_own_projector(*state.chosen)) {
        offer(Place::told,
              "I have the projector's camera file",
              "place-told",
              "The whole picture is lit, and you are asked for the file when the capture is "
              "accepted.");
        const bool whole = are_whole(state.sheets);
        if (place == Place::found) {
            ImGui::SetNextItemOpen(!whole, ImGuiCond_Appearing);
            const bool open = ImGui::CollapsingHeader("Data sheets");
            name_last_item("data-sheets");
            if (open) draw_data_sheets(shell);
        }
        if (place == Place::found && !are_whole(state.sheets))
            warning_text("All five figures are needed: photographs alone leave sizes open.");
    }
    end_disabled();
}

/// True where there is something to show pictures on.
bool draw_projector(Shell& shell) {
    CapturePanelState& state = *shell.studio.panels.capture;
    heading("Projector");
    if (has_own_projector(*state.chosen)) {
        dim_text("The simulated bench's own.");
        draw_place(shell);
        return true;
    }
    const auto monitor = projector_monitor(shell);
    if (!monitor) {
        warning_text("No projector shows pictures. Choose it in the bar below.");
        return false;
    }
    dim_text(fmt::format("{}, {} × {}.", monitor->name, monitor->width, monitor->height));
    for (const SignalWarning& warning : shell.signal_warnings) {
        coloured_text(colour_of(warning.severity), warning.what);
        name_last_item(fmt::format("capture-signal:{}", name_of(warning.severity)));
        tooltip(warning.cause + "\n" + warning.fix);
        if (warning.severity == SignalWarning::Severity::error) dim_text(warning.fix);
    }
    draw_place(shell);
    return true;
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
}

void show_capture(Shell& shell, bool shown) {
    if (shown) show_nudge(shell, false);
    shell.capture_open = shown;
    CapturePanelState& state = *shell.studio.panels.capture;
    if (shown) {
        state.listed_at_s = -1.0;
        if (!std::exchange(state.sheets_read, true))
            state.sheets = kept_data_sheets(shell.studio.settings);
        if (state.chosen) choose(shell, *state.chosen);
    } else {
        shell.studio.capture->close();
    }
}

void draw_capture_panel(Shell& shell) {
    list_what_there_is(shell);
    CapturePanelState& state = *shell.studio.panels.capture;
    ImGui::PushFont(large_font());
    ImGui::TextUnformatted("Calibrate");
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
    dim_text("From cable to corrected picture, step by step.");
    draw_cameras(shell);
    if (!state.chosen) return;
    const bool can_show = draw_projector(shell);
    ImGui::Spacing();
    draw_capture_steps(shell, can_show);
    draw_camera_settings(shell);
}

}  // namespace livery
