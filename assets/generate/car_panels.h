// Where the car's skin is cut: windows, lamps, intakes, doors, lids.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "sheet.h"

namespace livery::assets {

enum CarPart { kBody, kGlass, kRims, kTyres, kLights, kTrim, kCarParts };

inline constexpr double kFrontAxle_mm = 57.5;
inline constexpr double kRearAxle_mm = -54.5;
inline constexpr double kAxleHeight_mm = 14.5;
inline constexpr double kArchRadius_mm = 15.7;
inline constexpr double kWellDepth_mm = 25.5;  ///< z of the wheel wells' inner wall

/// Cuts a fresh sheet of the car's skin into panels; returns the style of each.
std::vector<PanelStyle> cut_car_panels(Sheet& sheet);

/// The wheel arches' flare, added to z: how far the skin bulges around them, and its gradient in
/// (x, y).
struct Flare {
    double height_mm = 0.0;
    glm::dvec2 gradient{0.0};
};
Flare arch_flare(const glm::dvec2& side_view);

}  // namespace livery::assets
