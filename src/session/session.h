// The session: one document, its whole history, one SQLite file that is never behind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/commands.h"
#include "session/document.h"

namespace livery {

/// What undo leaves alone, and yet is as it was after a restart: which look is shown, which monitor
/// is the projector, how the window stands. Names are the studio's; values are text.
using Workspace = std::map<std::string, std::string>;

class Session {
  public:
    /// Opens the file or makes a new session in it, in the paint library as it is now; measured
    /// paints stay unread. A second program on the same file is refused
    /// (Refused, names the other's process). Throws FileError (corrupt, newer, read-only folder).
    static Session open(const std::filesystem::path& file,
                        const std::string& product = "car",
                        std::optional<LengthUnit> unit = std::nullopt);
    /// No file: for tests and for a folder that cannot be written; the reason is what to tell.
    static Session unsaved(const Document& document, std::string why);
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;
    ~Session();

    const Document& document() const;
    /// Grows with every change, undo, redo and another library included.
    std::uint64_t revision() const;

    /// From now on names of paints mean what they do in this library; no step of the history.
    void use(std::shared_ptr<const PaintLibrary> library);

    /// Applies and saves; it is on disk when this returns. When saving fails the change stands, and
    /// save_problem() says why until a later one succeeds, which then saves all that was not.
    /// Throws what applied() throws, and then nothing changed. A command that changes nothing is no
    /// step.
    void execute(const SessionCommand& command);

    bool can_undo() const;
    bool can_redo() const;
    std::string undo_label() const;  ///< "Paint body solid red"; empty when there is nothing
    std::string redo_label() const;
    /// The look that the undone or redone command was about, to show it. Without limit; a new
    /// command drops what could be redone. Throws FileError when that step is damaged, and then
    /// nothing changed.
    std::optional<int> undo();
    std::optional<int> redo();

    /// Goes on in a new file, with the whole history; the file before stays as it is, and an
    /// unsaved session is saved from now on. Throws Refused (there is such a file, or it is open
    /// elsewhere), FileError; then the session stays where it was.
    void save_as(const std::filesystem::path& file);

    const Workspace& workspace() const;
    void set_workspace(const std::string& name, const std::string& value);

    std::optional<std::string> save_problem() const;
    /// Tries again to save what could not be; true when there is no problem (any more). To be
    /// called now and then while there is one: a disk that was full may have room by now.
    bool save_again();
    std::optional<std::filesystem::path> file() const;

  private:
    struct State;
    explicit Session(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// The session that the desktop opens when none is named: in the user's folder.
std::filesystem::path default_session_file();

}  // namespace livery
