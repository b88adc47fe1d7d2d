#include "studio/paint/paint_finder.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "appearance/paint_bsdf.h"
#include "appearance/paint_colour.h"
#include "core/colour.h"
#include "core/ten_degree.h"

namespace livery {

std::optional<glm::dvec3> colour_in(const std::string& query) {
    try {
        return parse_colour(query);
    } catch (const std::invalid_argument&) {
        return std::nullopt;
    }
}

bool is_marked_colour(const std::string& query) {
    const auto begins = [&](std::string_view with) {
        return std::equal(
            with.begin(),
            with.end(),
            query.begin(),
            query.begin() + static_cast<std::ptrdiff_t>(std::min(with.size(), query.size())),
            [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
    };
    return (begins("#") || begins("lab:") || begins("xyz:") || begins("rgb(")) &&
           colour_in(query).has_value();
}

glm::dvec3 drawn_face_lab(const Material& paint) {
    const double side = std::sqrt(0.5);
    const glm::dvec3 value = reflectance_of(paint)({side, 0.0, side}, {0.0, 0.0, 1.0});
    return lab10_from_xyz10(xyz10_from_xyz(xyz_from_working() * (std::numbers::pi * value)));
}

std::vector<NearPaint> find_near_paints(const std::vector<Material>& paints,
                                        const glm::dvec3& lab10,
                                        const std::string& family) {
    std::vector<std::size_t> of_family;
    std::vector<glm::dvec3> faces;
    for (std::size_t k = 0; k < paints.size(); ++k) {
        if (!family.empty() && paints[k].family != family) continue;
        of_family.push_back(k);
        faces.push_back(drawn_face_lab(paints[k]));
    }
    std::vector<NearPaint> found = nearest_colours(faces, lab10);
    if (found.size() > kNearestShown) found.resize(kNearestShown);
    for (NearPaint& near : found) near.index = of_family[near.index];
    return found;
}

std::vector<std::size_t> find_paints(const std::vector<Material>& paints,
                                     const std::string& query,
                                     const std::string& family) {
    const bool marked = is_marked_colour(query);
    std::vector<std::size_t> found;
    if (!marked) found = search_paints(paints, query, family);
    const auto wanted = colour_in(query);
    if (!wanted || !found.empty()) return found;
    for (const NearPaint& near : find_near_paints(paints, *wanted, family)) {
        found.push_back(near.index);
    }
    return found;
}

}  // namespace livery
