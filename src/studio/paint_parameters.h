// What the parameters of a paint mean to a person: one table for the panel, its tooltips and the
// paints' own tooltips (docs/materials.md says the same).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material_library.h"

namespace livery {

struct ParameterText {
    const char* name;     ///< as in a material file: "coat_alpha"
    const char* label;    ///< "Coat roughness"
    const char* range;    ///< as in the docs' table
    const char* meaning;  ///< a sentence or two
};
/// Throws std::invalid_argument for a name that no model has.
const ParameterText& parameter_text(const std::string& name);
/// Names of a model's parameters, in the order of the panel.
const std::vector<std::string>& parameters_of_model(ReflectanceModel model);

struct ModelText {
    const char* name;     ///< "clearcoat"
    const char* label;    ///< "Clear coat"
    const char* meaning;  ///< a sentence
};
const ModelText& model_text(ReflectanceModel model);

/// "diffuse 0.45 0.02 0.02, roughness 0.24": the model's main parameters on a few lines.
std::string summary_of(const Material& material);

/// Why a paint cannot be drawn (a colour outside the working space); nothing when it can.
std::optional<std::string> paint_problem(const Material& material);

/// "#a0b1c2" of linear Rec.709; channels outside [0, 1] are clipped (in_srgb() tells).
std::string hex_of(const glm::dvec3& linear_rec709);
bool in_srgb(const glm::dvec3& linear_rec709);
/// Linear Rec.709 of "#a0b1c2", "a0b1c2" or "#abc"; nothing when it is none of these.
std::optional<glm::dvec3> colour_of_hex(const std::string& text);

/// The library's paint that a session's own began as: "solid red 2" -> "solid red". Null: none.
const Material* library_origin(const std::string& name, const PaintLibrary& library);

}  // namespace livery
