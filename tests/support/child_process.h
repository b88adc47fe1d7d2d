// A program that runs beside the test and never outlives it.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace livery {

struct ChildOptions {
    std::vector<std::string> arguments;  ///< the program first; found in PATH without a slash
    std::map<std::string, std::string> environment;  ///< on top of the test's own
    std::filesystem::path output;                    ///< stdout and stderr; empty: the test's
    std::optional<int> kept_descriptor;              ///< stays open in the child
};

class ChildProcess {
  public:
    /// Throws std::runtime_error when it cannot be started.
    explicit ChildProcess(const ChildOptions& options);
    /// Kills it when it still runs.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    pid_t id() const { return id_; }
    bool running();
    void send(int signal);
    /// Exit code, 128 + signal when it was killed; nothing when it still runs after the timeout.
    std::optional<int> wait(std::chrono::milliseconds timeout);

  private:
    pid_t id_ = -1;
    std::optional<int> exit_code_;
};

/// Long enough for slow cores that others use as well: only what fails takes it.
inline constexpr auto patience = std::chrono::minutes(3);

/// Asks again every few milliseconds until `condition` holds; its last answer.
template <typename Condition>
bool wait_until(Condition&& condition, std::chrono::milliseconds timeout = patience);

/// The last lines of a text file, for a failure's message.
std::string tail_of(const std::filesystem::path& file, std::size_t lines = 20);

void sleep_ms(int milliseconds);

template <typename Condition>
bool wait_until(Condition&& condition, std::chrono::milliseconds timeout) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return condition();
        sleep_ms(5);
    }
    return true;
}

}  // namespace livery
