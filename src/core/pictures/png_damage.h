// A PNG's chunks, looked at before libpng is. For the picture module and its tests.
#pragma once

#include <istream>
#include <string>

namespace livery {

/// What is wrong with a PNG's chunks, or nothing. Asked first because libpng, behind OpenImageIO,
/// prints its complaints on stderr by itself.
std::string png_damage(std::istream& stream);

}  // namespace livery
