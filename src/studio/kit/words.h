// Values as the panels say them.
#pragma once

#include <optional>
#include <string>

#include <glm/vec3.hpp>

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

/// "#a0b1c2" of linear Rec.709; channels outside [0, 1] are clipped (in_srgb() tells).
std::string hex_of(const glm::dvec3& linear_rec709);
bool in_srgb(const glm::dvec3& linear_rec709);
/// Linear Rec.709 of "#a0b1c2", "a0b1c2" or "#abc"; nothing when it is none of these.
std::optional<glm::dvec3> colour_of_hex(const std::string& text);

}  // namespace livery
