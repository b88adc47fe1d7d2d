// Asks for a file or a folder: a path to type and the folder's content to pick from.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace livery {

struct FileQuestion {
    enum class Kind { open, save, folder };
    Kind kind = Kind::open;
    std::string title;                                       ///< "Import look"
    std::string action;                                      ///< what the button says: "Import"
    std::vector<std::string> suffixes;                       ///< shown in the list; empty: all
    bool only_new = false;                                   ///< a file that is there is refused
    std::filesystem::path suggested;                         ///< folder or file to start with
    std::function<void(const std::filesystem::path&)> then;  ///< overwriting is already agreed to
};

/// One at a time; a new question replaces the one before.
class FileDialog {
  public:
    FileDialog();
    ~FileDialog();

    void ask(FileQuestion question);
    void draw();  ///< once a frame
    bool is_open() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

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

}  // namespace livery
