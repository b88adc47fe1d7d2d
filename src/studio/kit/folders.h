// Folders and names as a file dialog has them, where people keep things, and a folder shown in the
// desktop's own file manager.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace livery {

/// What a folder offers to a question, folders first, by name; hidden ones are left out.
struct FolderEntry {
    std::string name;
    bool is_folder = false;
};
std::vector<FolderEntry> list_folder(const std::filesystem::path& folder,
                                     const std::vector<std::string>& suffixes,
                                     bool folders_only);

/// "~/x" -> the home folder's x.
std::filesystem::path expand_home(const std::string& text);

/// What a typed text means while `folder` is shown: a whole path, one from home, or one from that
/// folder. Without dots and double slashes; empty for an empty text.
std::filesystem::path typed_path(const std::string& text, const std::filesystem::path& folder);

/// Whether the name ends in one of these, whatever the case; true when there are none.
bool has_suffix_of(const std::filesystem::path& file, const std::vector<std::string>& suffixes);

/// "Blue metallic / 2" -> "Blue-metallic-2": for file names.
std::string file_name_of(const std::string& name);

bool is_folder(const std::filesystem::path& path);

/// Why a folder's content cannot be shown; empty: it can.
std::string folder_problem(const std::filesystem::path& folder);

std::filesystem::path home_folder();  ///< the root when the user has none
std::filesystem::path pictures_folder();
std::filesystem::path documents_folder();

/// Asks xdg-open to; false where there is none. Does not wait for the file manager.
bool open_folder(const std::filesystem::path& folder);

}  // namespace livery
