#include "appearance/paint_colour.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/vec3.hpp>

#include "appearance/material_library.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/spectrum.h"
#include "core/text/csv.h"

namespace livery {

namespace {

// CSS Color Module Level 4, section 6.1, by name.
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 148> kColours{{
    {"aliceblue", 0xf0f8ff},
    {"antiquewhite", 0xfaebd7},
    {"aqua", 0x00ffff},
    {"aquamarine", 0x7fffd4},
    {"azure", 0xf0ffff},
    {"beige", 0xf5f5dc},
    {"bisque", 0xffe4c4},
    {"black", 0x000000},
    {"blanchedalmond", 0xffebcd},
    {"blue", 0x0000ff},
    {"blueviolet", 0x8a2be2},
    {"brown", 0xa52a2a},
    {"burlywood", 0xdeb887},
    {"cadetblue", 0x5f9ea0},
    {"chartreuse", 0x7fff00},
    {"chocolate", 0xd2691e},
    {"coral", 0xff7f50},
    {"cornflowerblue", 0x6495ed},
    {"cornsilk", 0xfff8dc},
    {"crimson", 0xdc143c},
    {"cyan", 0x00ffff},
    {"darkblue", 0x00008b},
    {"darkcyan", 0x008b8b},
    {"darkgoldenrod", 0xb8860b},
    {"darkgray", 0xa9a9a9},
    {"darkgreen", 0x006400},
    {"darkgrey", 0xa9a9a9},
    {"darkkhaki", 0xbdb76b},
    {"darkmagenta", 0x8b008b},
    {"darkolivegreen", 0x556b2f},
    {"darkorange", 0xff8c00},
    {"darkorchid", 0x9932cc},
    {"darkred", 0x8b0000},
    {"darksalmon", 0xe9967a},
    {"darkseagreen", 0x8fbc8f},
    {"darkslateblue", 0x483d8b},
    {"darkslategray", 0x2f4f4f},
    {"darkslategrey", 0x2f4f4f},
    {"darkturquoise", 0x00ced1},
    {"darkviolet", 0x9400d3},
    {"deeppink", 0xff1493},
    {"deepskyblue", 0x00bfff},
    {"dimgray", 0x696969},
    {"dimgrey", 0x696969},
    {"dodgerblue", 0x1e90ff},
    {"firebrick", 0xb22222},
    {"floralwhite", 0xfffaf0},
    {"forestgreen", 0x228b22},
    {"fuchsia", 0xff00ff},
    {"gainsboro", 0xdcdcdc},
    {"ghostwhite", 0xf8f8ff},
    {"gold", 0xffd700},
    {"goldenrod", 0xdaa520},
    {"gray", 0x808080},
    {"green", 0x008000},
    {"greenyellow", 0xadff2f},
    {"grey", 0x808080},
    {"honeydew", 0xf0fff0},
    {"hotpink", 0xff69b4},
    {"indianred", 0xcd5c5c},
    {"indigo", 0x4b0082},
    {"ivory", 0xfffff0},
    {"khaki", 0xf0e68c},
    {"lavender", 0xe6e6fa},
    {"lavenderblush", 0xfff0f5},
    {"lawngreen", 0x7cfc00},
    {"lemonchiffon", 0xfffacd},
    {"lightblue", 0xadd8e6},
    {"lightcoral", 0xf08080},
    {"lightcyan", 0xe0ffff},
    {"lightgoldenrodyellow", 0xfafad2},
    {"lightgray", 0xd3d3d3},
    {"lightgreen", 0x90ee90},
    {"lightgrey", 0xd3d3d3},
    {"lightpink", 0xffb6c1},
    {"lightsalmon", 0xffa07a},
    {"lightseagreen", 0x20b2aa},
    {"lightskyblue", 0x87cefa},
    {"lightslategray", 0x778899},
    {"lightslategrey", 0x778899},
    {"lightsteelblue", 0xb0c4de},
    {"lightyellow", 0xffffe0},
    {"lime", 0x00ff00},
    {"limegreen", 0x32cd32},
    {"linen", 0xfaf0e6},
    {"magenta", 0xff00ff},
    {"maroon", 0x800000},
    {"mediumaquamarine", 0x66cdaa},
    {"mediumblue", 0x0000cd},
    {"mediumorchid", 0xba55d3},
    {"mediumpurple", 0x9370db},
    {"mediumseagreen", 0x3cb371},
    {"mediumslateblue", 0x7b68ee},
    {"mediumspringgreen", 0x00fa9a},
    {"mediumturquoise", 0x48d1cc},
    {"mediumvioletred", 0xc71585},
    {"midnightblue", 0x191970},
    {"mintcream", 0xf5fffa},
    {"mistyrose", 0xffe4e1},
    {"moccasin", 0xffe4b5},
    {"navajowhite", 0xffdead},
    {"navy", 0x000080},
    {"oldlace", 0xfdf5e6},
    {"olive", 0x808000},
    {"olivedrab", 0x6b8e23},
    {"orange", 0xffa500},
    {"orangered", 0xff4500},
    {"orchid", 0xda70d6},
    {"palegoldenrod", 0xeee8aa},
    {"palegreen", 0x98fb98},
    {"paleturquoise", 0xafeeee},
    {"palevioletred", 0xdb7093},
    {"papayawhip", 0xffefd5},
    {"peachpuff", 0xffdab9},
    {"peru", 0xcd853f},
    {"pink", 0xffc0cb},
    {"plum", 0xdda0dd},
    {"powderblue", 0xb0e0e6},
    {"purple", 0x800080},
    {"rebeccapurple", 0x663399},
    {"red", 0xff0000},
    {"rosybrown", 0xbc8f8f},
    {"royalblue", 0x4169e1},
    {"saddlebrown", 0x8b4513},
    {"salmon", 0xfa8072},
    {"sandybrown", 0xf4a460},
    {"seagreen", 0x2e8b57},
    {"seashell", 0xfff5ee},
    {"sienna", 0xa0522d},
    {"silver", 0xc0c0c0},
    {"skyblue", 0x87ceeb},
    {"slateblue", 0x6a5acd},
    {"slategray", 0x708090},
    {"slategrey", 0x708090},
    {"snow", 0xfffafa},
    {"springgreen", 0x00ff7f},
    {"steelblue", 0x4682b4},
    {"tan", 0xd2b48c},
    {"teal", 0x008080},
    {"thistle", 0xd8bfd8},
    {"tomato", 0xff6347},
    {"turquoise", 0x40e0d0},
    {"violet", 0xee82ee},
    {"wheat", 0xf5deb3},
    {"white", 0xffffff},
    {"whitesmoke", 0xf5f5f5},
    {"yellow", 0xffff00},
    {"yellowgreen", 0x9acd32},
}};

/// Linear Rec.709 of "tomato", in lower case; nothing for another name.
std::optional<glm::dvec3> css_colour(std::string_view name) {
    const auto found = std::lower_bound(
        kColours.begin(), kColours.end(), name, [](const auto& colour, std::string_view wanted) {
            return colour.first < wanted;
        });
    if (found == kColours.end() || found->first != name) return std::nullopt;
    const auto channel = [&](unsigned shift) {
        return srgb_decode((found->second >> shift & 0xffu) / 255.0);
    };
    return glm::dvec3(channel(16), channel(8), channel(0));
}

constexpr std::size_t kLargestChips_bytes = std::size_t{1} << 24u;
constexpr std::size_t kMostChips = 100'000;

constexpr const char* kColourForms =
    "#RRGGBB, #RGB, rgb(R, G, B), a colour's name in CSS, lab:L,a,b or xyz:X,Y,Z (D65, 10 degree "
    "observer, white has Y = 100)";
constexpr const char* kChipColumns = "a column name and either L, a, b or X, Y, Z or hex";

struct Range {
    double low, high;
};
/// Effect paints are lighter than white beside their highlight.
constexpr std::array<Range, 3> kLabRanges{{{0.0, 200.0}, {-200.0, 200.0}, {-200.0, 200.0}}};
constexpr std::array<Range, 3> kXyzRanges{{{0.0, 500.0}, {0.0, 500.0}, {0.0, 500.0}}};
constexpr std::array kLabNames{"L", "a", "b"}, kXyzNames{"X", "Y", "Z"};

std::string lower(std::string_view text) {
    std::string small(text);
    for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return small;
}

glm::dvec3 lab10_from_rec709(const glm::dvec3& linear) {
    return lab10_from_xyz10(xyz10_from_xyz(xyz_from_rec709() * linear));
}

/// Six digits with or without "#"; three only with it, or "bad" would be a colour.
std::optional<glm::dvec3> lab10_from_hex(std::string_view text) {
    const bool marked = text.starts_with('#');
    if (marked) text.remove_prefix(1);
    std::string six;
    if (marked && text.size() == 3) {
        for (const char c : text) six += {c, c};
        text = six;
    }
    const bool digits = text.size() == 6 && std::all_of(text.begin(), text.end(), [](char c) {
                            return std::isxdigit(static_cast<unsigned char>(c)) != 0;
                        });
    if (!digits) return std::nullopt;
    glm::dvec3 rec709(0.0);
    for (int c = 0; c < 3; ++c) {
        unsigned value = 0;
        const char* begin = text.data() + 2 * c;
        std::from_chars(begin, begin + 2, value, 16);
        rec709[c] = srgb_decode(value / 255.0);
    }
    return lab10_from_rec709(rec709);
}

/// "45,30,-20" in ranges; throws std::invalid_argument about `text`.
glm::dvec3 parse_three(const std::string& text,
                       std::string_view numbers,
                       const std::array<const char*, 3>& names,
                       const std::array<Range, 3>& ranges) {
    glm::dvec3 values(0.0);
    for (int c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(c);
        const std::size_t comma = numbers.find(',');
        check_argument((comma == std::string_view::npos) == (c == 2),
                       fmt::format("colour '{}': expected three numbers, {}", text, kColourForms));
        std::string_view cell = numbers.substr(0, comma);
        while (cell.starts_with(' ')) cell.remove_prefix(1);
        while (cell.ends_with(' ')) cell.remove_suffix(1);
        if (cell.starts_with('+')) cell.remove_prefix(1);
        const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), values[c]);
        check_argument(read.ec == std::errc() && read.ptr == cell.data() + cell.size() &&
                           values[c] >= ranges[i].low && values[c] <= ranges[i].high,
                       fmt::format("colour '{}': {} is '{}', expected a number from {} to {}",
                                   text,
                                   names[i],
                                   cell,
                                   ranges[i].low,
                                   ranges[i].high));
        if (c < 2) numbers.remove_prefix(comma + 1);
    }
    return values;
}

