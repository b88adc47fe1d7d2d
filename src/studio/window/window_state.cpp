#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "core/json.h"
#include "studio/studio.h"
#include "studio/window/layout.h"

namespace livery {

namespace {

constexpr double kLayoutRest_s = 1.0;

constexpr double kBetweenSavings_s = 2.0;
constexpr const char* kNotSaved = "What you do is not being saved at the moment.";

void tell_saved_again(Studio& studio) {
    std::erase_if(studio.notices, [](const Notice& n) { return n.what == kNotSaved; });
    tell_info(studio, "Everything is saved again.");
}

const char* name_of(StageView view) {
    constexpr std::array names{"preview", "eye", "projector", "photograph"};
    return names[static_cast<std::size_t>(view)];
}

const char* name_of(ProjectorScreen::State state) {
    constexpr std::array names{"off", "waiting", "showing"};
    return names[static_cast<std::size_t>(state)];
}

const std::string* find(const Workspace& workspace, const std::string& name) {
    const auto found = workspace.find(name);
    return found == workspace.end() ? nullptr : &found->second;
}

template <typename Number>
void restore(const Workspace& workspace, const char* name, Number& value, Number low, Number high) {
    if (const std::string* text = find(workspace, name)) livery::restore(*text, value, low, high);
}

void remember(Session& session, const char* name, const std::string& value) {
    const std::string* known = find(session.workspace(), name);
    if (!known || *known != value) session.set_workspace(name, value);
}

}  // namespace

void restore_workspace(Studio& studio) {
    const Workspace& workspace = studio.session.workspace();
    restore(workspace, "shown-look", studio.shown_look, 0, 1 << 30);
    restore(workspace, "scale", studio.user_scale, 0.75, 3.0);
    restore(workspace, "left-width", studio.left_width_em, 11.0f, 30.0f);
    restore(workspace, "right-width", studio.right_width_em, 17.0f, 40.0f);
    // A new session has the projector that the one before had.
    const std::string* monitor = find(workspace, kMonitorKey);
    studio.projector_monitor = monitor ? *monitor : setting(studio.settings, kProjectorSetting);
    if (const std::string* view = find(workspace, "view")) {
        for (const auto v :
             {StageView::preview, StageView::eye, StageView::projector, StageView::photograph}) {
            if (*view == name_of(v)) studio.view = v;
        }
    }
}

void remember_workspace(Studio& studio, const std::string& window_place, bool now) {
    Session& session = studio.session;
    remember(session, "shown-look", std::to_string(studio.shown_look));
    remember(session, "view", name_of(studio.view));
    const std::string layout =
        fmt::format("{} {:.2f} {:.2f}", window_place, studio.left_width_em, studio.right_width_em);
    if (layout != studio.layout_seen) {
        studio.layout_seen = layout;
        studio.layout_rests_at_s = studio.now_s + kLayoutRest_s;
    }
    const bool rests = studio.layout_rests_at_s > 0.0 && studio.now_s >= studio.layout_rests_at_s;
    if (!rests && !now) return;
    studio.layout_rests_at_s = 0.0;
    remember(session, "left-width", fmt::format("{:.2f}", studio.left_width_em));
    remember(session, "right-width", fmt::format("{:.2f}", studio.right_width_em));
    remember(session, kWindowKey, window_place);
}

MapState state_of_window(const Studio& studio) {
    const Session& session = studio.session;
    const ShownPicture shown = studio.projector->shown();
    MapState state;
    state["black"] = map_text(studio.black);
    state["frozen"] = map_text(studio.frozen);
    state["view"] = map_text(name_of(studio.view));
    state["shown_look"] = std::to_string(studio.shown_look);
    state["compared_look"] = map_text(studio.compared_look);
    state["showing_b"] = map_text(studio.showing_b);
    state["wiping"] = map_text(studio.wiping);
    state["wipe_at"] = fmt::format("{:.4f}", studio.wipe_at);
    state["selected_part"] = map_text(studio.selected_part);
    state["glowing_part"] = map_text(studio.glowing_part);
    state["tried"] = studio.tried ? text_of(*studio.tried) : "null";
    state["revision"] = std::to_string(session.revision());
    state["focused"] = map_text(focused_item());
    state["looks"] = std::to_string(session.document().looks.size());
    state["undo"] = session.can_undo() ? map_text(session.undo_label()) : "null";
    state["redo"] = session.can_redo() ? map_text(session.redo_label()) : "null";
    state["saved"] = map_text(!session.save_problem() && session.file());
    state["asked_number"] = std::to_string(studio.frame_number);
    state["finished_number"] = std::to_string(studio.frame ? studio.frame->number : 0);
    state["quality"] = map_text(studio.frame ? to_string(studio.frame->plan.quality) : "");
    state["unfinished"] = map_text(studio.frame ? studio.frame->unfinished : "");
    state["shown_number"] = std::to_string(shown.number);
    state["shown_frames"] = std::to_string(shown.frames);
    state["photograph_number"] = std::to_string(studio.photograph ? studio.photograph->number : 0);
    state["preview_number"] = std::to_string(studio.preview ? studio.preview->number : 0);
    state["projector"] = map_text(name_of(studio.projector->state()));
    state["projector_says"] = map_text(projector_words(projector_facts(studio)).text);
    state["projector_monitor"] = map_text(studio.projector_monitor);
    state["monitors"] = std::to_string(studio.monitors.size());
    state["signal_warnings"] = std::to_string(count_of_warnings(studio.signal_warnings));
    state["signal_severity"] = map_text(
        studio.signal_warnings.empty() ? "" : name_of(studio.signal_warnings.front().severity));
    Json signal = Json::array();
    for (const SignalWarning& warning : studio.signal_warnings) {
        signal.push_back(warning.what + " " + warning.cause + " " + warning.fix);
    }
    state["signal_says"] = signal.dump();
    state["solving"] = map_text(studio.frames->solving().has_value());
    state["busy"] = map_text(studio.background->is_busy());
    state["session"] = map_text(session.file().value_or("").string());
    state["question"] = map_text(studio.question ? studio.question->what : "");
    for (const Panel& panel : all_panels()) {
        if (panel.describe) panel.describe(studio, state);
    }
    state["action"] = map_text(studio.last_action);
    state["actions"] = std::to_string(studio.actions_run);
    state["dialog"] = map_text(ImGui::GetTopMostPopupModal() != nullptr);
    state["scale"] = fmt::format("{:.3f}", studio.ui_scale);
    Json notices = Json::array();
    for (const Notice& notice : studio.notices) notices.push_back(notice.what);
    state["notices"] = notices.dump();
    return state;
}

void save_again_now_and_then(Studio& studio) {
    if (!studio.session.save_problem() || !studio.session.file()) {
        // The next change may have saved everything.
        if (std::exchange(studio.save_again_at_s, 0.0) > 0.0) tell_saved_again(studio);
        return;
    }
    if (studio.save_again_at_s <= 0.0) {
        studio.save_again_at_s = studio.now_s + kBetweenSavings_s;
        tell_error(studio,
                   kNotSaved,
                   *studio.session.save_problem(),
                   "Make room on the disk: saving then goes on by itself. File > Save session as… "
                   "saves it elsewhere.");
    } else if (studio.now_s >= studio.save_again_at_s) {
        studio.save_again_at_s = studio.now_s + kBetweenSavings_s;
        studio.session.save_again();
    }
}

void tell_unsaved(Studio& studio) {
    if (studio.session.file()) return;
    tell_error(studio,
               "Nothing that you do is being saved.",
               studio.session.save_problem().value_or(""),
               "File > Save session as… saves it elsewhere, with all that was done.");
}

}  // namespace livery
