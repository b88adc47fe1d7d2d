#include "studio/file_dialog.h"

#include <algorithm>
#include <optional>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "studio/studio.h"
#include "studio/theme.h"
#include "studio/user_folders.h"

namespace livery {

namespace {

std::string lower(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

bool has_suffix_of(const std::filesystem::path& file, const std::vector<std::string>& suffixes) {
    return suffixes.empty() ||
           std::find(suffixes.begin(), suffixes.end(), lower(file.extension().string())) !=
               suffixes.end();
}

bool is_folder(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_directory(path, error);
}

}  // namespace

std::filesystem::path expand_home(const std::string& text) {
    if (text == "~") return home_folder();
    return text.starts_with("~/") ? home_folder() / text.substr(2) : std::filesystem::path(text);
}

std::vector<FolderEntry> list_folder(const std::filesystem::path& folder,
                                     const std::vector<std::string>& suffixes,
                                     bool folders_only) {
    std::vector<FolderEntry> entries;
    std::error_code error;
    for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
         it.increment(error)) {
        const std::string name = it->path().filename().string();
        const bool folder_itself = is_folder(it->path());
        if (name.starts_with(".")) continue;
        if (!folder_itself && (folders_only || !has_suffix_of(name, suffixes))) continue;
        entries.push_back({name, folder_itself});
    }
    std::sort(entries.begin(), entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
        if (a.is_folder != b.is_folder) return a.is_folder;
        return lower(a.name) < lower(b.name);
    });
    return entries;
}

struct FileDialog::State {
    std::optional<FileQuestion> question;
    bool to_open = false, asking_to_overwrite = false;
    std::filesystem::path folder;
    std::string path, problem;
    std::vector<FolderEntry> entries;

    void enter(const std::filesystem::path& where) {
        folder = where.lexically_normal();
        const bool folders = question->kind == FileQuestion::Kind::folder;
        entries = list_folder(folder, question->suffixes, folders);
    }

    /// Keeps a file name that was typed or suggested for saving.
    void go_to(const std::filesystem::path& where) {
        const auto name = question->kind == FileQuestion::Kind::save
                              ? std::filesystem::path(path).filename()
                              : std::filesystem::path();
        enter(where);
        path = (folder / name).string();
        problem.clear();
    }

    /// What is wrong with the path for this question; empty: nothing.
    std::string problem_of(const std::filesystem::path& file) const {
        std::error_code error;
        switch (question->kind) {
            case FileQuestion::Kind::open:
                if (path.empty()) return "Type a file's name or pick one.";
                if (!std::filesystem::exists(file, error)) return "There is no such file.";
                if (is_folder(file)) return "This is a folder; pick a file in it.";
                return "";
            case FileQuestion::Kind::folder:
                return is_folder(file) ? "" : "There is no such folder.";
            case FileQuestion::Kind::save:
                if (!file.has_filename() || is_folder(file)) return "Type a file name.";
                if (!is_folder(file.parent_path())) return "The file's folder does not exist.";
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
        const auto file = std::filesystem::absolute(expand_home(path));
        if (question->kind == FileQuestion::Kind::open && is_folder(file)) {
            go_to(file);
            return false;
        }
        problem = problem_of(file);
        if (!problem.empty()) return false;
        std::error_code error;
        if (question->kind == FileQuestion::Kind::save && !asking_to_overwrite &&
            std::filesystem::exists(file, error)) {
            asking_to_overwrite = true;
            return false;
        }
        const auto then = question->then;
        question.reset();
        then(file);
        return true;
    }

    void draw_entries() {
        ImGui::BeginChild("entries", {0.0f, em(16.0f)}, true);
        std::optional<std::filesystem::path> entered;
        if (folder.has_parent_path() && folder != folder.root_path()) {
            if (ImGui::Selectable("↑  folder above", false, ImGuiSelectableFlags_DontClosePopups)) {
                entered = folder.parent_path();
            }
            name_last_item("file-dialog:up");
        }
        for (const FolderEntry& entry : entries) {
            const std::string shown = (entry.is_folder ? "▸  " : "     ") + entry.name;
            const bool chosen = !entry.is_folder && (folder / entry.name).string() == path;
            if (ImGui::Selectable(shown.c_str(), chosen, ImGuiSelectableFlags_DontClosePopups)) {
                if (entry.is_folder) {
                    entered = folder / entry.name;
                } else {
                    path = (folder / entry.name).string();
                    asking_to_overwrite = false;
                }
            }
            name_last_item("file-dialog:" + entry.name);
        }
        if (entries.empty()) dim_text("Nothing of this kind is here.");
        ImGui::EndChild();
        if (entered) go_to(*entered);
    }
};

FileDialog::FileDialog() : state_(std::make_unique<State>()) {}
FileDialog::~FileDialog() = default;

bool FileDialog::is_open() const { return state_->question.has_value(); }

void FileDialog::ask(FileQuestion question) {
    State& state = *state_;
    state.question = std::move(question);
    state.to_open = true;
    state.asking_to_overwrite = false;
    state.problem.clear();
    const auto& suggested = state.question->suggested;
    const bool folder = is_folder(suggested);
    state.enter(folder ? suggested : suggested.parent_path());
    state.path = folder && state.question->kind != FileQuestion::Kind::folder
                     ? (state.folder / "").string()
                     : suggested.string();
}

void FileDialog::draw() {
    State& state = *state_;
    if (!state.question) return;
    const std::string title = state.question->title + "###file-dialog";
    if (state.to_open) ImGui::OpenPopup(title.c_str());
    ImGui::SetNextWindowSize({em(38.0f), 0.0f});
    const ImVec2 middle = ImGui::GetMainViewport()->GetCenter();
    ImGui::SetNextWindowPos(middle, ImGuiCond_Always, {0.5f, 0.5f});
    bool open = true;
    if (!ImGui::BeginPopupModal(title.c_str(), &open, ImGuiWindowFlags_NoResize)) {
        state.question.reset();
        return;
    }
    if (state.to_open) ImGui::SetKeyboardFocusHere();
    state.to_open = false;
    ImGui::SetNextItemWidth(-1.0f);
    bool agreed = ImGui::InputText("##path", &state.path, ImGuiInputTextFlags_EnterReturnsTrue);
    name_last_item("file-dialog:path");
    if (ImGui::IsItemEdited()) {
        state.problem.clear();
        state.asking_to_overwrite = false;
    }
    state.draw_entries();
    if (!state.problem.empty()) warning_text(state.problem);
    if (state.asking_to_overwrite) warning_text("This file exists already. Replace it?");
    const float width = em(7.0f);
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - 2.0f * width -
                         ImGui::GetStyle().ItemSpacing.x);
    bool cancelled = ImGui::Button("Cancel", {width, 0.0f});
    name_last_item("file-dialog:cancel");
    ImGui::SameLine();
    const char* action = state.asking_to_overwrite ? "Replace" : state.question->action.c_str();
    agreed = ImGui::Button(action, {width, 0.0f}) || agreed;
    name_last_item("file-dialog:ok");
    cancelled = cancelled || !open || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (cancelled || (agreed && state.answer())) {
        state.question.reset();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace livery
