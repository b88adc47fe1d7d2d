#include "studio/paint_finder.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "appearance/paint_bsdf.h"
#include "appearance/paint_colour.h"
#include "appearance/paint_search.h"
#include "core/colour.h"
#include "core/ten_degree.h"

namespace livery {

std::optional<glm::dvec3> colour_in(const std::string& query) {
    const auto begins = [&](const char* with) { return query.starts_with(with); };
    if (!begins("#") && !begins("lab:") && !begins("xyz:")) return std::nullopt;
    try {
        return parse_colour(query);
    } catch (const std::invalid_argument&) {
        return std::nullopt;
    }
}

glm::dvec3 drawn_face_lab(const Material& paint) {
    const double side = std::sqrt(0.5);
    const glm::dvec3 value = reflectance_of(paint)({side, 0.0, side}, {0.0, 0.0, 1.0});
    return lab10_from_xyz10(xyz10_from_xyz(xyz_from_working() * (std::numbers::pi * value)));
}

std::vector<std::size_t> find_paints(const std::vector<Material>& paints,
                                     const std::string& query,
                                     const std::string& family) {
    const auto wanted = colour_in(query);
    if (!wanted) return search_paints(paints, query, family);
    std::vector<std::size_t> of_family;
    std::vector<glm::dvec3> faces;
    for (std::size_t k = 0; k < paints.size(); ++k) {
        if (!family.empty() && paints[k].family != family) continue;
        of_family.push_back(k);
        faces.push_back(drawn_face_lab(paints[k]));
    }
    std::vector<std::size_t> found;
    for (const NearPaint& near : nearest_colours(faces, *wanted)) {
        if (found.size() < kNearestShown) found.push_back(of_family[near.index]);
    }
    return found;
}

}  // namespace livery
