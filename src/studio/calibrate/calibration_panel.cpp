// Which calibration corrects the picture, how good it is, and how to get another.
#include "studio/calibrate/calibration_panel.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "core/paths.h"
#include "jobs/calibrate/calibration_check.h"
#include "jobs/calibrate/calibration_folder.h"
#include "studio/studio.h"

namespace livery {

namespace {

constexpr double kBetweenCalibrations_s = 2.0;

void list_what_there_is(Studio& studio) {
    CalibrationPanelState& state = studio.panels.of<CalibrationPanelState>();
    const bool recently =
        state.listed_at_s >= 0.0 && studio.now_s - state.listed_at_s < kBetweenCalibrations_s;
    if (recently) return;
    state.listed_at_s = studio.now_s;
    state.list_problem.clear();
    try {
        state.kept = kept_calibrations();
        if (state.benches.empty()) {
            for (const auto& entry : list_folder(shipped_path("calibration"), {".json"}, false)) {
                if (entry.is_folder) continue;
                state.benches.push_back(std::filesystem::path(entry.name).stem().string());
            }
        }
    } catch (const FileError& error) {
        state.list_problem = error.what();
    }
}

/// "20261121T085500Z-3f2a" or whatever the folder is called, and the shipped or loaded ones.
std::string short_name(const std::filesystem::path& folder) {
    const auto name =
        folder.filename().empty() ? folder.parent_path().filename() : folder.filename();
    return name.string();
}

bool same_folder(const std::filesystem::path& a, const std::filesystem::path& b) {
    return a.lexically_normal() == b.lexically_normal();
}

void fact(const char* label, const std::string& value, const std::string& whole = "") {
    const float left = ImGui::GetCursorPosX();
    dim_text(label);
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + std::floor(0.28f * ImGui::GetWindowContentRegionMax().x));
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(value.c_str());
    ImGui::PopTextWrapPos();
    if (!whole.empty()) tooltip(whole);
}

}  // namespace

const ImVec4& colour_of(Grade grade) {
    return grade == Grade::good     ? colours::good
           : grade == Grade::usable ? colours::warning
                                    : colours::error;
}

void draw_figures(const std::vector<GradedFigure>& figures) {
    for (const GradedFigure& figure : figures) {
        ImGui::PushID(figure.name.c_str());
        ImGui::TextUnformatted(figure.name.c_str());
        std::string meaning = figure.meaning;
        if (!figure.scale.empty()) meaning += fmt::format("\nScale: {}.", figure.scale);
        if (figure.grade != Grade::good) meaning += "\n" + figure.fix;
        tooltip(meaning);
        const std::string mark = figure.scale.empty()
                                     ? figure.value
                                     : fmt::format("{}  {}", figure.value, to_string(figure.grade));
        const float width = ImGui::CalcTextSize(mark.c_str()).x;
        ImGui::SameLine();
        ImGui::SetCursorPosX(
            std::max(ImGui::GetCursorPosX(), ImGui::GetWindowContentRegionMax().x - width));
        ImGui::TextColored(
            figure.scale.empty() ? colours::text : colour_of(figure.grade), "%s", mark.c_str());
        tooltip(meaning);
        ImGui::PopID();
    }
}

