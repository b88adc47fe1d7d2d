// Values as the panels say them.
#pragma once

#include <string>

namespace livery {

/// As people write it: 19650 is "19,650", 0.04251 "0.04251", 12.0 "12"; four digits below 1,000,
/// whole numbers above.
std::string readable_number(double value);

/// "12.3 ms", "4.87 s".
std::string milliseconds(double ms);

/// Begins with a capital and ends with a full stop.
std::string sentence(std::string text);

/// "2026-11-21T09:16:05Z" -> "2026-11-21 09:16 UTC". Other texts stay as they are.
std::string readable_time(const std::string& iso_8601);

/// A kept calibration's folder, "2026-11-21T09-16-13Z-397cfee1" -> "2026-11-21 09:16 · 397cfee1".
/// Other names stay as they are.
std::string readable_calibration(const std::string& folder_name);

}  // namespace livery
