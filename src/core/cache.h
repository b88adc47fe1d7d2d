// What can be worked out again but takes a while: kept in the user's folder under `cache`, named by
// a hash of everything that it was worked out from.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace livery {

inline constexpr std::uintmax_t kLargestCache_bytes = std::uintmax_t{512} << 20u;

/// What was kept as `name`; nothing when it is not there or not as it was written, which the log
/// tells. Never throws over a file.
std::optional<std::string> read_cache(const std::string& name);

/// Keeps it, as long as all that is kept stays under `largest_bytes`: what was not read for longest
/// goes first. A place that cannot be written is told to the log, and nothing else happens.
void write_cache(const std::string& name,
                 std::string_view bytes,
                 std::uintmax_t largest_bytes = kLargestCache_bytes);

}  // namespace livery
