#include "studio/report/report_window.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "live/frame_pictures.h"
#include "studio/studio.h"

namespace livery {

namespace {

using Files = std::shared_ptr<const std::vector<ReportFile>>;

ReportWindowState& window_of(const Studio& studio) { return studio.panels.of<ReportWindowState>(); }

template <typename T>
bool is_done(const std::future<T>& future) {
    return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

std::string size_text(std::size_t bytes) {
    const auto size = static_cast<double>(bytes);
    if (bytes < 1000) return fmt::format("{} B", bytes);
    return bytes < 1'000'000 ? fmt::format("{:.1f} kB", 1e-3 * size)
                             : fmt::format("{:.1f} MB", 1e-6 * size);
}

/// On a thread of its own: whatever is stuck elsewhere in the program must not hold it up.
void gather(Studio& studio) {
    ReportWindowState& window = window_of(studio);
    window.saved.clear();
    window.problem.clear();
    window.ticks_changed = window.gathering.valid();
    if (window.ticks_changed) return;
    ReportRequest& request = window.request;
    request.document = std::make_shared<const Document>(studio.session.document());
    request.sent_to_projector = nullptr;
    if (request.with_pictures && studio.frame && studio.frame->pictures) {
        request.sent_to_projector = drive_of(*studio.frame->pictures);
    }
    Progress progress;
    progress.stop = &window.stop;
    window.gathering =
        std::async(std::launch::async, [request, devices = window.devices, progress]() mutable {
            if (!devices) {
                devices = std::make_shared<const std::vector<ReportFile>>(
                    ask_devices(GlDevice::automatic, progress));
            }
            return ReportWindowState::Gathered{
                devices,
                std::make_shared<const std::vector<ReportFile>>(
                    make_problem_report(request, *devices, progress))};
        });
}

void take_results_of(Studio& studio) {
    ReportWindowState& window = window_of(studio);
    if (is_done(window.gathering)) {
        try {
            auto gathered = window.gathering.get();
            window.devices = std::move(gathered.devices);
            window.report = std::move(gathered.report);
        } catch (const std::exception& error) {
            window.problem = error.what();
        }
        if (window.ticks_changed) gather(studio);
    }
    if (is_done(window.saving)) {
        try {
            window.saved = window.saving.get();
        } catch (const std::exception& error) {
            window.problem = error.what();
        }
    }
}

void save(Studio& studio, const std::filesystem::path& file) {
    ReportWindowState& window = window_of(studio);
    if (!window.report || window.saving.valid()) return;
    window.saved.clear();
    window.problem.clear();
    window.saving = std::async(std::launch::async, [file, report = window.report] {
        write_problem_report(file, *report, std::time(nullptr));
        return file;
    });
}

void ask_where_to_save(Studio& studio) {
    studio.file_dialog->ask(
        {.kind = FileQuestion::Kind::save,
         .title = "Save report",
         .action = "Save",
         .suffixes = {".zip"},
         .suggested = documents_folder() / report_name(std::time(nullptr)),
         .then = [&studio](const std::filesystem::path& file) { save(studio, file); }});
}

void draw_ticks(Studio& studio) {
    ReportRequest& request = window_of(studio).request;
    bool changed = false;
    const auto tick = [&](const char* label, const char* name, bool& on, const char* meaning) {
        changed = ImGui::Checkbox(label, &on) || changed;
        name_last_item(name);
        tooltip(meaning);
    };
    tick("This session",
         "report:session",
         request.with_session,
         "Its looks with their paints, lights and artwork, seats, and the names of its files.");
    ImGui::SameLine(0.0f, em(1.6f));
    tick("Pictures",
         "report:pictures",
         request.with_pictures,
         "What the projector is sent now and the calibration's pictures; with the session also "
         "those of its artwork.");
    ImGui::SameLine(0.0f, em(1.6f));
    tick("Votes",
         "report:votes",
         request.with_votes,
         "The ballots of closed rounds, without names and in an order of chance.");
    if (changed) gather(studio);
}

void draw_files(ReportWindowState& window, const ImVec2& size) {
    ImGui::BeginChild("files", size, true, ImGuiWindowFlags_NavFlattened);
    const float right = ImGui::GetContentRegionMax().x;
    for (const ReportFile& file : *window.report) {
        if (ImGui::Selectable(("##" + file.name).c_str(), window.chosen == file.name)) {
            window.chosen = file.name;
        }
        name_last_item("report:file:" + file.name);
        tooltip(file.what);
        const bool whole = file.problem.empty();
        ImGui::SameLine(ImGui::GetStyle().WindowPadding.x);
        ImGui::TextColored(whole ? colours::text : colours::warning, "%s", file.name.c_str());
        const std::string bytes = size_text(file.bytes.size());
        ImGui::SameLine(right - ImGui::CalcTextSize(bytes.c_str()).x);
        ImGui::TextColored(colours::dim_text, "%s", bytes.c_str());
    }
    ImGui::EndChild();
}

void draw_text(const ReportWindowState& window, const ImVec2& size) {
    const auto& files = *window.report;
    const auto found = std::find_if(files.begin(), files.end(), [&](const ReportFile& file) {
        return file.name == window.chosen;
    });
    const ReportFile& file = found == files.end() ? files.front() : *found;
    ImGui::BeginChild(("text of " + file.name).c_str(),
                      size,
                      true,
                      ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NavFlattened);
    if (file.is_text) {
        ImGui::TextUnformatted(file.bytes.data(), file.bytes.data() + file.bytes.size());
    } else {
        dim_text(file.what + " Open the saved archive to look at it.");
    }
    ImGui::EndChild();
    name_last_item("report:text");
}

void draw_end(Studio& studio) {
    ReportWindowState& window = window_of(studio);
    begin_disabled(!window.report || window.gathering.valid() || window.saving.valid());
    if (ImGui::Button("Save report…", {em(9.0f), 0.0f})) ask_where_to_save(studio);
    end_disabled();
    name_last_item("report:save");
    ImGui::SameLine();
    if (!window.saved.empty()) {
        if (button("Open folder", "report:open-folder", "", em(8.0f)) &&
            !open_folder(window.saved.parent_path())) {
            window.problem = "No file manager is found (xdg-open); the archive lies in " +
                             window.saved.parent_path().string() + ".";
        }
        ImGui::SameLine();
    }
    ImGui::AlignTextToFramePadding();
    if (!window.problem.empty()) {
        warning_text(window.problem);
    } else if (window.gathering.valid()) {
        dim_text(window.devices ? "Gathering…" : "Asking OpenGL, monitors and cameras…");
    } else if (window.saving.valid()) {
        dim_text("Saving…");
    } else if (!window.saved.empty()) {
        dim_text("Saved as " + window.saved.string() + ". Nothing was sent.");
        name_last_item("report:saved");
    }
}

void draw_inside(Studio& studio) {
    ReportWindowState& window = window_of(studio);
    dim_text(
        "One archive that helps somebody else to find out what went wrong here. Read it before you "
        "send it to them: Livery itself sends nothing. Your home folder, your name and the "
        "machine's are replaced; everything that goes in is listed here.");
    ImGui::Dummy({0.0f, em(0.2f)});
    row_label("Only if you tick it", 0.2f);
    draw_ticks(studio);
    ImGui::Dummy({0.0f, em(0.2f)});
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float height = room.y - ImGui::GetFrameHeight() - 2.0f * ImGui::GetStyle().ItemSpacing.y;
    if (window.report) {
        draw_files(window, {std::floor(0.34f * room.x), height});
        ImGui::SameLine();
        draw_text(window, {0.0f, height});
    } else {
        ImGui::Dummy({0.0f, height});
    }
    draw_end(studio);
}

}  // namespace

void show_report_window(Studio& studio, bool open) {
    ReportWindowState& window = window_of(studio);
    window.open = open;
    if (!open) return;
    window.request = {};
    window.request.drawn_with = studio.drawn_with;
    window.devices = nullptr;
    window.report = nullptr;
    window.chosen = "README.txt";
    gather(studio);
}

bool is_gathering_report(const Studio& studio) {
    const ReportWindowState& window = window_of(studio);
    return window.gathering.valid() || window.saving.valid();
}

const char* state_of_report(const Studio& studio) {
    const ReportWindowState& window = window_of(studio);
    if (!window.open) return "closed";
    if (window.gathering.valid()) return "gathering";
    if (window.saving.valid()) return "saving";
    return window.saved.empty() ? "ready" : "saved";
}

void draw_report_window(Studio& studio) {
    ReportWindowState& window = window_of(studio);
    take_results_of(studio);
    if (!window.open) return;
    if (begin_page("Report a problem", window.open, {em(64.0f), em(42.0f)})) draw_inside(studio);
    ImGui::End();
}

Panel report_panel() {
    return {
        .name = "report",
        .place = PanelPlace::page,
        .draw = draw_report_window,
        .is_open = [](const Studio& s) { return window_of(s).open; },
        .show = show_report_window,
        .esc_closes = true,
        .next_change_s =
            [](const Studio& s) { return is_gathering_report(s) ? s.now_s + kProgress_s : 0.0; },
        .describe = [](const Studio& s,
                       MapState& state) { state["report"] = map_text(state_of_report(s)); },
        .actions =
            [] {
                return std::vector{line_above(
                    panel_action("report-problem", "report", "Help", "Report a problem…"))};
            }};
}

}  // namespace livery
