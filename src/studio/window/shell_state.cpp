#include "studio/window/shell_state.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "core/json.h"
#include "core/paths.h"
#include "studio/artwork/artwork_edit.h"
#include "studio/capture/capture_panel.h"
#include "studio/kit/tab_order.h"
#include "studio/nudge/nudge_panel.h"
#include "studio/presenting/presenting.h"
#include "studio/projector_control.h"
#include "studio/report/report_window.h"
#include "studio/seats/seat_maps.h"
#include "studio/seats/seats_panel.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

constexpr double kLayoutRest_s = 1.0;

constexpr double kBetweenSavings_s = 2.0;
constexpr const char* kNotSaved = "What you do is not being saved at the moment.";

void tell_saved_again(Studio& studio) {
    std::erase_if(studio.notices, [](const Notice& n) { return n.what == kNotSaved; });
    notify(studio, {Notice::Level::info, "Everything is saved again.", "", ""});
}

const char* name_of(StageView view) {
    switch (view) {
        case StageView::preview:
            return "preview";
        case StageView::eye:
            return "eye";
        case StageView::projector:
            return "projector";
        case StageView::photograph:
            return "photograph";
    }
    return "preview";
}

const char* name_of(ProjectorScreen::State state) {
    switch (state) {
        case ProjectorScreen::State::off:
            return "off";
        case ProjectorScreen::State::waiting_for_monitor:
            return "waiting";
        case ProjectorScreen::State::showing:
            return "showing";
    }
    return "off";
}

const char* name_of(NewSession::Stage stage) {
    switch (stage) {
        case NewSession::Stage::reading:
            return "reading";
        case NewSession::Stage::unreadable:
            return "unreadable";
        case NewSession::Stage::asking:
            return "asking";
        case NewSession::Stage::creating:
            return "creating";
    }
    return "reading";
}

const char* name_of(CaptureView::Doing doing) {
    switch (doing) {
        case CaptureView::Doing::nothing:
            return "nothing";
        case CaptureView::Doing::opening:
            return "opening";
        case CaptureView::Doing::watching:
            return "watching";
        case CaptureView::Doing::preflight:
            return "preflight";
        case CaptureView::Doing::fitting:
            return "fitting";
        case CaptureView::Doing::capturing:
            return "capturing";
        case CaptureView::Doing::checking:
            return "checking";
    }
    return "nothing";
}

/// What the capture's column tells of a trouble.
std::string words_of(const CapturePanelState& capture) {
    if (!capture.address_problem.empty()) return capture.address_problem;
    return capture.view.why.empty() ? capture.view.wait.why : capture.view.why;
}

const std::string* find(const Workspace& workspace, const std::string& name) {
    const auto found = workspace.find(name);
    return found == workspace.end() ? nullptr : &found->second;
}

/// A remembered number; what cannot be read is as if it had not been remembered.
template <typename Number>
void restore(const Workspace& workspace, const char* name, Number& value, Number low, Number high) {
    const std::string* text = find(workspace, name);
    if (!text) return;
    Number read{};
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), read);
    if (error == std::errc() && read >= low && read <= high) value = read;
}

void remember(Session& session, const char* name, const std::string& value) {
    const std::string* known = find(session.workspace(), name);
    if (!known || *known != value) session.set_workspace(name, value);
}

std::string text(bool value) { return value ? "true" : "false"; }
std::string text(const std::optional<int>& value) {
    return value ? std::to_string(*value) : "null";
}
std::string quoted(const std::string& value) { return Json(value).dump(); }

}  // namespace

void restore_workspace(Shell& shell) {
    Studio& studio = shell.studio;
    const Workspace& workspace = studio.session.workspace();
    restore(workspace, "shown-look", studio.shown_look, 0, 1 << 30);
    restore(workspace, "scale", shell.user_scale, 0.75, 3.0);
    restore(workspace, "left-width", shell.left_width_em, 11.0f, 30.0f);
    restore(workspace, "right-width", shell.right_width_em, 17.0f, 40.0f);
    // A new session has the projector that the one before had.
    const std::string* monitor = find(workspace, kMonitorKey);
    shell.projector_monitor = monitor ? *monitor : setting(studio.settings, kProjectorSetting);
    if (const std::string* view = find(workspace, "view")) {
        for (const auto v :
             {StageView::preview, StageView::eye, StageView::projector, StageView::photograph}) {
            if (*view == name_of(v)) studio.view = v;
        }
    }
}

