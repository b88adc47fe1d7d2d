// What the search of the library answers: names and families, or a colour.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material.h"

namespace livery {

/// L*a*b* (10 degree observer) of a text that is a colour: "#b01020", "lab:45,30,-20", "xyz:...".
/// Nothing for other texts, and for one that is not typed to its end.
std::optional<glm::dvec3> colour_in(const std::string& query);

/// The colour at 45 degrees as the paint is drawn (five_angle_lab() integrates measured spectra,
/// which takes their file).
glm::dvec3 drawn_face_lab(const Material& paint);

inline constexpr std::size_t kNearestShown = 12;
/// As search_paints(); a colour is answered by the paints that come nearest, at most so many.
std::vector<std::size_t> find_paints(const std::vector<Material>& paints,
                                     const std::string& query,
                                     const std::string& family);

}  // namespace livery
