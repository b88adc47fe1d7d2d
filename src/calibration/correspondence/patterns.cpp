#include "calibration/correspondence/patterns.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "core/error.h"
#include "core/random.h"

namespace livery {

namespace {

using Drive = std::array<std::uint8_t, 3>;

template <typename DriveOf>
Image8 draw(int width, int height, const DriveOf& drive_of) {
    Image8 picture(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Drive drive = drive_of(x, y);
            std::copy(drive.begin(), drive.end(), picture.pixel(x, y));
        }
    return picture;
}

Pattern uniform(std::string role, int width, int height, int red, int green, int blue) {
    const Drive drive{static_cast<std::uint8_t>(red),
                      static_cast<std::uint8_t>(green),
                      static_cast<std::uint8_t>(blue)};
    return {
        std::move(role), draw(width, height, [&](int, int) { return drive; }), {red, green, blue}};
}

/// Even, so that centres stay centred; forty blocks across the picture or more. A centre five
/// pixels from the border is out of reach of the halo that a good lens throws around a bright
/// block.
int block_size(int width) { return std::clamp(width / 80 * 2, 8, 16); }

/// A number for a block of the grey levels' picture: each of 0 to 255 once in 16 x 16, shuffled
/// (Fisher and Yates), otherwise in each such tile.
int shuffled_rank(int block_x, int block_y) {
    std::array<std::uint8_t, 256> order{};
    std::iota(order.begin(), order.end(), std::uint8_t{0});
    const auto tile_x = static_cast<std::uint32_t>(block_x / 16);
    const auto tile_y = static_cast<std::uint32_t>(block_y / 16);
    for (std::uint32_t k = 255; k > 0; --k) {
        std::swap(order[k], order[hash_3d(tile_x, tile_y, k) % (k + 1)]);
    }
    return order[static_cast<std::size_t>(block_y % 16 * 16 + block_x % 16)];
}

/// A quarter black, a sixteenth white; the rest rise with the power 1.5 from 1 to 254: light grows
/// with the drive's square, so that dark levels need more samples for the same relative error.
std::uint8_t level_of_block(int block_x, int block_y) {
    constexpr int kBlack = 64, kWhite = 16, kBetween = 256 - kBlack - kWhite;
    const int rank = shuffled_rank(block_x, block_y);
    if (rank < kBlack) return 0;
    if (rank >= kBlack + kBetween) return 255;
    const double place = static_cast<double>(rank - kBlack) / (kBetween - 1);
    return static_cast<std::uint8_t>(std::lround(1.0 + 253.0 * std::pow(place, 1.5)));
}

/// Order in which an ordered dither fills a 16 x 16 tile: any 2^k x 2^k blocks that touch hold
/// evenly spread values.
int dither_rank(int block_x, int block_y) {
    int rank = 0;
    for (int bit = 0; bit < 4; ++bit) {
        const int x = (block_x >> bit) & 1, y = (block_y >> bit) & 1;
        rank = rank * 4 + 2 * (x ^ y) + y;
    }
    return rank;
}

double radical_inverse(int index, int base) {
    double value = 0.0, digit = 1.0;
    for (; index > 0; index /= base) {
        digit /= base;
        value += digit * (index % base);
    }
    return value;
}

std::uint8_t level(double fraction) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(fraction * 255.0), 0L, 255L));
}

/// Colour of one block of a mosaic. Sixteen kinds share every 4 x 4 blocks; within a kind the
/// colours follow a low-discrepancy sequence over all pictures.
Drive mosaic_drive(int kind, int index) {
    // Corners first: they are the ends of every ramp.
    const std::uint8_t up = level(radical_inverse(index + 1, 2) * 1.0079);
    switch (kind) {
        case 0:
            return {up, 0, 0};
        case 1:
            return {0, up, 0};
        case 2:
            return {0, 0, up};
        case 3:
            return {up, up, 0};
        case 4:
            return {0, up, up};
        case 5:
            return {up, 0, up};
        case 6:
            return {up, up, up};
        case 7: {
            const int corner = index % 8;
            return {level(corner & 1), level((corner >> 1) & 1), level(corner >> 2)};
        }
        default:
            break;
    }
    // Stretched beyond the cube, so that its faces are sampled and not only approached.
    const auto stretched = [&](int base) {
        return level(radical_inverse(index * 8 + kind - 7, base) * 1.2 - 0.1);
    };
    return {stretched(2), stretched(3), stretched(5)};
}

}  // namespace

