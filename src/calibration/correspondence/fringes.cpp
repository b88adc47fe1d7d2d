#include "calibration/correspondence/fringes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace livery {

double fringe_drive(double place_px, int shift) {
    const double turns = place_px / kFringePeriod_px - static_cast<double>(shift) / kFringeShifts;
    return kFringeDarkest + 0.5 * (kFringeBrightest - kFringeDarkest) *
                                (1.0 + std::cos(2.0 * std::numbers::pi * turns));
}

bool is_fringe_role(const std::string& role) { return role.starts_with("phase-"); }

std::vector<std::string> fringe_roles() {
    std::vector<std::string> roles;
    for (const char* const axis : {"column", "row"})
        for (int shift = 0; shift < kFringeShifts; ++shift)
            roles.push_back(std::string("phase-") + axis + "-" + std::to_string(shift));
    return roles;
}

Pattern fringe_pattern(int width, int height, std::size_t number) {
    check_pattern_size(width, height);
    const std::vector<std::string> roles = fringe_roles();
    check_argument(
        number < roles.size(),
        "fringe_pattern " + std::to_string(number) + " of " + std::to_string(roles.size()));
    const bool columns = number < kFringeShifts;
    const int shift = static_cast<int>(number % kFringeShifts);
    std::vector<std::uint8_t> drive_at;
    for (int place = 0; place < (columns ? width : height); ++place)
        drive_at.push_back(
            static_cast<std::uint8_t>(std::lround(fringe_drive(place + 0.5, shift))));
    Pattern pattern{roles[number], Image8(width, height, 3), {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            std::fill_n(
                pattern.drive.pixel(x, y), 3, drive_at[static_cast<std::size_t>(columns ? x : y)]);
    return pattern;
}

std::vector<std::string> place_roles(PlaceCode code, int width, int height) {
    std::vector<std::string> roles = geometry_roles(width, height);
    if (code == PlaceCode::gray_and_phase)
        for (std::string& role : fringe_roles()) roles.push_back(std::move(role));
    return roles;
}

Pattern place_pattern(PlaceCode code, int width, int height, std::size_t number) {
    const std::size_t gray = geometry_roles(width, height).size();
    const bool fringe = code == PlaceCode::gray_and_phase && number >= gray;
    return fringe ? fringe_pattern(width, height, number - gray)
                  : geometry_pattern(width, height, number);
}

std::vector<Pattern> place_patterns(PlaceCode code, int width, int height) {
    std::vector<Pattern> patterns;
    const std::size_t count = place_roles(code, width, height).size();
    for (std::size_t k = 0; k < count; ++k)
        patterns.push_back(place_pattern(code, width, height, k));
    return patterns;
}

bool check_fringes(const std::filesystem::path& source, const std::vector<std::string>& roles) {
    const std::vector<std::string> wanted = fringe_roles();
    const auto among = [](const std::vector<std::string>& all, const std::string& role) {
        return std::find(all.begin(), all.end(), role) != all.end();
    };
    const std::string expected = "phase-column-0 to -" + std::to_string(kFringeShifts - 1) +
                                 " and phase-row-0 to -" + std::to_string(kFringeShifts - 1);
    bool any = false;
    for (const std::string& role : roles) {
        if (!is_fringe_role(role)) continue;
        any = true;
        if (!among(wanted, role))
            throw FileError(source, "role", role, expected + ", as livery patterns writes them");
    }
    if (!any) return false;
    for (const std::string& role : wanted)
        if (!among(roles, role))
            throw FileError(source,
                            "role",
                            "no photograph of " + role,
                            expected + ", or no photographs of fringes at all");
    return true;
}

}  // namespace livery