void remember_workspace(Shell& shell, const std::string& window_place, bool now) {
    Session& session = shell.studio.session;
    remember(session, "shown-look", std::to_string(shell.studio.shown_look));
    remember(session, "view", name_of(shell.studio.view));
    const std::string layout =
        fmt::format("{} {:.2f} {:.2f}", window_place, shell.left_width_em, shell.right_width_em);
    if (layout != shell.layout_seen) {
        shell.layout_seen = layout;
        shell.layout_rests_at_s = shell.studio.now_s + kLayoutRest_s;
    }
    const bool rests =
        shell.layout_rests_at_s > 0.0 && shell.studio.now_s >= shell.layout_rests_at_s;
    if (!rests && !now) return;
    shell.layout_rests_at_s = 0.0;
    remember(session, "left-width", fmt::format("{:.2f}", shell.left_width_em));
    remember(session, "right-width", fmt::format("{:.2f}", shell.right_width_em));
    remember(session, kWindowKey, window_place);
}

MapState state_of_shell(const Shell& shell) {
    const Studio& studio = shell.studio;
    const Session& session = studio.session;
    const ShownPicture shown = studio.projector->shown();
    MapState state;
    state["black"] = text(shell.black);
    state["frozen"] = text(shell.frozen);
    state["view"] = quoted(name_of(studio.view));
    state["shown_look"] = std::to_string(studio.shown_look);
    state["compared_look"] = text(studio.compared_look);
    state["showing_b"] = text(studio.showing_b);
    state["wiping"] = text(studio.wiping);
    state["wipe_at"] = fmt::format("{:.4f}", studio.wipe_at);
    state["selected_part"] = text(studio.selected_part);
    state["glowing_part"] = text(studio.glowing_part);
    state["tried"] = studio.tried ? text_of(*studio.tried) : "null";
    // As the command that would make it: what is kept, not what is being tried.
    state["artwork"] = text_of(SetArtwork{studio.shown_look, shown_artwork(studio)});
    state["placing"] = text(is_placing(studio));
    state["revision"] = std::to_string(session.revision());
    state["focused"] = quoted(focused_item());
    state["open_tab"] = std::to_string(shell.open_tab);
    state["looks"] = std::to_string(session.document().looks.size());
    state["undo"] = session.can_undo() ? quoted(session.undo_label()) : "null";
    state["redo"] = session.can_redo() ? quoted(session.redo_label()) : "null";
    state["calibration"] = quoted(session.document().calibration);
    state["saved"] = text(!session.save_problem() && session.file());
    state["asked_number"] = std::to_string(shell.frame_number);
    state["finished_number"] = std::to_string(studio.frame ? studio.frame->number : 0);
    state["quality"] = quoted(studio.frame ? to_string(studio.frame->plan.quality) : "");
    state["unfinished"] = quoted(studio.frame ? studio.frame->unfinished : "");
    state["shown_number"] = std::to_string(shown.number);
    state["shown_frames"] = std::to_string(shown.frames);
    state["photograph_number"] = std::to_string(studio.photograph ? studio.photograph->number : 0);
    state["preview_number"] = std::to_string(studio.preview ? studio.preview->number : 0);
    state["projector"] = quoted(name_of(studio.projector->state()));
    state["projector_says"] = quoted(projector_words(projector_facts(shell)).text);
    state["projector_monitor"] = quoted(shell.projector_monitor);
    state["monitors"] = std::to_string(studio.monitors.size());
    state["signal_warnings"] = std::to_string(count_of_warnings(shell.signal_warnings));
    state["signal_severity"] = quoted(
        shell.signal_warnings.empty() ? "" : name_of(shell.signal_warnings.front().severity));
    Json signal = Json::array();
    for (const SignalWarning& warning : shell.signal_warnings) {
        signal.push_back(warning.what + " " + warning.cause + " " + warning.fix);
    }
    state["signal_says"] = signal.dump();
    state["calibrating"] = text(studio.bench->calibrating().running);
    state["solving"] = text(studio.frames->solving().has_value());
    state["busy"] = text(studio.background->is_busy());
    state["session"] = quoted(session.file().value_or("").string());
    state["new_session"] = quoted(shell.new_session ? name_of(shell.new_session->stage) : "closed");
    state["new_session_pictured"] =
        text(shell.new_session != nullptr && shell.new_session->picture.name() != 0);
    state["new_session_says"] = quoted(shell.new_session ? shell.new_session->problem : "");
    state["question"] = quoted(shell.question ? shell.question->what : "");
    state["capture"] =
        quoted(shell.capture_open ? name_of(studio.panels.capture->view.doing) : "closed");
    state["nudge"] = quoted(shell.nudge_open ? in_words(nudged_so_far(shell)) : "closed");
    state["nudge_drawn"] = text(studio.panels.nudge->drawn &&
                                *studio.panels.nudge->drawn == studio.panels.nudge->view);
    state["seats"] = text_of(SetSeats{session.document().seats});
    state["eye_of"] = text_of(UseEye{session.document().eye_choice});
    state["selected_seat"] = std::to_string(studio.panels.seats->selected);
    state["seat_errors"] = text(seat_errors_found(studio));
    state["seat_map"] = text(seat_map_size(studio).x > 0 && shows_seat_map(studio));
    state["report"] = quoted(state_of_report(studio));
    state["capture_paused"] = studio.panels.capture->view.paused ? "true" : "false";
    state["capture_says"] = quoted(words_of(*studio.panels.capture));
    Json preflight = Json::object();
    for (const GradedFigure& figure : studio.panels.capture->view.step(CaptureStep::look).figures)
        preflight[figure.name] = to_string(figure.grade);
    state["preflight"] = preflight.dump();
    const CaptureView& capture = studio.panels.capture->view;
    state["capture_stage"] = quoted(capture.stage);
    state["capture_next"] = quoted(next_capture_step(capture));
    Json steps = Json::object();
    for (const auto& [name, step] : named_capture_steps(capture))
        if (step->done) steps[name] = to_string(grade_of(step->figures).grade);
    state["capture_steps"] = steps.dump();
    state["capture_drift"] =
        quoted(capture.drift.empty() ? "" : to_string(grade_of(capture.drift).grade));
    state["capture_reposed"] = quoted(capture.reposed ? capture.reposed->string() : "");
    state["capture_times"] = fmt::format(
        "[{:.3f}, {:.3f}, {:.3f}]", capture.capture_s, capture.camera_s, capture.projector_s);
    const PresentingState& vote = presenting(studio);
    state["vote"] = quoted(vote.freezing ? "freezing" : to_string(phase_of(studio)));
    state["vote_code"] = text(code_on_show(studio));
    if (vote.presented) {
        const PresentedRound& presented = *vote.presented;
        state["vote_frame"] = quoted(frame_of(presented.plan, presented.state));
        state["vote_paused"] = text(presented.state.paused);
        state["vote_blank"] = text(presented.state.blank);
        state["vote_place"] = std::to_string(presented.state.place);
        state["vote_round"] = std::to_string(presented.round.id);
        state["vote_loaded"] = text(!presented.frames.empty());
    }
    state["phones"] =
        quoted(vote.phones && vote.phones->place() ? url_of(*vote.phones->place()) : "");
    state["action"] = quoted(shell.last_action);
    state["actions"] = std::to_string(shell.actions_run);
    state["dialog"] = text(ImGui::GetTopMostPopupModal() != nullptr);
    state["scale"] = fmt::format("{:.3f}", studio.ui_scale);
    Json notices = Json::array();
    for (const Notice& notice : studio.notices) notices.push_back(notice.what);
    state["notices"] = notices.dump();
    return state;
}