void check_pattern_size(int width, int height) {
    check_argument(width >= 2 && width <= 16384 && height >= 2 && height <= 16384,
                   "projector size " + std::to_string(width) + "x" + std::to_string(height) +
                       " is outside 2..16384");
}

int gray_code_bits(int count) {
    return std::max(1, static_cast<int>(std::bit_width(static_cast<unsigned>(count - 1))));
}

std::vector<std::string> geometry_roles(int width, int height) {
    std::vector<std::string> roles;
    const auto add_axis = [&](const std::string& axis, int count) {
        for (int bit = 0; bit < gray_code_bits(count); ++bit) {
            roles.push_back("gray-" + axis + "-" + std::to_string(bit));
            roles.push_back(roles.back() + "-inverse");
        }
    };
    add_axis("column", width);
    add_axis("row", height);
    roles.insert(roles.end(), {"white", "black"});
    return roles;
}

Pattern geometry_pattern(int width, int height, std::size_t number) {
    check_pattern_size(width, height);
    const std::vector<std::string> roles = geometry_roles(width, height);
    check_argument(
        number < roles.size(),
        "geometry_pattern " + std::to_string(number) + " of " + std::to_string(roles.size()));
    const std::string& role = roles[number];
    if (role == "white") return uniform(role, width, height, 255, 255, 255);
    if (role == "black") return uniform(role, width, height, 0, 0, 0);
    const std::size_t of_columns = 2 * static_cast<std::size_t>(gray_code_bits(width));
    const bool columns = number < of_columns, inverse = number % 2 == 1;
    const int bit = static_cast<int>((columns ? number : number - of_columns) / 2);
    const int shift = gray_code_bits(columns ? width : height) - 1 - bit;
    const auto drive_of = [&](int x, int y) {
        const int place = columns ? x : y;
        const bool set = (((place ^ (place >> 1)) >> shift) & 1) != 0;
        const std::uint8_t value = set != inverse ? 255 : 0;
        return Drive{value, value, value};
    };
    return {role, draw(width, height, drive_of), {}};
}

std::vector<Pattern> geometry_patterns(int width, int height) {
    check_pattern_size(width, height);
    std::vector<Pattern> patterns;
    for (std::size_t k = 0; k < geometry_roles(width, height).size(); ++k)
        patterns.push_back(geometry_pattern(width, height, k));
    return patterns;
}

std::vector<Pattern> colour_patterns(int width, int height, int dark_drive, int bright_drive) {
    check_pattern_size(width, height);
    check_argument(dark_drive >= 0 && dark_drive < bright_drive && bright_drive <= 255,
                   "drives s = " + std::to_string(dark_drive) +
                       ", t = " + std::to_string(bright_drive) + " are not 0 <= s < t <= 255");
    const int s = dark_drive, t = bright_drive;
    std::vector<Pattern> patterns;
    patterns.push_back(uniform("dark-gray", width, height, s, s, s));
    patterns.push_back(uniform("bright-gray", width, height, t, t, t));
    patterns.push_back(uniform("red", width, height, t, s, s));
    patterns.push_back(uniform("green", width, height, s, t, s));
    patterns.push_back(uniform("blue", width, height, s, s, t));
    const int block = block_size(width);
    const int columns = (width + block - 1) / block, rows = (height + block - 1) / block;
    std::vector<std::uint8_t> levels;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) levels.push_back(level_of_block(x, y));
    patterns.push_back(
        {"gray-levels",
         draw(width,
              height,
              [&](int x, int y) {
                  const auto value =
                      levels[static_cast<std::size_t>(y / block * columns + x / block)];
                  return Drive{value, value, value};
              }),
         {}});
    return patterns;
}

std::vector<Pattern> mosaic_patterns(int width, int height, int count) {
    check_pattern_size(width, height);
    check_argument(count >= 1 && count <= 64,
                   "mosaic count " + std::to_string(count) + " is outside 1..64");
    const int block = block_size(width);
    std::vector<Pattern> patterns;
    for (int picture = 0; picture < count; ++picture) {
        const auto drive_of = [&](int x, int y) {
            // The kinds move on from picture to picture: each place shows several.
            const int rank = dither_rank(x / block, y / block);
            const int kind = (rank / 16 + 3 * picture) % 16;
            return mosaic_drive(kind, (rank % 16) * count + picture);
        };
        patterns.push_back(
            {"colors-" + std::to_string(picture), draw(width, height, drive_of), {}});
    }
    return patterns;
}

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