/// "rgb(26, 79, 156)" or "rgb(26 79 156)", 0 to 255 each, or all in percent.
glm::dvec3 parse_rgb(const std::string& text, std::string_view numbers) {
    constexpr std::array kRgbNames{"R", "G", "B"};
    constexpr std::array<Range, 3> kBytes{{{0.0, 255.0}, {0.0, 255.0}, {0.0, 255.0}}};
    constexpr std::array<Range, 3> kPercents{{{0.0, 100.0}, {0.0, 100.0}, {0.0, 100.0}}};
    numbers.remove_suffix(1);
    std::string listed(numbers);
    const auto percents = std::count(listed.begin(), listed.end(), '%');
    check_argument(percents == 0 || percents == 3,
                   fmt::format("colour '{}': expected three numbers, {}", text, kColourForms));
    std::erase(listed, '%');
    if (listed.find(',') == std::string::npos) {
        // CSS writes spaces as well: one comma for each run of them between numbers.
        const auto first = listed.find_first_not_of(' '), last = listed.find_last_not_of(' ');
        if (first != std::string::npos) listed = listed.substr(first, last - first + 1);
        const auto end = std::unique(
            listed.begin(), listed.end(), [](char a, char b) { return a == ' ' && b == ' '; });
        listed.erase(end, listed.end());
        std::replace(listed.begin(), listed.end(), ' ', ',');
    }
    glm::dvec3 rgb = parse_three(text, listed, kRgbNames, percents == 0 ? kBytes : kPercents);
    for (int c = 0; c < 3; ++c) rgb[c] = srgb_decode(rgb[c] / (percents == 0 ? 255.0 : 100.0));
    return lab10_from_rec709(rgb);
}

