// The time of day as files and logs write it, and how long something took.
#pragma once

#include <chrono>
#include <string>

namespace livery {

/// "2026-11-21T08:36:00Z": ISO 8601, UTC.
std::string utc_now();
/// "2026-11-21T08:36:00.123Z".
std::string utc_now_ms();

/// Seconds from `start` to now.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
/// Milliseconds from `start` to now.
inline double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

/// Adds the seconds that a call takes, also where it throws.
template <typename Call>
auto timed(double& seconds, const Call& call) {
    struct Add {
        double& seconds;
        std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
        ~Add() { seconds += seconds_since(start); }
    } add{seconds};
    return call();
}

}  // namespace livery
