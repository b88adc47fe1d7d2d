#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "core/colour.h"
#include "studio/kit/widgets.h"

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

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

std::string readable_number(double value) {
    const double size = std::abs(value);
    if (!std::isfinite(value)) return fmt::format("{}", value);
    if (size >= 1e15 || (size > 0.0 && size < 1e-6)) return fmt::format("{:.3g}", value);
    if (size < 999.95) {
        // Four digits that count, without zeros at the end.
        const int whole = size < 1.0 ? 0 : static_cast<int>(std::floor(std::log10(size))) + 1;
        const int leading =
            size > 0.0 && size < 1.0 ? -static_cast<int>(std::floor(std::log10(size))) - 1 : 0;
        std::string text = fmt::format("{:.{}f}", value, std::max(0, 4 - whole + leading));
        if (text.find('.') == std::string::npos) return text;
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
        return text == "-0" ? "0" : text;
    }
    std::string text = fmt::format("{:.0f}", value);
    const std::size_t first = text.front() == '-' ? 1 : 0;
    for (std::size_t at = text.size(); at > first + 3;) {
        at -= 3;
        text.insert(at, 1, ',');
    }
    return text;
}

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

bool in_srgb(const glm::dvec3& linear_rec709) {
    for (int c = 0; c < 3; ++c) {
        if (!(linear_rec709[c] >= 0.0 && linear_rec709[c] <= 1.0)) return false;
    }
    return true;
}

std::string hex_of(const glm::dvec3& linear_rec709) {
    std::string text = "#";
    for (int c = 0; c < 3; ++c) {
        const double encoded = srgb_encode(std::clamp(linear_rec709[c], 0.0, 1.0));
        text += fmt::format("{:02x}", static_cast<int>(std::lround(255.0 * encoded)));
    }
    return text;
}

std::optional<glm::dvec3> colour_of_hex(const std::string& text) {
    std::string digits = text;
    digits.erase(std::remove(digits.begin(), digits.end(), ' '), digits.end());
    if (!digits.empty() && digits.front() == '#') digits.erase(0, 1);
    if (digits.size() == 3) {
        digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
    }
    if (digits.size() != 6) return std::nullopt;
    glm::dvec3 colour;
    for (std::size_t c = 0; c < 3; ++c) {
        const int high = hex_digit(digits[2 * c]), low = hex_digit(digits[2 * c + 1]);
        if (high < 0 || low < 0) return std::nullopt;
        colour[static_cast<int>(c)] = srgb_decode((16 * high + low) / 255.0);
    }
    return colour;
}

}  // namespace livery
