#include <algorithm>

#include <fmt/format.h>

#include "appearance/subsurface/radial_profile.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/text/csv.h"

namespace livery {

namespace {

constexpr std::size_t kFewest = 4, kMost = 5000;
constexpr double kFarthest_mm = 1e6, kLargest = 1e15;

}  // namespace

std::vector<ProfileSample> read_profile_csv(const std::filesystem::path& file) {
    return parse_profile_csv(read_text_file(file), file);
}

std::vector<ProfileSample> parse_profile_csv(const std::string& text,
                                             const std::filesystem::path& file) {
    CsvReader csv(text, file);
    const std::size_t radius = csv.column("r_mm", "the columns r_mm and rd");
    const std::size_t value = csv.column("rd", "the columns r_mm and rd");
    std::vector<ProfileSample> samples;
    bool any_light = false;
    while (csv.next()) {
        const ProfileSample sample{csv.number(radius), csv.number(value)};
        if (sample.r_mm < 0.0 || sample.r_mm > kFarthest_mm) {
            csv.fail(radius, "a radius from 0 to 1000000 mm");
        }
        if (sample.rd > kLargest || sample.rd < -kLargest) {
            csv.fail(value, "at most 1e15 per mm^2");
        }
        any_light = any_light || sample.rd > 0.0;
        samples.push_back(sample);
        if (samples.size() > kMost) {
            throw FileError(
                file, csv.place(), "a further row", fmt::format("at most {} rows", kMost));
        }
    }
    if (samples.size() < kFewest) {
        throw FileError(file,
                        "rows",
                        fmt::format("{}", samples.size()),
                        fmt::format("{} or more, each a radius and R_d there", kFewest));
    }
    if (!any_light) throw FileError(file, "rd", "nothing above 0", "reflectance per mm^2");
    std::sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) {
        return a.r_mm < b.r_mm;
    });
    const auto twice = std::adjacent_find(
        samples.begin(), samples.end(), [](auto& a, auto& b) { return a.r_mm == b.r_mm; });
    if (twice != samples.end()) {
        throw FileError(file,
                        "r_mm",
                        fmt::format("{} more than once", twice->r_mm),
                        "each radius once, as the mean of what was measured there");
    }
    return samples;
}

}  // namespace livery