/// Columns of chips, however they are written: "L", "l*", "L*".
std::optional<std::size_t> find_column(const CsvReader& csv, const std::string& name) {
    for (std::size_t i = 0; i < csv.names().size(); ++i) {
        std::string found = lower(csv.names()[i]);
        if (found.ends_with('*')) found.pop_back();
        if (found == lower(name)) return i;
    }
    return std::nullopt;
}

/// How a table writes its colours.
struct ChipColumns {
    std::size_t name = 0;
    std::optional<std::array<std::size_t, 3>> lab, xyz;
    std::optional<std::size_t> hex;
};

ChipColumns chip_columns(const CsvReader& csv, const std::filesystem::path& file) {
    const auto fail = [&](const std::string& found, const std::string& expected) {
        throw FileError(file, "header", found, expected);
    };
    using Columns = std::array<std::size_t, 3>;
    const auto all = [&](const std::array<const char*, 3>& names) -> std::optional<Columns> {
        Columns columns{};
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const auto at = find_column(csv, names[k]);
            if (!at) return std::nullopt;
            columns[k] = *at;
        }
        return columns;
    };
    ChipColumns columns;
    const auto name = find_column(csv, "name");
    columns.lab = all(kLabNames);
    columns.xyz = all(kXyzNames);
    columns.hex = find_column(csv, "hex");
    const int kinds = columns.lab.has_value() + columns.xyz.has_value() + columns.hex.has_value();
    if (!name) fail("no column name", kChipColumns);
    if (kinds != 1) {
        fail(kinds == 0 ? "no colours" : fmt::format("colours in {} forms", kinds), kChipColumns);
    }
    if (columns.hex == std::size_t{0}) {
        fail("hex as the first column", "another first: a line that starts with # is a comment");
    }
    columns.name = *name;
    return columns;
}

