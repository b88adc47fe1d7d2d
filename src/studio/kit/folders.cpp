#include "studio/kit/folders.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <string>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace livery {

namespace {

std::string lower(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

}  // namespace

bool has_suffix_of(const std::filesystem::path& file, const std::vector<std::string>& suffixes) {
    return suffixes.empty() ||
           std::find(suffixes.begin(), suffixes.end(), lower(file.extension().string())) !=
               suffixes.end();
}

std::string file_name_of(const std::string& name) {
    std::string result;
    for (const char c : name) {
        const bool plain = static_cast<unsigned char>(c) >= 0x80 ||
                           std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
        if (plain) {
            result += c;
        } else if (!result.empty() && result.back() != '-') {
            result += '-';
        }
    }
    while (!result.empty() && result.back() == '-') result.pop_back();
    return result.empty() ? "look" : result;
}

bool is_folder(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_directory(path, error);
}

std::string folder_problem(const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::directory_iterator opened(folder, error);
    return error ? "This folder cannot be read: " + error.message() + "." : "";
}

std::filesystem::path expand_home(const std::string& text) {
    if (text == "~") return home_folder();
    return text.starts_with("~/") ? home_folder() / text.substr(2) : std::filesystem::path(text);
}

std::filesystem::path typed_path(const std::string& text, const std::filesystem::path& folder) {
    const auto first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
    if (first == std::string::npos) return {};
    auto path = (folder / expand_home(text.substr(first, last - first + 1))).lexically_normal();
    // "folder/" and "folder" are the same place.
    if (!path.has_filename() && path != path.root_path()) path = path.parent_path();
    return path;
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

namespace {

/// user-dirs.dirs has lines like XDG_PICTURES_DIR="$HOME/Bilder".
std::filesystem::path xdg_folder(const std::string& name) {
    const auto home = home_folder();
    const char* config = std::getenv("XDG_CONFIG_HOME");
    const auto folder = config && *config ? std::filesystem::path(config) : home / ".config";
    std::ifstream file(folder / "user-dirs.dirs");
    for (std::string line; std::getline(file, line);) {
        const std::string start = name + "=\"";
        if (!line.starts_with(start) || line.back() != '"') continue;
        std::string value = line.substr(start.size(), line.size() - start.size() - 1);
        if (value.starts_with("$HOME")) value = home.string() + value.substr(5);
        std::error_code error;
        if (std::filesystem::is_directory(value, error)) return value;
    }
    return home;
}

}  // namespace

std::filesystem::path home_folder() {
    const char* home = std::getenv("HOME");
    return home && *home ? std::filesystem::path(home) : std::filesystem::path("/");
}

std::filesystem::path pictures_folder() { return xdg_folder("XDG_PICTURES_DIR"); }
std::filesystem::path documents_folder() { return xdg_folder("XDG_DOCUMENTS_DIR"); }

bool open_folder(const std::filesystem::path& folder) {
    // The shell ends at once, so that the file manager is nobody's child to wait for.
    std::string script =
        R"(command -v xdg-open >/dev/null || exit 1; xdg-open "$1" </dev/null >/dev/null 2>&1 &)";
    std::string studio = "sh", option = "-c", name = "sh", argument = folder.string();
    char* words[] = {
        studio.data(), option.data(), script.data(), name.data(), argument.data(), nullptr};
    pid_t id = -1;
    if (::posix_spawnp(&id, "sh", nullptr, nullptr, words, ::environ) != 0) return false;
    int status = 0;
    while (::waitpid(id, &status, 0) < 0 && errno == EINTR) continue;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace livery
