// Paints made in a wanted colour, and the record of what was asked and what came of it.
#pragma once

#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "appearance/material.h"

namespace livery {

/// L*a*b* at 45 degrees, D65, 10 degree observer.
struct ColourRecord {
    glm::dvec3 asked_lab10{0.0}, came_lab10{0.0};
    double de00 = 0.0;  ///< CIEDE2000 between them
};

/// " [colour asked for: lab:90.0,-60.0,80.0; came out: lab:73.2,-14.1,51.0; CIEDE2000 23.40]"
std::string text_of(const ColourRecord& record);
/// The one at a provenance's end; none: nobody asked for a colour, or it was changed since.
std::optional<ColourRecord> colour_record(const std::string& provenance);
std::string without_colour_record(const std::string& provenance);

struct Recoloured {
    Material
        material;  ///< named as the finish; its provenance says what was asked for and what came
    double de00 = 0.0;     ///< from the colour asked for to its own, at 45 degrees
    bool reached = false;  ///< within kColourReached
    std::string why_not;   ///< when not reached: "too light for this finish, ..."
};
inline constexpr double kColourReached = 0.5;  ///< CIEDE2000: side by side nobody tells them apart

/// The finish of a paint in another colour: pigment and flakes are tinted alike until the colour at
/// 45 degrees is the wanted one, or as near as they get. Coat, roughness and the interface of
/// plastics stay. Throws std::invalid_argument for measured paint, which has no colour to change,
/// and for a colour that is not finite.
Recoloured with_colour(const Material& finish, glm::dvec3 lab10);

/// The paint in another model, in the colour that its provenance says was asked for, else in the
/// one that it has at 45 degrees. What is measured, or goes through a medium, has no colour to
/// keep.
Material with_model(const Material& paint, ReflectanceModel model);

}  // namespace livery
