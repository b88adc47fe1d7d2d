// A second start on the same session shows the window that is open already.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

namespace livery {

/// Listens on a thread of its own until it is destroyed.
class RunningWindow {
  public:
    /// For the program that holds this session; `on_asked` is called on the thread each time that
    /// another start asks for the window. Where nothing can be listened on the log says so.
    RunningWindow(const std::filesystem::path& session, std::function<void()> on_asked);
    ~RunningWindow();
    RunningWindow(const RunningWindow&) = delete;
    RunningWindow& operator=(const RunningWindow&) = delete;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Asks the program of this user that has the session open to show its window; true when it
/// answered.
bool ask_running_window(const std::filesystem::path& session);

}  // namespace livery
