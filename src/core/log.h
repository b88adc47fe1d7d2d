// One log file in the user's folder, rotated; what a person would want to know afterwards.
#pragma once

#include <filesystem>
#include <string_view>

namespace livery {

enum class LogLevel { info, warning, error };

/// Opens `file` for appending; at `max_bytes` it becomes .1, .1 becomes .2, ... up to `kept`. A log
/// that cannot be written never stops the program: the first failure is said once on stderr.
/// Without open_log() log lines go nowhere.
void open_log(const std::filesystem::path& file, std::size_t max_bytes = 1u << 20u, int kept = 4);

/// One line: UTC time, level, text (line breaks become spaces). Any thread; written at once.
void log_line(LogLevel level, std::string_view text);

}  // namespace livery
