// The colours that have a name in CSS: what people know by heart.
#pragma once

#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

namespace livery {

/// Linear Rec.709 of "tomato", in lower case; nothing for another name.
std::optional<glm::dvec3> css_colour(std::string_view name);

}  // namespace livery
