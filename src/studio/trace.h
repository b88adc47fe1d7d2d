// `--trace FILE`: what happened when, one JSON object a line, so that a script can compute how long
// an input takes to reach the projector.
#pragma once

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string_view>

namespace livery {

/// Default-constructed: writes nothing. Any thread.
class Trace {
  public:
    Trace() = default;
    /// Throws FileError when the file cannot be written.
    explicit Trace(const std::filesystem::path& file);

    /// {"t_s": since the start of the machine's steady clock, "event": ..., "number": ...,
    /// "what": ...}; `what` is left out when empty.
    void write(std::string_view event,
               std::uint64_t number,
               std::string_view what = {},
               std::chrono::steady_clock::time_point at = std::chrono::steady_clock::now());
    explicit operator bool() const { return file_ != nullptr; }

  private:
    std::mutex mutex_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{nullptr, &std::fclose};
};

/// Seconds on the steady clock.
double seconds_of(std::chrono::steady_clock::time_point at);

std::chrono::steady_clock::time_point time_of(double seconds);

double now_s();  ///< seconds_of this moment

}  // namespace livery
