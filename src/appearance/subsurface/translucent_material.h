// A translucent material by its three channels, and its file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/subsurface/scattering_medium.h"

namespace livery {

/// Slope parameter of a boundary of which nothing is said.
inline constexpr double kSmoothAlpha = 0.02;

/// Of what is measured and no product is made of, food and drinks above all: listed where it is
/// asked for.
inline constexpr const char* kMeasuredMedia = "measured media";

struct TranslucentMaterial {
    std::string name;
    std::string family = "translucent";
    glm::dvec3 sigma_a_per_mm{0.0}, sigma_s_prime_per_mm{0.0};  ///< linear Rec.709 channels
    double g = 0.0;
    double eta = 1.5;
    std::optional<double> thickness_mm;  ///< of a sheet; otherwise it is deep
    double alpha = kSmoothAlpha;         ///< of the boundary that a part wears with it
    std::string provenance;
};

/// Whether light goes the same ways in both, whatever their surfaces and names.
bool same_medium(const TranslucentMaterial& a, const TranslucentMaterial& b);

/// What one channel, 0 to 2, is made of.
ScatteringMedium medium_of(const TranslucentMaterial& material, int channel);

/// A file, or the name of one that is shipped in materials/translucent. Throws FileError (missing,
/// malformed, a field unknown or out of range, an unknown name: says which there are).
TranslucentMaterial read_translucent_material(const std::filesystem::path& file_or_name);
TranslucentMaterial parse_translucent_material(const std::string& text,
                                               const std::filesystem::path& file);
/// Throws FileError, and std::invalid_argument for a channel that is no medium.
void write_translucent_material(const std::filesystem::path& file,
                                const TranslucentMaterial& material);

}  // namespace livery
