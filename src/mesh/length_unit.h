// What one unit of a mesh file's numbers is: asked for, or told from the size.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace livery {

enum class LengthUnit { mm, cm, m, in };

const char* to_string(LengthUnit unit);
double mm_per(LengthUnit unit);
/// "mm", "cm", "m" or "in"; nothing for any other text.
std::optional<LengthUnit> parse_length_unit(std::string_view text);

/// What the numbers of a file that states no unit are taken as, and why, in a sentence. Scans come
/// in millimetres, rarely in metres; centimetres and inches are never guessed, only pointed out
/// where they would make a product of usual size as well.
struct UnitGuess {
    LengthUnit unit = LengthUnit::mm;
    std::string why;
};
UnitGuess guess_unit(double longest_side);

}  // namespace livery