namespace {

void draw_calibration_in_use(const ColourCalibration& calibration, bool other_product) {
    const auto figures = grade_figures(calibration);
    const OverallGrade grade = grade_of(figures);
    ImGui::PushFont(large_font());
    ImGui::TextColored(other_product ? colours::error : colour_of(grade.grade),
                       "%s",
                       other_product ? "Another product's" : to_string(grade.grade).c_str());
    ImGui::PopFont();
    name_last_item("calibration-grade");
    dim_text(other_product                ? "The figures below are of that product's mock-up."
             : grade.grade == Grade::good ? "Every figure is within its good range."
                                          : fmt::format("{}. {}", grade.reason, grade.fix));
    fact("Made",
         readable_time(calibration.created) + " · " + calibration.id.substr(0, 8),
         calibration.id);
    fact("With", calibration.made_with);
    fact("Mode", calibration.mode);
    fact("Colours", calibration.xyz_origin);
    ImGui::Spacing();
    draw_figures(figures);
    for (const std::string& warning : calibration.warnings) warning_text(sentence(warning));
}

/// "HDMI-1 at 1920x1080", as a capture has it; empty: pictures reach no monitor.
std::string projector_in_words(const Studio& studio) {
    if (!studio.projector || studio.projector->state() != ProjectorScreen::State::showing)
        return "";
    const auto monitor = find_monitor(studio.monitors, setting(studio.settings, kProjectorSetting));
    return monitor ? fmt::format("{} at {}x{}", monitor->name, monitor->width, monitor->height)
                   : "";
}

/// Whether it was made for another mesh or another projector than there are now; looked at again
/// when one of them has changed.
void look_for_changes(const Studio& studio) {
    CalibrationPanelState& state = studio.panels.of<CalibrationPanelState>();
    const std::string projector = projector_in_words(studio);
    if (state.stale_setup == studio.setup && state.stale_product == studio.product &&
        state.stale_projector == projector) {
        return;
    }
    state.stale_setup = studio.setup;
    state.stale_product = studio.product;
    state.stale_projector = projector;
    state.stale.clear();
    if (!studio.setup || !studio.setup->origin || !studio.product) return;
    state.stale = what_changed(*studio.setup->origin, *studio.product, projector);
}

void draw_what_changed(const Studio& studio) {
    for (const std::string& change : studio.panels.of<CalibrationPanelState>().stale) {
        coloured_text(studio.other_product.empty() ? colours::warning : colours::error,
                      sentence(change));
        name_last_item("calibration-stale");
    }
}

void draw_in_use(Studio& studio) {
    heading("In use");
    if (!studio.setup) {
        dim_text("Being loaded…");
        return;
    }
    if (studio.setup->table && studio.setup->calibration) {
        look_for_changes(studio);
        draw_what_changed(studio);
        draw_calibration_in_use(*studio.setup->calibration, !studio.other_product.empty());
        return;
    }
    ImGui::PushFont(large_font());
    ImGui::TextColored(colours::warning, "Uncorrected");
    ImGui::PopFont();
    name_last_item("uncorrected");
    dim_text(studio.setup->why_uncorrected.empty()
                 ? "The picture goes out as plain sRGB: colours on the mock-up are not right."
                 : sentence(studio.setup->why_uncorrected));
    dim_text("Calibrate below, or load a calibration.");
}

void draw_design_white(Studio& studio) {
    Held<double>& held = studio.panels.of<CalibrationPanelState>().held_percentile;
    double& percentile = held.start(studio.session.document().design_white_percentile);
    row_label("Design white");
    number_slider("##design-white", percentile, 0.0, 100.0, "%.0f %%");
    held.after_item();
    name_last_item("design-white");
    // Not tried while it is dragged: every value bakes the correction anew.
    if (ImGui::IsItemDeactivatedAfterEdit() && !studio.gave_up) {
        commit(studio, SetDesignWhite{percentile});
    }
    tooltip(
        "The brightest neutral that the looks are scaled to. At 20 %, four fifths of the "
        "mock-up's pixels can show it; lower is safer and darker, higher is brighter and clips "
        "more.");
    held.finish();
    if (studio.setup && studio.setup->table) {
        dim_text(fmt::format("Brightest neutral for {:.0f} % of the pixels: Y = {:.4g}.",
                             100.0 - studio.session.document().design_white_percentile,
                             studio.setup->design_white_y));
    }
}

void draw_gamut_mapping(Studio& studio) {
    bool keeps_hue = studio.session.document().gamut_mapping == GamutMapping::preserve;
    row_label("Out of reach");
    if (ImGui::Checkbox("keep the hue", &keeps_hue)) {
        commit(studio, SetGamutMapping{keeps_hue ? GamutMapping::preserve : GamutMapping::strict});
    }
    name_last_item("keep-hue");
    tooltip(
        "What becomes of colours that the mock-up cannot show, in every look alike. Off: whatever "
        "can be shown is exact, the rest is cut off and may change its hue. On: the hue stays, and "
        "chroma gives way first; colours near the end of what can be shown make room.");
}

void draw_bench_choice(Studio& studio, bool calibrating) {
    CalibrationPanelState& state = studio.panels.of<CalibrationPanelState>();
    const std::string& bench = studio.session.document().bench;
    begin_disabled(calibrating);
    row_label("Bench");
    if (ImGui::BeginCombo("##bench", short_name(bench).c_str())) {
        for (const std::string& name : state.benches) {
            if (ImGui::Selectable(name.c_str(), name == bench) && name != bench) {
                commit(studio, SetBench{name});
            }
            name_last_item("bench:" + name);
        }
        if (named(ImGui::Selectable("File…"), "bench:file") && studio.file_dialog) {
            studio.file_dialog->ask({.title = "Open a bench",
                                     .action = "Open",
                                     .suffixes = {".json"},
                                     .then = [&studio](const std::filesystem::path& file) {
                                         commit(studio,
                                                SetBench{std::filesystem::absolute(file).string()});
                                     }});
        }
        ImGui::EndCombo();
    }
    name_last_item("bench");
    tooltip("The simulated projector, camera, room and mock-up: " + bench);
    end_disabled();
}

void draw_calibrating(Studio& studio) {
    heading("Calibrate");
    CalibrationPanelState& state = studio.panels.of<CalibrationPanelState>();
    const auto calibrating =
        studio.bench ? studio.bench->calibrating() : BenchThread::Calibrating{};
    draw_bench_choice(studio, calibrating.running);
    if (calibrating.running) {
        progress_bar(calibrating.fraction, fmt::format("{:.0f} %", 100.0 * calibrating.fraction));
        name_last_item("calibration-progress");
        dim_text("Of this step: " + calibrating.stage + ".");
        if (button(
                "Cancel", "cancel-calibration", "The calibration in use stays as it is.", -FLT_MIN))
            studio.bench->cancel_calibration();
        return;
    }
    begin_disabled(!studio.bench);
    if (named(ImGui::Button("Calibrate on the simulated bench", {-FLT_MIN, 0.0f}),
              "calibrate",
              "Shows the patterns on the bench, photographs them and solves. The picture on the "
              "mock-up stays; the calibrations before are kept.")) {
        state.dismissed = false;
        studio.bench->start_calibration();
    }
    end_disabled();
    if (ImGui::Button("Capture with a camera…", {-FLT_MIN, 0.0f})) show_panel(studio, "capture");
    name_last_item("open-capture");
    tooltip("A camera of your own, or the simulated bench step by step.");
    begin_disabled(!studio.setup || !studio.setup->calibration);
    if (ImGui::Button("Move the mock-up by hand…", {-FLT_MIN, 0.0f})) show_panel(studio, "nudge");
    name_last_item("open-nudge");
    tooltip("Where its lines lie beside it: by arrow keys, on the mock-up itself.");
    end_disabled();
    if (!calibrating.refused_why.empty() && !state.dismissed) {
        warning_text(sentence("refused: " + calibrating.refused_why));
        name_last_item("calibration-refused");
        if (!calibrating.refused_fix.empty())
            dim_text(sentence("what helps: " + calibrating.refused_fix));
        dim_text("The calibration before stays in use.");
        if (button("Dismiss", "dismiss-refusal")) state.dismissed = true;
    }
}

/// `livery calibrate color` knows the projector only when it is told: without it nothing can be
/// drawn, so it is asked for, once for the folder.
void ask_for_projector(Studio& studio, const std::filesystem::path& folder) {
    FileQuestion question;
    question.title = "Where does the projector of this calibration stand?";
    question.action = "Use";
    question.suffixes = {".json"};
    question.suggested = folder;
    question.choices = [](FileQuestion&) {
        dim_text(
            "The folder has no projector.json. Choose the projector's camera file: its lens and "
            "its pose in front of the mock-up. A copy is kept with the calibration.");
    };
    question.then = [&studio, folder](const std::filesystem::path& camera_file) {
        in_background(studio,
                      "The calibration was not loaded.",
                      [&studio, folder, camera_file](const Progress&) -> Background::Then {
                          add_projector(folder, camera_file);
                          return [&studio, folder] {
                              commit(studio, SetCalibration{folder.string()});
                          };
                      });
    };
    studio.file_dialog->ask(std::move(question));
}

}  // namespace

