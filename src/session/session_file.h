// How a session lies in its file: every step with the document after it, the place in the history,
// and the workspace.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/database.h"
#include "session/document.h"

namespace livery {

/// One step of the history. The first has no command: the document that the session began with.
struct SessionStep {
    std::string command, label;
    std::string document;  ///< after the command, as text
};

/// Whether the file's first bytes are a session's, whatever else is wrong with it.
bool is_session_file(const std::filesystem::path& file);

/// Steps are numbered from 0 to last_step(). Every function throws FileError.
class SessionFile {
  public:
    enum class Access { change, read };
    SessionFile(const std::filesystem::path& file, Access access);

    /// A new file that holds these steps, at least one; there is none before it is whole.
    static void create(const std::filesystem::path& file,
                       const std::vector<SessionStep>& steps,
                       std::int64_t position = 0,
                       const std::map<std::string, std::string>& workspace = {});

    std::int64_t last_step();
    std::int64_t position();  ///< the step whose document is the session's
    SessionStep step(std::int64_t number);
    Document document(std::int64_t number);
    std::map<std::string, std::string> workspace();

    /// In one transaction: drops the steps after `kept`, adds `added` behind them, takes `position`
    /// and these values of the workspace.
    void save(std::int64_t kept,
              const std::vector<SessionStep>& added,
              std::int64_t position,
              const std::map<std::string, std::string>& workspace);

    /// Throws FileError when any page of the file or any step of the history is damaged.
    void check_all();
    /// Throws FileError when a page of the file is damaged.
    void check_pages();

  private:
    Database database_;
};

}  // namespace livery
