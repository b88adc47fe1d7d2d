// Which paints a typed text or a colour means, best first.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material.h"

namespace livery {

/// How well a paint's name and family answer what was typed: every word of the query must be found
/// (a name's word before the inside of one, a name before a family, one typing mistake in four or
/// more letters allowed). 0: not at all. An empty query is answered equally by all.
double search_score(const std::string& query, const std::string& name, const std::string& family);

/// Indices of the paints that answer, best first; equals keep their order. `family` empty: any.
std::vector<std::size_t> search_paints(const std::vector<Material>& paints,
                                       const std::string& query,
                                       const std::string& family);

struct NearPaint {
    std::size_t index = 0;
    double de00 = 0.0;  ///< CIEDE2000
};
/// Paints by how far their colour at 45 degrees (five_angle_lab()[kFaceAngle]) is from a colour,
/// nearest first; equals keep their order.
std::vector<NearPaint> nearest_colours(std::span<const glm::dvec3> faces_lab10, glm::dvec3 lab10);

}  // namespace livery
