#include "studio/words.h"

#include <cctype>
#include <string_view>

#include <fmt/format.h>

namespace livery {

namespace {

/// Whether a text is like a pattern in which 0 stands for any digit.
bool is_like(const std::string& text, std::string_view pattern) {
    if (text.size() != pattern.size()) return false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool digit = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
        if (pattern[i] == '0' ? !digit : text[i] != pattern[i]) return false;
    }
    return true;
}

}  // namespace

std::string milliseconds(double ms) {
    if (ms >= 1000.0) return fmt::format("{:.2f} s", 1e-3 * ms);
    return ms >= 100.0 ? fmt::format("{:.0f} ms", ms) : fmt::format("{:.1f} ms", ms);
}

std::string sentence(std::string text) {
    if (text.empty()) return text;
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    if (std::string_view(".!?:").find(text.back()) == std::string_view::npos) text += '.';
    return text;
}

std::string readable_time(const std::string& iso_8601) {
    if (!is_like(iso_8601, "0000-00-00T00:00:00Z")) return iso_8601;
    return fmt::format("{} {} UTC", iso_8601.substr(0, 10), iso_8601.substr(11, 5));
}

std::string readable_calibration(const std::string& folder_name) {
    if (!is_like(folder_name.substr(0, 21), "0000-00-00T00-00-00Z-")) return folder_name;
    return fmt::format("{} {}:{} · {}",
                       folder_name.substr(0, 10),
                       folder_name.substr(11, 2),
                       folder_name.substr(14, 2),
                       folder_name.substr(21));
}

}  // namespace livery
