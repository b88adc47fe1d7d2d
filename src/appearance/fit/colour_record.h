// What was asked of a paint's colour and what came of it, kept in its provenance.
#pragma once

#include <optional>
#include <string>

#include <glm/vec3.hpp>

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

}  // namespace livery
