// Colours as people who mix paint write them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace livery {

/// "#b01020", "b01020", "#b12", "rgb(176, 16, 32)" or a CSS name such as "tomato" (all sRGB),
/// "lab:45,30,-20" or "xyz:20.1,15.2,5" (both D65 and 10 degree observer, white has Y = 100), as
/// L*a*b* of the 10 degree observer. Throws std::invalid_argument that says what was found and
/// expected.
glm::dvec3 parse_colour(const std::string& text);

struct ColourChip {
    std::string name;
    glm::dvec3 lab10{0.0};
};
/// A CSV with a column `name` and either L, a, b or X, Y, Z or hex, in any order among others,
/// written as parse_colour() takes them. Throws FileError with the line and the column.
std::vector<ColourChip> read_colour_chips(const std::filesystem::path& file);
/// The same of its text.
std::vector<ColourChip> parse_colour_chips(const std::string& text,
                                           const std::filesystem::path& file);
/// By name; case, hyphens and underlines do not matter. Throws std::invalid_argument with the
/// names that there are.
const ColourChip& chip_named(const std::vector<ColourChip>& chips, const std::string& name);

}  // namespace livery
