#include "studio/kit/user_folders.h"

#include <cstdlib>
#include <fstream>
#include <string>

namespace livery {

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

}  // namespace livery
