#include "studio/capture/capture_panel.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <charconv>
#include <stdexcept>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/error.h"
#include "projection/projector_screen.h"
#include "studio/studio.h"

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

void list_cameras_now_and_then(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    const double now_s = studio.now_s;
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
std::optional<Monitor> projector_monitor(const Studio& studio) {
    if (studio.projector->state() != ProjectorScreen::State::showing) return std::nullopt;
    return find_monitor(studio.monitors, studio.projector_monitor);
}

bool has_own_projector(const CameraChoice& choice) { return traits_of(choice).is_simulated; }

/// Where the projector stands, as far as the calibration in use knows and the monitor agrees.
std::optional<View> known_pose(const Studio& studio) {
    const auto monitor = projector_monitor(studio);
    const auto& setup = studio.setup;
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
Place place_of(const Studio& studio) {
    const CapturePanelState& state = studio.panels.of<CapturePanelState>();
    const bool known = known_pose(studio).has_value(), own = has_own_projector(*state.chosen);
    if (state.place == Place::kept && known) return Place::kept;
    if (state.place && *state.place != Place::kept) return *state.place;
    if (own) return Place::found;
    return known ? Place::kept : are_whole(state.sheets) ? Place::found : Place::told;
}

}  // namespace

CaptureSetup capture_setup(const Studio& studio, const CameraChoice& choice) {
    const CapturePanelState& state = studio.panels.of<CapturePanelState>();
    CaptureSetup setup;
    setup.camera = choice;
    setup.product = studio.product;
    if (const auto monitor = projector_monitor(studio)) {
        setup.projector =
            fmt::format("{} at {}x{}", monitor->name, monitor->width, monitor->height);
        setup.width = monitor->width;
        setup.height = monitor->height;
    }
    const Place place = place_of(studio);
    if (place == Place::kept) setup.projector_view = known_pose(studio);
    if (place == Place::found && are_whole(state.sheets)) setup.data_sheets = state.sheets;
    setup.colour_shots = state.colour_shots;
    setup.places = state.colour_shots >= 4 ? PlaceCode::gray_and_phase : PlaceCode::gray;
    setup.in_use = studio.session.document().calibration;
    Results* results = studio.results.get();
    ProjectorScreen* screen = studio.projector.get();
    setup.projector_port = [results, screen](const Progress& progress, TellWait tell) {
        return show_on({[results](auto picture) { results->show_instead(std::move(picture)); },
                        [screen] { return screen->shown(); }},
                       progress,
                       std::move(tell));
    };
    return setup;
}

namespace {

void choose(Studio& studio, const CameraChoice& choice) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    state.chosen = choice;
    state.selected.reset();
    studio.capture->use(capture_setup(studio, choice));
}

void connect(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    state.address_problem.clear();
    try {
        choose(studio, camera_at_address(state.address));
    } catch (const std::invalid_argument& error) {
        state.address_problem = error.what();
    }
}

void ask_for_folder(Studio& studio) {
    FileQuestion question;
    question.kind = FileQuestion::Kind::folder;
    question.title = "Where will the photographs be copied?";
    question.action = "Choose";
    question.then = [&studio](const std::filesystem::path& folder) {
        choose(studio, {"folder", std::filesystem::absolute(folder).string()});
    };
    studio.file_dialog->ask(std::move(question));
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

void draw_cameras(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    heading("Camera");
    begin_disabled(is_busy(state.view));
    const std::string shown = state.chosen ? text_of(*state.chosen) : "Choose…";
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::BeginCombo("##camera", shown.c_str(), ImGuiComboFlags_HeightLarge)) {
        for (const ListedCamera& camera : state.cameras) {
            if (ImGui::Selectable(camera.name.c_str(), shown == camera.choice))
                choose(studio, parse_camera_choice(camera.choice));
            name_last_item("camera:" + camera.choice);
            if (!camera.problem.empty()) tooltip(camera.problem + "\n" + camera.fix);
        }
        ImGui::Separator();
        if (ImGui::Selectable("Any other: shoot, and copy the photographs into a folder…"))
            ask_for_folder(studio);
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
    if (button("Connect", "camera-connect") || entered) connect(studio);
    end_disabled();
    if (!state.address_problem.empty()) warning_text(sentence(state.address_problem));
    if (!state.problem.empty()) warning_text(state.problem);
    const CaptureView& view = state.view;
    if (view.doing == Doing::opening) dim_text("Being opened…");
    if (view.camera.empty()) return;
    for (const std::string& warning : view.warnings) warning_text(sentence(warning));
}

/// What is seldom needed once the camera is there.
void draw_camera_settings(Studio& studio) {
    const CaptureView& view = studio.panels.of<CapturePanelState>().view;
    if (view.camera.empty()) return;
    heading("Camera's settings");
    dim_text(sentence(view.camera));
    begin_disabled(is_busy(view));
    for (const CameraSetting& setting : view.settings) draw_setting(*studio.capture, setting);
    end_disabled();
    if (!view.curve.empty()) dim_text("Its 8-bit files are read with " + view.curve + ".");
}

/// The five figures that photographs do not tell.
void draw_data_sheets(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
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
    keep_data_sheets(studio.settings, sheets);
    choose(studio, *state.chosen);
}

/// How the projector's place comes to be known.
void draw_place(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    const Place place = place_of(studio);
    begin_disabled(is_busy(state.view));
    const auto offer = [&](Place which, const char* label, const char* item, const char* meaning) {
        if (named(ImGui::RadioButton(label, place == which), item, meaning) && place != which) {
            state.place = which;
            choose(studio, *state.chosen);
        }
    };
    offer(Place::found,
          "find where it stands, from photographs",
          "place-found",
          "Gray code on the mock-up, its mesh, and the data sheets of projector and camera.");
    if (known_pose(studio))
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
            const bool open = named(ImGui::CollapsingHeader("Data sheets"), "data-sheets");
            if (open) draw_data_sheets(studio);
        }
        if (place == Place::found && !are_whole(state.sheets))
            warning_text("All five figures are needed: photographs alone leave sizes open.");
    }
    end_disabled();
}

