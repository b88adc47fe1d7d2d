// The time of day as files and logs write it.
#pragma once

#include <string>

namespace livery {

/// "2026-11-21T08:36:00Z": ISO 8601, UTC.
std::string utc_now();
/// "2026-11-21T08:36:00.123Z".
std::string utc_now_ms();

}  // namespace livery
