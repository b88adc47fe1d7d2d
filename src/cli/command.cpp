#include "cli/command.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace livery {

namespace {

/// Reads one number at `text`, independent of the locale; advances `text`.
double take_number(const std::string& option, const std::string& whole, std::string_view& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !std::isfinite(value)) {
        throw std::invalid_argument(option + ": found \"" + whole + "\", expected finite numbers");
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

}  // namespace

GlDevice CommonOptions::gl_device() const {
    if (gl == "software") return GlDevice::software;
    if (gl == "hardware") return GlDevice::hardware;
    return GlDevice::automatic;
}

void report_refusal(const Refused& refused, Outcome& outcome) {
    outcome.exit_code = 1;
    outcome.figures["refused"] = {{{"why", refused.why()}, {"fix", refused.fix()}}};
    outcome.text += fmt::format("refused: {}\nfix: {}\n", refused.why(), refused.fix());
}

glm::ivec2 parse_size(const std::string& option, const std::string& text) {
    glm::ivec2 size{0};
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, size.x);
    const bool has_cross = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
    const auto second = has_cross ? std::from_chars(first.ptr + 1, end, size.y) : first;
    if (!has_cross || second.ec != std::errc() || second.ptr != end || size.x < 16 || size.y < 16 ||
        size.x > 16384 || size.y > 16384) {
        throw std::invalid_argument(option + ": found \"" + text +
                                    "\", expected WIDTHxHEIGHT in pixels, 16 to 16384 a side");
    }
    return size;
}

std::optional<LengthUnit> parse_unit(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const auto unit = parse_length_unit(text);
    if (unit) return unit;
    throw std::invalid_argument("--unit: found \"" + text + "\", expected mm, cm, m or in");
}

Option unit_option(std::string& target) {
    return {
        "--unit",
        "UNIT",
        "unit of the product file's numbers: mm, cm, m or in (default: as it says, or its size)",
        &target,
        false,
        {"mm", "cm", "m", "in"}};
}

void tell_notes(const std::vector<std::string>& notes, Outcome& outcome) {
    if (!notes.empty()) outcome.figures["notes"] = notes;
    for (const std::string& note : notes) outcome.text += "note: " + note + "\n";
}

std::vector<double> parse_numbers(const std::string& option,
                                  const std::string& text,
                                  std::size_t count) {
    std::vector<double> values;
    std::string_view rest = text;
    while (true) {
        values.push_back(take_number(option, text, rest));
        if (rest.empty()) break;
        if (rest.front() != ',') {
            throw std::invalid_argument(option + ": found \"" + text + "\", expected commas");
        }
        rest.remove_prefix(1);
    }
    if (count != 0 && values.size() != count) {
        throw std::invalid_argument(option + ": found " + std::to_string(values.size()) +
                                    " numbers, expected " + std::to_string(count));
    }
    return values;
}

void check_percentile(const std::string& option, double value) {
    if (value < 0.0 || value > 100.0) {
        throw std::invalid_argument(
            fmt::format("{}: found {}, expected a percentile, 0 to 100", option, value));
    }
}

}  // namespace livery
