#include "appearance/directions.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/paths.h"
#include "core/text/csv.h"

namespace livery {

namespace {

constexpr std::size_t kLargestFile_bytes = std::size_t{1} << 30u;
constexpr std::size_t kMaxRows = 20'000'000;

}  // namespace

glm::dvec3 direction_from_angles(double theta_rad, double phi_rad) {
    const double sine = std::sin(theta_rad);
    return {sine * std::cos(phi_rad), sine * std::sin(phi_rad), std::cos(theta_rad)};
}

std::vector<WeightedDirection> directions_by_half_vector(glm::dvec3 wo, int points) {
    std::vector<WeightedDirection> directions;
    if (!(wo.z > 0.0)) return directions;
    const double steps = points;
    for (int ring = 0; ring < points; ++ring) {
        // theta_h = pi/2 u^2, so d theta_h = pi u du; and d wi = 4 (wo.h) d h.
        const double u = (ring + 0.5) / steps;
        const double theta_h = 0.5 * std::numbers::pi * u * u;
        const double area =
            std::numbers::pi * u * std::sin(theta_h) * 2.0 * std::numbers::pi / (steps * steps);
        for (int k = 0; k < points; ++k) {
            const glm::dvec3 h =
                direction_from_angles(theta_h, 2.0 * std::numbers::pi * (k + 0.5) / steps);
            const double along = glm::dot(wo, h);
            const glm::dvec3 wi = h * (2.0 * along) - wo;
            if (along > 0.0 && wi.z > 0.0) directions.push_back({wi, wi.z * 4.0 * along * area});
        }
    }
    return directions;
}

std::vector<DirectionPair> read_directions_csv(const std::filesystem::path& file) {
    return parse_directions_csv(read_text_file(file, kLargestFile_bytes), file);
}

std::vector<DirectionPair> parse_directions_csv(const std::string& text,
                                                const std::filesystem::path& file) {
    constexpr const char* kColumns = "the columns theta_i, phi_i, theta_o, phi_o";
    CsvReader csv(text, file);
    const std::size_t theta_i = csv.column("theta_i", kColumns);
    const std::size_t phi_i = csv.column("phi_i", kColumns);
    const std::size_t theta_o = csv.column("theta_o", kColumns);
    const std::size_t phi_o = csv.column("phi_o", kColumns);
    const auto direction = [&](std::size_t theta, std::size_t phi) {
        const double polar = csv.number(theta);
        if (polar < 0.0) csv.fail(theta, "0 or more, in radians");
        const glm::dvec3 upper = direction_from_angles(polar, csv.number(phi));
        // Beyond a full turn the cosine would come up again.
        return polar > std::numbers::pi ? glm::dvec3(upper.x, upper.y, -std::abs(upper.z)) : upper;
    };
    std::vector<DirectionPair> pairs;
    while (csv.next()) {
        if (pairs.size() == kMaxRows) {
            throw FileError(file, csv.place(), "more rows", "at most " + std::to_string(kMaxRows));
        }
        pairs.push_back({direction(theta_i, phi_i), direction(theta_o, phi_o)});
    }
    if (pairs.empty()) throw FileError(file, "", "no rows", "one pair of directions or more");
    return pairs;
}

}  // namespace livery
