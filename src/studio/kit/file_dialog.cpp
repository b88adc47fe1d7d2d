#include "studio/kit/file_dialog.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "studio/kit/folders.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"

namespace livery {

namespace {

/// Where files are read is not where they are saved.
const char* any_folder_setting(const FileQuestion& question) {
    return question.kind == FileQuestion::Kind::save ? "folder-saved" : "folder";
}

std::string folder_setting(const FileQuestion& question) {
    return std::string("folder:") + question.title;
}

/// Drawn, because no font has one in every size.
void draw_folder_sign(const ImVec2& corner, float height) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 colour = ImGui::GetColorU32(colours::dim_text);
    const float top = std::floor(corner.y + 0.24f * height), left = std::floor(corner.x);
    const float width = std::floor(0.78f * height), low = std::floor(corner.y + 0.82f * height);
    list.AddRectFilled({left, top}, {left + 0.45f * width, low}, colour, 0.07f * height);
    list.AddRectFilled({left, top + 0.12f * height}, {left + width, low}, colour, 0.07f * height);
}

}  // namespace

struct FileDialog::State {
    explicit State(UserSettings& its_settings) : settings(its_settings) {}

    UserSettings& settings;
    std::optional<FileQuestion> question;
    bool to_open = false, to_focus = false, asking_to_overwrite = false;
    std::filesystem::path folder;
    std::string name, problem, unreadable;
    std::optional<std::string> chosen_folder;  ///< in the list, not entered yet
    std::vector<FolderEntry> entries;

    void list() {
        const bool folders = question->kind == FileQuestion::Kind::folder;
        entries = list_folder(folder, question->suffixes, folders);
        unreadable = folder_problem(folder);
    }

    /// The name that was typed or suggested for saving stays; a file of another folder does not.
    void enter(const std::filesystem::path& where) {
        folder = typed_path(where.string(), home_folder());
        chosen_folder.reset();
        problem.clear();
        asking_to_overwrite = false;
        if (question->kind != FileQuestion::Kind::save) name.clear();
        list();
    }

    void start() {
        const auto& suggested = question->suggested;
        const bool suggests_folder = !suggested.empty() && is_folder(suggested);
        name = suggests_folder ? "" : suggested.filename().string();
        std::filesystem::path where = setting(settings, folder_setting(*question));
        const auto or_else = [&](const std::filesystem::path& other) {
            if (where.empty() || !is_folder(where)) where = other;
        };
        or_else(setting(settings, any_folder_setting(*question)));
        or_else(suggests_folder ? suggested : suggested.parent_path());
        or_else(home_folder());
        enter(where);
    }

    /// What is wrong with the path for this question; empty: nothing.
    std::string problem_of(const std::filesystem::path& file) const {
        std::error_code error;
        switch (question->kind) {
            case FileQuestion::Kind::open:
                if (file.empty()) return "Type a file's name or pick one.";
                if (!std::filesystem::exists(file, error)) {
                    return "There is no file " + file.string() + ".";
                }
                return "";
            case FileQuestion::Kind::folder:
                return is_folder(file) ? "" : "There is no folder " + file.string() + ".";
            case FileQuestion::Kind::save:
                if (file.empty()) return "Type a file name.";
                if (!is_folder(file.parent_path())) {
                    return "There is no folder " + file.parent_path().string() + ".";
                }
                if (!has_suffix_of(file, question->suffixes)) {
                    return "The file name must end in " + question->suffixes.front() + ".";
                }
                if (question->only_new && std::filesystem::exists(file, error)) {
                    return "There is such a file already; choose another name.";
                }
                return "";
        }
        return "";
    }

