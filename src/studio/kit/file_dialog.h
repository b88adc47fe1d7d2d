// Questions to the operator: for a file or a folder (where one is, what lies there, and a name to
// type), and before something is taken away that took time to make.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "studio/kit/folders.h"
#include "studio/kit/user_settings.h"

namespace livery {

struct FileQuestion {
    enum class Kind { open, save, folder };
    Kind kind = Kind::open;
    std::string title;                       ///< "Import look"
    std::string action;                      ///< what the button says: "Import"
    std::vector<std::string> suffixes = {};  ///< shown in the list; empty: all
    bool only_new = false;                   ///< a file that is there is refused
    /// A name, or a folder, or both, to start with.
    std::filesystem::path suggested = {};
    std::function<void(const std::filesystem::path&)> then;  ///< overwriting is already agreed to
    /// Draws choices above the list and changes suffixes and the suggested name by them; a name
    /// that was typed stays, with the new suffix.
    std::function<void(FileQuestion&)> choices = {};
    /// Why there is nothing to save yet, asked when the button is pressed; empty: there is.
    std::function<std::string()> not_ready = {};
};

/// One at a time; a new question replaces the one before. Starts where a question of this title was
/// answered last, else where any that saves was, or any that opens, else in the suggested folder,
/// else at home.
class FileDialog {
  public:
    /// `settings` remembers the folders and must outlive this.
    explicit FileDialog(UserSettings& settings);
    ~FileDialog();

    void ask(FileQuestion question);
    void draw();  ///< once a frame
    bool is_open() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

struct Question {
    std::string what, cause;     ///< what is the matter, and what would come of going on
    std::string action;          ///< on the button that goes on
    std::function<void()> then;  ///< when it is pressed; "Cancel" and Esc do nothing
    bool to_open = true;
};

/// Draws it, if there is one, once a frame; it is gone when it is answered. No other dialog may be
/// drawn in that frame.
void draw_question(std::optional<Question>& question);

}  // namespace livery