glm::dvec3 read_three(const CsvReader& csv,
                      const std::array<std::size_t, 3>& columns,
                      const std::array<Range, 3>& ranges) {
    glm::dvec3 values(0.0);
    for (int c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(c);
        values[c] = csv.number(columns[i]);
        if (values[c] < ranges[i].low || values[c] > ranges[i].high) {
            csv.fail(columns[i],
                     fmt::format("a number from {} to {}", ranges[i].low, ranges[i].high));
        }
    }
    return values;
}

glm::dvec3 read_chip_colour(const CsvReader& csv, const ChipColumns& columns) {
    if (columns.lab) return read_three(csv, *columns.lab, kLabRanges);
    if (columns.xyz) return lab10_from_xyz10(0.01 * read_three(csv, *columns.xyz, kXyzRanges));
    const auto lab = lab10_from_hex(csv.text(*columns.hex));
    if (!lab) csv.fail(*columns.hex, "six hexadecimal digits, as #b01020");
    return *lab;
}

}  // namespace

glm::dvec3 parse_colour(const std::string& text) {
    const std::string small = lower(text);
    const std::string_view rest =
        std::string_view(small).substr(std::min<std::size_t>(4, small.size()));
    if (small.starts_with("lab:")) return parse_three(text, rest, kLabNames, kLabRanges);
    if (small.starts_with("xyz:")) {
        return lab10_from_xyz10(0.01 * parse_three(text, rest, kXyzNames, kXyzRanges));
    }
    if (small.starts_with("rgb(") && small.ends_with(')')) return parse_rgb(text, rest);
    if (const auto lab = lab10_from_hex(small)) return *lab;
    if (const auto linear = css_colour(small)) return lab10_from_rec709(*linear);
    throw std::invalid_argument(fmt::format("colour '{}': expected {}", text, kColourForms));
}

std::vector<ColourChip> read_colour_chips(const std::filesystem::path& file) {
    return parse_colour_chips(read_text_file(file, kLargestChips_bytes), file);
}

std::vector<ColourChip> parse_colour_chips(const std::string& text,
                                           const std::filesystem::path& file) {
    CsvReader csv(text, file);
    const ChipColumns columns = chip_columns(csv, file);
    std::vector<ColourChip> chips;
    std::set<std::string> names;
    while (csv.next()) {
        if (chips.size() == kMostChips) {
            throw FileError(file, csv.place(), "more chips", fmt::format("at most {}", kMostChips));
        }
        ColourChip chip{std::string(csv.text(columns.name)), read_chip_colour(csv, columns)};
        if (chip.name.empty()) csv.fail(columns.name, "a name");
        if (!names.insert(plain_paint_name(chip.name)).second) {
            csv.fail(columns.name, "a name that no chip above has");
        }
        chips.push_back(std::move(chip));
    }
    if (chips.empty()) throw FileError(file, "", "no chips", "a row for each");
    return chips;
}

const ColourChip& chip_named(const std::vector<ColourChip>& chips, const std::string& name) {
    const auto found = std::find_if(chips.begin(), chips.end(), [&](const ColourChip& chip) {
        return same_paint_name(chip.name, name);
    });
    if (found != chips.end()) return *found;
    constexpr std::size_t kShown = 8;
    std::vector<std::string> names;
    for (const ColourChip& chip : chips) {
        if (names.size() < kShown) names.push_back("'" + chip.name + "'");
    }
    throw std::invalid_argument(fmt::format("no chip named '{}' among {}: {}{}",
                                            name,
                                            chips.size(),
                                            fmt::join(names, ", "),
                                            chips.size() > kShown ? ", ..." : ""));
}

}  // namespace livery