    /// True when the question is answered.
    bool answer() {
        if (chosen_folder && question->kind != FileQuestion::Kind::folder) {
            enter(folder / *chosen_folder);
            return false;
        }
        auto file = typed_path(name, folder);
        const bool picks_folder = question->kind == FileQuestion::Kind::folder;
        if (picks_folder && file.empty()) file = chosen_folder ? folder / *chosen_folder : folder;
        if (!picks_folder && !file.empty() && is_folder(file)) {
            name.clear();
            enter(file);
            to_focus = true;
            return false;
        }
        if (question->kind == FileQuestion::Kind::save && !file.empty() && !file.has_extension() &&
            !question->suffixes.empty()) {
            file += question->suffixes.front();
        }
        problem = problem_of(file);
        if (problem.empty() && question->not_ready) problem = question->not_ready();
        if (!problem.empty()) return false;
        std::error_code error;
        if (question->kind == FileQuestion::Kind::save && !asking_to_overwrite &&
            std::filesystem::exists(file, error)) {
            asking_to_overwrite = true;
            return false;
        }
        const auto where = (picks_folder ? file : file.parent_path()).string();
        keep_setting(settings, folder_setting(*question), where);
        keep_setting(settings, any_folder_setting(*question), where);
        const auto then = question->then;
        question.reset();
        then(file);
        return true;
    }

    /// Each folder on the way here, to go back to; the last ones when not all fit.
    void draw_way() {
        const bool top = folder == folder.root_path();
        begin_disabled(top);
        std::optional<std::filesystem::path> entered;
        if (ImGui::Button("↑ Folder above")) entered = folder.parent_path();
        end_disabled();
        name_last_item("file-dialog:up");
        tooltip("Alt+Up");
        ImGui::SameLine();
        if (button("Home", "file-dialog:home")) entered = home_folder();
        ImGui::SameLine();
        ImGui::AlignTextToFramePadding();
        const float width = ImGui::GetContentRegionAvail().x;
        std::string shown = folder.string();
        while (shown.size() > 4 && ImGui::CalcTextSize(("…" + shown).c_str()).x > width) {
            const auto slash = shown.find('/', 1);
            if (slash == std::string::npos) break;
            shown = shown.substr(slash);
        }
        if (shown.size() < folder.string().size()) shown = "…" + shown;
        ImGui::TextUnformatted(shown.c_str());
        name_last_item("file-dialog:folder");
        tooltip(folder.string());
        const ImGuiIO& io = ImGui::GetIO();
        const bool alt_up = io.KeyAlt && was_pressed(ImGuiKey_UpArrow);
        if (alt_up && !top) entered = folder.parent_path();
        if (entered) enter(*entered);
    }

    /// True when a file was chosen as by the button.
    bool draw_entries(float height) {
        ImGui::BeginChild("entries", {0.0f, height}, true, ImGuiWindowFlags_NavFlattened);
        std::optional<std::filesystem::path> entered;
        bool agreed = false;
        const float indent = ImGui::GetTextLineHeight() * 1.35f;
        for (const FolderEntry& entry : entries) {
            const bool chosen = entry.is_folder ? chosen_folder == entry.name
                                                : !chosen_folder && name == entry.name;
            const ImVec2 corner = ImGui::GetCursorScreenPos();
            const std::string id = "##" + entry.name;
            const bool pressed = ImGui::Selectable(
                id.c_str(),
                chosen,
                ImGuiSelectableFlags_DontClosePopups | ImGuiSelectableFlags_AllowDoubleClick);
            name_last_item("file-dialog:" + entry.name);
            // Enter means it at once; the pointer needs two clicks, the first may only look.
            const bool by_key = ImGui::GetCurrentContext()->NavActivateId == ImGui::GetItemID();
            const bool meant =
                pressed && (by_key || ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left));
            if (entry.is_folder) draw_folder_sign(corner, ImGui::GetTextLineHeight());
            ImGui::GetWindowDrawList()->AddText({corner.x + indent, corner.y},
                                                ImGui::GetColorU32(colours::text),
                                                entry.name.c_str());
            if (!pressed) continue;
            problem.clear();
            asking_to_overwrite = false;
            if (entry.is_folder) {
                chosen_folder = entry.name;
                if (meant) entered = folder / entry.name;
            } else {
                chosen_folder.reset();
                name = entry.name;
                agreed = meant;
            }
        }
        if (!unreadable.empty()) {
            warning_text(unreadable);
        } else if (entries.empty()) {
            dim_text("Nothing of this kind is here.");
        }
        ImGui::EndChild();
        if (entered) enter(*entered);
        return agreed;
    }

    void draw_choices() {
        if (!question->choices) return;
        const auto suffixes = question->suffixes;
        const auto suggested = question->suggested.filename();
        question->choices(*question);
        ImGui::Dummy({0.0f, em(0.2f)});
        if (question->suffixes == suffixes && question->suggested.filename() == suggested) return;
        // A field that is typed in would go on with its own text.
        if (ImGui::IsAnyItemActive()) ImGui::ClearActiveID();
        const std::filesystem::path typed = name;
        if (typed == suggested) {
            name = question->suggested.filename().string();
        } else if (has_suffix_of(typed, suffixes) && !question->suffixes.empty()) {
            name = (typed.parent_path() / typed.stem()).string() + question->suffixes.front();
        }
        problem.clear();
        asking_to_overwrite = false;
        list();
    }

    /// True when Enter was pressed in it.
    bool draw_name() {
        const bool picks_folder = question->kind == FileQuestion::Kind::folder;
        row_label(picks_folder ? "Folder" : "Name", 0.12f);
        if (to_focus) focus_next_field("##name");
        to_focus = false;
        const bool agreed = ImGui::InputTextWithHint(
            "##name",
            picks_folder ? "this one, or type another" : "a name, or a folder to go to",
            &name,
            ImGuiInputTextFlags_EnterReturnsTrue);
        name_last_item("file-dialog:path");
        if (ImGui::IsItemEdited()) {
            problem.clear();
            chosen_folder.reset();
            asking_to_overwrite = false;
        }
        return agreed;
    }
};

