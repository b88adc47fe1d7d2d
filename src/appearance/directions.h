// Pairs of directions in local coordinates, and the files that list them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace livery {

/// Unit, toward the light and toward the eye: z is the normal, x the tangent.
struct DirectionPair {
    glm::dvec3 wi{0.0, 0.0, 1.0}, wo{0.0, 0.0, 1.0};
};

/// A direction from its polar angle to the normal and its azimuth from the tangent.
glm::dvec3 direction_from_angles(double theta_rad, double phi_rad);

/// A direction toward the light and what a value there counts in an integral over the hemisphere
/// with the cosine: for surfaces whose lobes are known by their values alone.
struct WeightedDirection {
    glm::dvec3 wi{0.0};
    double weight = 0.0;
};
/// Of `points` by `points` half vectors: even steps of the root of their angle to the normal, where
/// a narrow lobe has most of them. None when wo lies below the horizon.
std::vector<WeightedDirection> directions_by_half_vector(glm::dvec3 wo, int points);

/// Reads a CSV with the columns theta_i, phi_i, theta_o, phi_o in radians, in any order; further
/// columns are not read. Throws FileError (a column missing, a cell that is no finite number, a
/// negative theta, no rows, too many).
std::vector<DirectionPair> read_directions_csv(const std::filesystem::path& file);
/// The same of its text.
std::vector<DirectionPair> parse_directions_csv(const std::string& text,
                                                const std::filesystem::path& file);

}  // namespace livery
