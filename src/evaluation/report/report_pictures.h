// Pictures for a report: small, eight bits, as they are.
#pragma once

#include <filesystem>

#include "core/image.h"

namespace livery {

/// At most `widest` pixels wide, in RGB. Throws FileError: no picture, or one of floating-point
/// numbers, which says nothing of how it looks.
Image8 read_report_picture(const std::filesystem::path& file, int widest = 600);

}  // namespace livery
