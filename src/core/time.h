// The time of day as files and logs write it, and how long something took.
#pragma once

#include <chrono>
#include <string>

namespace livery {

/// "2026-11-21T08:36:00Z": ISO 8601, UTC.
std::string utc_now();
/// "2026-11-21T08:36:00.123Z".
std::string utc_now_ms();

/// Milliseconds from `start` to now.
inline double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

}  // namespace livery
