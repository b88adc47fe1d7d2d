#include "studio/report/report_log.h"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "core/paths.h"

namespace livery {

namespace {

using Path = std::filesystem::path;

/// Of a line that tells of the session, what is left: "command: {"set-paint": …" becomes
/// "command: set-paint". Other lines stay.
std::string without_session(const std::string& line) {
    // "2026-11-28T22:30:00.123Z info command: {"
    constexpr std::size_t before_level = 25;
    const std::size_t text = line.find(' ', std::min(before_level, line.size()));
    if (text == std::string::npos) return line;
    const std::string_view said = std::string_view(line).substr(text + 1);
    for (const char* kind : {"undo:", "redo:"}) {
        if (said.starts_with(kind)) return line.substr(0, text + 1) + kind;
    }
    constexpr std::string_view command = "command: ";
    if (!said.starts_with(command)) return line;
    const std::size_t begin = line.find('"', text), end = line.find('"', begin + 1);
    const bool named = begin != std::string::npos && end != std::string::npos;
    return line.substr(0, text + 1) + std::string(command) +
           (named ? line.substr(begin + 1, end - begin - 1) : "");
}

}  // namespace

std::string log_part(const Path& user_folder, bool with_session, std::size_t most_bytes) {
    const Path newest = user_folder / "log" / "livery.log";
    std::string text = read_text_file(newest);
    for (int number = 1; text.size() < most_bytes; ++number) {
        Path older = newest;
        older += "." + std::to_string(number);
        std::error_code error;
        if (!std::filesystem::exists(older, error)) break;
        text.insert(0, read_text_file(older));
    }
    if (text.size() > most_bytes) {
        const std::size_t line_end = text.find('\n', text.size() - most_bytes - 1);
        text.erase(0, line_end == std::string::npos ? text.size() : line_end + 1);
    }
    if (with_session) return text;
    std::istringstream lines(text);
    std::string kept;
    for (std::string line; std::getline(lines, line);) kept += without_session(line) + '\n';
    return kept;
}

}  // namespace livery