void open_ballots(Shell& shell) {
    try {
        const auto folder = user_folder();
        make_output_folder(folder);
        shell.studio.ballots = std::make_unique<BallotStore>(folder / "ballots.sqlite");
    } catch (const std::exception& error) {
        notify(shell.studio, {Notice::Level::warning, "Ballots cannot be kept.", error.what(), ""});
    }
}

void save_again_now_and_then(Shell& shell) {
    Studio& studio = shell.studio;
    if (!studio.session.save_problem() || !studio.session.file()) {
        // The next change may have saved everything.
        if (std::exchange(shell.save_again_at_s, 0.0) > 0.0) tell_saved_again(studio);
        return;
    }
    if (shell.save_again_at_s <= 0.0) {
        shell.save_again_at_s = studio.now_s + kBetweenSavings_s;
        notify(studio,
               {Notice::Level::error,
                kNotSaved,
                *studio.session.save_problem(),
                "Make room on the disk: saving then goes on by itself. File > Save session as… "
                "saves it elsewhere."});
    } else if (studio.now_s >= shell.save_again_at_s) {
        shell.save_again_at_s = studio.now_s + kBetweenSavings_s;
        studio.session.save_again();
    }
}

void tell_unsaved(Shell& shell) {
    if (shell.studio.session.file()) return;
    notify(shell.studio,
           {Notice::Level::error,
            "Nothing that you do is being saved.",
            shell.studio.session.save_problem().value_or(""),
            "File > Save session as… saves it elsewhere, with all that was done."});
}

}  // namespace livery
