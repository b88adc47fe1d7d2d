#include <algorithm>

#include <GLFW/glfw3.h>

#include "core/error.h"
#include "core/json.h"
#include "scene/library.h"
#include "session/session_file.h"
#include "studio/kit/running_window.h"
#include "studio/product/new_session.h"
#include "studio/studio.h"

namespace livery {

namespace {

constexpr const char* kRecentSetting = "recent-sessions";

bool is_file(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error);
}

OpenedSession open_existing(const std::filesystem::path& file) {
    if (!is_file(file)) throw FileError(file, "", "no such file", "a session");
    try {
        Session session = Session::open(file);
        auto product = find_product(session.document().product, session.document().product_unit);
        return {std::move(session), std::move(product)};
    } catch (const Refused& refused) {
        if (!ask_running_window(file)) throw;
        throw Refused(refused.why(), "its window was asked to come to the front");
    }
}

/// Looks have suffix and form in common with products, but name no mesh.
bool names_a_mesh(const std::filesystem::path& file) {
    try {
        const Json json = read_json_file(file);
        return json.is_object() && json.contains("mesh");
    } catch (const FileError&) {
        return false;
    }
}

}  // namespace

std::string why_not_to_leave(const Studio& studio) {
    const auto problem = studio.session.save_problem();
    if (!problem && studio.session.file()) return "";
    return "What was done in the session that is open is not saved yet (File, Save session as…).";
}

void leave_session(Studio& studio,
                   const std::string& doing,
                   const std::string& action,
                   std::function<void()> then) {
    const bool captures =
        studio.capture && studio.capture->view().doing == CaptureView::Doing::capturing;
    const bool calibrates = studio.bench && studio.bench->calibrating().running;
    if (!captures && !calibrates) return then();
    Question question;
    question.what = captures ? "A capture is running" : "A calibration is running";
    question.cause = doing + (captures ? " stops it. What was photographed so far is kept."
                                       : " stops it, and nothing of it is kept.");
    question.action = action;
    question.then = std::move(then);
    studio.question = std::move(question);
}

void open_other_session(Studio& studio, const std::filesystem::path& given) {
    const auto file = std::filesystem::absolute(given).lexically_normal();
    const std::string what = "The session " + file.filename().string() + " was not opened.";
    std::error_code error;
    if (const auto open = studio.session.file();
        open && std::filesystem::equivalent(*open, file, error)) {
        tell_info(studio, "This session is open already.", file.string());
        return;
    }
    if (const std::string why = why_not_to_leave(studio); !why.empty()) {
        tell_error(studio, what, why);
        return;
    }
    leave_session(
        studio, "Opening " + file.filename().string(), "Stop and open", [&studio, file, what] {
            in_background(studio, what, [&studio, file](const Progress&) -> Background::Then {
                const auto opened = std::make_shared<OpenedSession>(open_existing(file));
                return [&studio, opened] { studio.next_session = opened; };
            });
        });
}

void ask_for_session(Studio& studio) {
    FileQuestion question;
    question.title = "Open session";
    question.action = "Open";
    question.suffixes = {".livery"};
    const auto open = studio.session.file();
    question.suggested = open ? open->parent_path() : documents_folder();
    question.then = [&studio](const auto& file) { open_other_session(studio, file); };
    studio.file_dialog->ask(std::move(question));
}

void take_dropped_files(Studio& studio, const std::vector<std::filesystem::path>& files) {
    if (files.empty()) return;
    const std::filesystem::path& file = files.front();
    if (files.size() == 1 && is_file(file)) {
        if (has_suffix_of(file, {".livery"}) || is_session_file(file)) {
            return open_other_session(studio, file);
        }
        const bool json = has_suffix_of(file, {".json"});
        if (is_product_path(file) && (!json || names_a_mesh(file))) {
            return begin_new_session(studio, file);
        }
    }
    tell_warning(
        studio,
        files.size() == 1 ? file.filename().string() + " cannot be opened here."
                          : "Drop one file at a time.",
        "A session (.livery) opens. A mesh (.glb, .gltf, .ply, .obj) or a product file (.json) "
        "begins a new session.");
}

std::vector<std::filesystem::path> recent_sessions(const UserSettings& settings) {
    std::vector<std::filesystem::path> files;
    const std::string all = setting(settings, kRecentSetting);
    for (std::size_t from = 0; from < all.size() && files.size() < kMostRecentSessions;) {
        const std::size_t to = std::min(all.find('\n', from), all.size());
        if (to > from) files.emplace_back(all.substr(from, to - from));
        from = to + 1;
    }
    return files;
}

void remember_recent_session(UserSettings& settings, const std::filesystem::path& given) {
    const auto file = std::filesystem::absolute(given).lexically_normal();
    std::string all = file.string();
    std::size_t count = 1;
    for (const auto& other : recent_sessions(settings)) {
        if (other == file || count == kMostRecentSessions) continue;
        all += "\n" + other.string();
        ++count;
    }
    keep_setting(settings, kRecentSetting, all);
}

namespace {

std::vector<Action> session_actions() {
    return {{"new-session", "File", "New session…", {ctrl(GLFW_KEY_N)}, ask_for_product},
            {"open-session", "File", "Open session…", {ctrl(GLFW_KEY_O)}, ask_for_session}};
}

}  // namespace

Panel sessions_panel() { return {.name = "sessions", .actions = session_actions}; }

}  // namespace livery
