// MERL's tables of isotropic reflectance (Matusik, Pfister, Brand and McMillan 2003): `.binary`.
#pragma once

#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace livery {

/// Bins along theta_h (steps with its root), theta_d and phi_d (up to pi: folded by reciprocity).
inline constexpr std::array<int, 3> kMerlBins{90, 90, 180};

struct MerlTable {
    /// Linear Rec.709 per steradian; phi_d runs fastest, then theta_d. Bins without a measurement
    /// hold the nearest one's value along theta_d, else theta_h.
    std::vector<glm::dvec3> values;
    std::vector<bool> measured;  ///< whether the bin is the file's own
    std::size_t masked = 0;      ///< how many are not: a negative channel
};

/// Throws FileError: another size, truncated, a value that is not finite, nothing measured.
MerlTable read_merl_file(const std::filesystem::path& file);
/// The same of its bytes.
MerlTable parse_merl(std::string_view bytes, const std::filesystem::path& file);

/// Linear between the bins' middles; at theta_h = 0 and theta_d = 0 the mean over phi_d, which
/// turns freely there. Angles as half_difference() gives them.
glm::dvec3 merl_value(const MerlTable& table, glm::dvec3 half_difference);
/// Whether the bin around the angles is measured.
bool merl_measured(const MerlTable& table, glm::dvec3 half_difference);

}  // namespace livery