FileDialog::FileDialog(UserSettings& settings) : state_(std::make_unique<State>(settings)) {}
FileDialog::~FileDialog() = default;

bool FileDialog::is_open() const { return state_->question.has_value(); }

void FileDialog::ask(FileQuestion question) {
    State& state = *state_;
    state.question = std::move(question);
    state.to_open = state.to_focus = true;
    state.start();
}

void FileDialog::draw() {
    State& state = *state_;
    if (!state.question) return;
    const std::string title = state.question->title + "###file-dialog";
    if (state.to_open) ImGui::OpenPopup(title.c_str());
    state.to_open = false;
    bool open = true;
    if (!begin_modal(title, em(44.0f), &open)) {
        state.question.reset();
        return;
    }
    state.draw_choices();
    state.draw_way();
    const float others = state.question->choices ? em(20.0f) : em(12.0f);
    bool agreed = state.draw_entries(
        std::clamp(ImGui::GetMainViewport()->Size.y - others, em(6.0f), em(18.0f)));
    agreed = state.draw_name() || agreed;
    if (!state.problem.empty()) warning_text(state.problem);
    if (state.asking_to_overwrite) warning_text("This file exists already. Replace it?");
    const float width = em(7.0f);
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - 2.0f * width -
                         ImGui::GetStyle().ItemSpacing.x);
    bool cancelled = button("Cancel", "file-dialog:cancel", "", width);
    ImGui::SameLine();
    const char* action = state.asking_to_overwrite ? "Replace" : state.question->action.c_str();
    agreed = ImGui::Button(action, {width, 0.0f}) || agreed;
    name_last_item("file-dialog:ok");
    cancelled = cancelled || !open || was_pressed(ImGuiKey_Escape);
    // What comes of the answer may ask the next question.
    const bool answered = !cancelled && agreed && state.answer();
    if (cancelled) state.question.reset();
    if (cancelled || answered) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void draw_question(std::optional<Question>& question) {
    if (!question) return;
    const std::string title = question->what + "###question";
    if (std::exchange(question->to_open, false)) ImGui::OpenPopup(title.c_str());
    if (!begin_modal(title, em(30.0f))) {
        question.reset();
        return;
    }
    ImGui::TextWrapped("%s", question->cause.c_str());
    ImGui::Dummy({0.0f, em(0.3f)});
    const float width = em(9.0f);
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - 2.0f * width -
                         ImGui::GetStyle().ItemSpacing.x);
    const bool cancelled = ImGui::Button("Cancel", {width, 0.0f}) || was_pressed(ImGuiKey_Escape);
    name_last_item("question:cancel");
    ImGui::SameLine();
    const bool agreed = button(question->action, "question:ok", "", width);
    std::function<void()> then;
    if (agreed && !cancelled) then = std::move(question->then);
    if (agreed || cancelled) {
        question.reset();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    // What comes of it may ask the next question.
    if (then) then();
}

}  // namespace livery
