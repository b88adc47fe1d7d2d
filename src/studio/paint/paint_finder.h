// What the search of the library answers: names and families, or a colour.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material.h"
#include "appearance/paint_search.h"

namespace livery {

/// L*a*b* (10 degree observer) of a text that is a colour, as parse_colour() takes it. Nothing for
/// other texts, and for one that is not typed to its end.
std::optional<glm::dvec3> colour_in(const std::string& query);
/// Whether it can be nothing but a colour: "#b01020", "lab:45,30,-20". "gold" may be a paint's
/// name.
bool is_marked_colour(const std::string& query);

/// The colour at 45 degrees as the paint is drawn (five_angle_lab() integrates measured spectra,
/// which takes their file).
glm::dvec3 drawn_face_lab(const Material& paint);

inline constexpr std::size_t kNearestShown = 12;
/// The paints that come nearest to a colour, nearest first, at most so many.
std::vector<NearPaint> find_near_paints(const std::vector<Material>& paints,
                                        const glm::dvec3& lab10,
                                        const std::string& family);
/// As search_paints(); a colour is answered by the paints that come nearest, one that may be a name
/// only where no paint has it.
std::vector<std::size_t> find_paints(const std::vector<Material>& paints,
                                     const std::string& query,
                                     const std::string& family);

}  // namespace livery