void load_calibration(Studio& studio, const std::filesystem::path& folder) {
    std::error_code error;
    // What is no calibration at all is named by the command.
    const bool lacks_projector =
        std::filesystem::is_regular_file(folder / "calibration.json", error) &&
        !std::filesystem::exists(folder / "projector.json", error);
    if (lacks_projector) {
        ask_for_projector(studio, folder);
    } else {
        commit(studio, SetCalibration{folder.string()});
    }
}

namespace {

void draw_kept(Studio& studio) {
    heading("Go back to");
    CalibrationPanelState& state = studio.panels.of<CalibrationPanelState>();
    const std::filesystem::path in_use = studio.session.document().calibration;
    if (!state.list_problem.empty()) warning_text(state.list_problem);
    const auto offer = [&](const std::string& label,
                           const std::filesystem::path& folder,
                           const std::string& meaning) {
        const bool on = folder.empty() ? in_use.empty() : same_folder(folder, in_use);
        const std::string shown = (on ? "● " : "○ ") + label;
        if (ImGui::Selectable(shown.c_str(), on) && !on) {
            commit(studio, SetCalibration{folder.string()});
        }
        name_last_item("calibration:" + (folder.empty() ? "none" : short_name(folder)));
        tooltip(meaning);
    };
    bool listed = in_use.empty();
    for (const auto& folder : state.kept) {
        offer(readable_calibration(short_name(folder)), folder, folder.string());
        listed = listed || same_folder(folder, in_use);
    }
    if (!listed) offer(readable_calibration(short_name(in_use)), in_use, in_use.string());
    offer("None: uncorrected", {}, "The picture goes out as plain sRGB.");
    if (button("Load calibration folder…", "load-calibration") && studio.file_dialog) {
        studio.file_dialog->ask({.kind = FileQuestion::Kind::folder,
                                 .title = "Load a calibration",
                                 .action = "Load",
                                 .then = [&studio](const std::filesystem::path& folder) {
                                     load_calibration(studio, std::filesystem::absolute(folder));
                                 }});
    }
}

}  // namespace

void draw_calibration_panel(Studio& studio) {
    list_what_there_is(studio);
    draw_in_use(studio);
    draw_design_white(studio);
    draw_gamut_mapping(studio);
    ImGui::Spacing();
    draw_calibrating(studio);
    ImGui::Spacing();
    draw_kept(studio);
}

}  // namespace livery
