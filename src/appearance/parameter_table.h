// The parameters that reflectance models read, as data: files, range checks, the panel's controls
// and the docs' table all go by this one table.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "appearance/bsdf_source.h"
#include "appearance/material.h"

namespace livery {

enum class ParameterKind {
    colour,  ///< linear Rec.709 in a material, the working space in BsdfParameters
    number,
    pair  ///< along and across the tangent; one number in a file means both
};

/// The numbers that a parameter consists of, in order; null beyond its last one.
template <typename Real>
using Components = std::array<Real*, 3>;

struct ParameterInfo {
    const char* name;     ///< as in a material file: "coat_alpha"
    const char* label;    ///< "Coat roughness"
    const char* meaning;  ///< a sentence or two
    ParameterKind kind;
    double low, high;  ///< of each number; of a colour: of its channels in the working space
    bool logarithmic;  ///< people choose it by ratios
    Components<double> (*in_material)(Material&);
    Components<const double> (*of_material)(const Material&);
    Components<double> (*in_f64)(f64::BsdfParameters&);
    Components<float> (*in_f32)(f32::BsdfParameters&);
    bool optional;  ///< files may leave it out, and do where it has its default

    int count() const;                 ///< 3, 1 or 2 numbers
    std::string range_text() const;    ///< "0.0001 to 1"
    std::string default_text() const;  ///< of a new Material
};

/// Every parameter of every model, in the order of files and panels.
const std::vector<ParameterInfo>& parameter_table();
/// Throws std::invalid_argument for a name that no model has.
const ParameterInfo& parameter_info(std::string_view name);

/// The numbers of a material's parameter; what lies beyond its last one is 0.
glm::dvec3 value_of(const ParameterInfo& parameter, const Material& material);

/// Whether both have the same model and the same parameters: they look alike.
bool same_reflectance(const Material& a, const Material& b);
/// Model and parameters as numbers: equal for materials that look alike, and for no others.
std::vector<double> reflectance_numbers(const Material& material);

}  // namespace livery