/// True where there is something to show pictures on.
bool draw_projector(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    heading("Projector");
    if (has_own_projector(*state.chosen)) {
        dim_text("The simulated bench's own.");
        draw_place(studio);
        return true;
    }
    const auto monitor = projector_monitor(studio);
    if (!monitor) {
        warning_text("No projector shows pictures. Choose it in the bar below.");
        return false;
    }
    dim_text(fmt::format("{}, {} × {}.", monitor->name, monitor->width, monitor->height));
    for (const SignalWarning& warning : studio.signal_warnings) {
        coloured_text(colour_of(warning.severity), warning.what);
        name_last_item(fmt::format("capture-signal:{}", name_of(warning.severity)));
        tooltip(warning.cause + "\n" + warning.fix);
        if (warning.severity == SignalWarning::Severity::error) dim_text(warning.fix);
    }
    draw_place(studio);
    return true;
}

}  // namespace

void take_capture(Studio& studio) {
    if (!studio.capture) return;
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    state.view = studio.capture->view();
    // Not when it is closed: the frame that is being drawn then shows them.
    if (!state.open) state.textures.clear();
    const bool busy = is_busy(state.view);
    if (std::exchange(state.was_busy, busy) && !busy) show_instead(studio, {});
}

void show_capture(Studio& studio, bool shown) {
    if (shown) show_panel(studio, "nudge", false);
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    state.open = shown;
    if (shown) {
        state.listed_at_s = -1.0;
        if (!std::exchange(state.sheets_read, true))
            state.sheets = kept_data_sheets(studio.settings);
        if (state.chosen) choose(studio, *state.chosen);
    } else {
        studio.capture->close();
    }
}

void draw_capture_panel(Studio& studio) {
    list_cameras_now_and_then(studio);
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    ImGui::PushFont(large_font());
    ImGui::TextUnformatted("Calibrate");
    ImGui::PopFont();
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - button_width("Close"));
    begin_disabled(is_busy(state.view));
    if (button("Close", "capture-close")) {
        show_capture(studio, false);
        end_disabled();
        return;
    }
    end_disabled();
    dim_text("From cable to corrected picture, step by step.");
    draw_cameras(studio);
    if (!state.chosen) return;
    const bool can_show = draw_projector(studio);
    ImGui::Spacing();
    draw_capture_steps(studio, can_show);
    draw_camera_settings(studio);
}

namespace {

const char* name_of(Doing doing) {
    constexpr std::array names{
        "nothing", "opening", "watching", "preflight", "fitting", "capturing", "checking"};
    return names[static_cast<std::size_t>(doing)];
}

/// What the column tells of a trouble.
std::string words_of(const CapturePanelState& capture) {
    if (!capture.address_problem.empty()) return capture.address_problem;
    return capture.view.why.empty() ? capture.view.wait.why : capture.view.why;
}

void describe_capture(const Studio& studio, MapState& state) {
    const CapturePanelState& panel = studio.panels.of<CapturePanelState>();
    const CaptureView& capture = panel.view;
    state["capture"] = map_text(panel.open ? name_of(capture.doing) : "closed");
    state["capture_paused"] = map_text(capture.paused);
    state["capture_says"] = map_text(words_of(panel));
    MapState preflight, steps;
    for (const GradedFigure& figure : capture.step(CaptureStep::look).figures)
        preflight[figure.name] = map_text(to_string(figure.grade));
    state["preflight"] = map_text(preflight);
    state["capture_stage"] = map_text(capture.stage);
    state["capture_next"] = map_text(next_capture_step(capture));
    for (const auto& [name, step] : named_capture_steps(capture))
        if (step->done) steps[name] = map_text(to_string(grade_of(step->figures).grade));
    state["capture_steps"] = map_text(steps);
    state["capture_drift"] =
        map_text(capture.drift.empty() ? "" : to_string(grade_of(capture.drift).grade));
    state["capture_reposed"] = map_text(capture.reposed ? capture.reposed->string() : "");
    state["capture_times"] = fmt::format(
        "[{:.3f}, {:.3f}, {:.3f}]", capture.capture_s, capture.camera_s, capture.projector_s);
}

bool is_capture_open(const Studio& studio) { return studio.panels.of<CapturePanelState>().open; }

}  // namespace

Panel capture_panel() {
    return {.name = "capture",
            .place = PanelPlace::column,
            .draw = draw_capture_panel,
            .draw_stage = draw_capture_stage,
            .is_open = is_capture_open,
            .show = show_capture,
            .step = take_capture,
            .next_change_s =
                [](const Studio& s) { return is_capture_open(s) ? s.now_s + kProgress_s : 0.0; },
            .holds_picture = is_capture_open,
            .describe = describe_capture,
            .actions =
                [] {
                    return std::vector{
                        panel_action("capture", "capture", "Projector", "Capture with a camera…")};
                }};
}

}  // namespace livery
