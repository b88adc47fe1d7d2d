// What a person reads and types of a paint. The parameters themselves: parameter_table.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material_library.h"
#include "appearance/parameter_table.h"

namespace livery {

/// "nm", or nothing, by the parameter's name.
std::string unit_of(const ParameterInfo& parameter);

/// "Clear coat", and the model's parameters that are not at their usual value, a line each.
std::string summary_of(const Material& material);

/// Why a paint cannot be drawn (a colour outside the working space); nothing when it can.
std::optional<std::string> paint_problem(const Material& material);

/// The library's paint that a session's own began as: "solid red 2" -> "solid red". Null: none.
const Material* library_origin(const std::string& name, const PaintLibrary& library);

}  // namespace livery
