#include "appearance/fit/colour_record.h"

#include <cstdio>

#include <fmt/format.h>

namespace livery {

namespace {

constexpr const char* kBegin = " [colour asked for: ";

std::string lab_text(const glm::dvec3& lab) {
    return fmt::format("lab:{:.1f},{:.1f},{:.1f}", lab.x, lab.y, lab.z);
}

}  // namespace

std::string text_of(const ColourRecord& record) {
    return fmt::format("{}{}; came out: {}; CIEDE2000 {:.2f}]",
                       kBegin,
                       lab_text(record.asked_lab10),
                       lab_text(record.came_lab10),
                       record.de00);
}

std::optional<ColourRecord> colour_record(const std::string& provenance) {
    const auto begin = provenance.rfind(kBegin);
    if (begin == std::string::npos) return std::nullopt;
    ColourRecord record;
    glm::dvec3 &asked = record.asked_lab10, &came = record.came_lab10;
    int length = 0;
    const int read = std::sscanf(
        provenance.c_str() + begin,
        " [colour asked for: lab:%lf,%lf,%lf; came out: lab:%lf,%lf,%lf; CIEDE2000 %lf]%n",
        &asked.x,
        &asked.y,
        &asked.z,
        &came.x,
        &came.y,
        &came.z,
        &record.de00,
        &length);
    const bool whole =
        read == 7 && begin + static_cast<std::size_t>(length) == provenance.size() && length > 0;
    return whole ? std::optional(record) : std::nullopt;
}

std::string without_colour_record(const std::string& provenance) {
    if (!colour_record(provenance)) return provenance;
    return provenance.substr(0, provenance.rfind(kBegin));
}

}  // namespace livery
