// Measured reflectance as a paint: what shading, path tracing and light from all around need of it.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "appearance/bsdf_source.h"
#include "appearance/measured/measured_grid.h"
#include "core/error.h"

namespace livery {

/// Half vectors fall into rings around the normal as often as the paint's light does: each ring has
/// its share, even in solid angle inside.
struct MeasuredRings {
    std::vector<float> versines;    ///< 1 - cos(theta_h) of the rings' edges, from 0 to 1
    std::vector<float> cumulative;  ///< share of all rings below each edge, from 0 to 1
};

struct MeasuredPaint {
    std::filesystem::path file;
    std::string id;  ///< 32 hexadecimal digits, a hash of the grid
    MeasuredGrid grid;
    MeasuredRings rings;
    /// Under the cosines (k / 32)^2; see f32::BsdfEnvironment. The coat's is 0.
    std::array<f32::BsdfEnvironment, 33> environment{};
    float lobe_alpha = 1.0f;  ///< GGX slope parameter of a lobe about as wide
    bool unread = false;      ///< the file is yet to be read: the paint is black until then
    std::string problem;      ///< why the file could not be read: the paint is black; empty: it was
};

/// Throws Cancelled.
MeasuredPaint measured_paint(const MeasuredReflectance& measured, const Progress& progress = {});

/// Reads and resamples the file, about a second's work. Throws FileError.
std::shared_ptr<const MeasuredPaint> read_measured_paint(const std::filesystem::path& file);

/// Black, to prepare with what will draw others.
std::shared_ptr<const MeasuredPaint> blank_measured_paint();

/// Stands for a file that nobody has read yet: black, and drawing waits for it.
std::shared_ptr<const MeasuredPaint> unread_measured_paint(const std::filesystem::path& file);
/// Stands for a file that cannot be read, in what names it: black, and says why.
std::shared_ptr<const MeasuredPaint> failed_measured_paint(const std::filesystem::path& file,
                                                           const std::string& problem);

/// As evaluate() of the grid, but never negative: a saturated colour's lacking channel is black.
glm::vec3 evaluate(const MeasuredPaint& paint, glm::vec3 wi, glm::vec3 wo);
/// A direction wi for light that leaves along wo; `u` in [0, 1)^3. May lie below the horizon: a
/// sample without a value, which counts.
glm::vec3 sample(const MeasuredPaint& paint, glm::vec3 wo, glm::vec3 u);
/// Density of sample() over solid angle, at the directions above the horizon.
float pdf(const MeasuredPaint& paint, glm::vec3 wi, glm::vec3 wo);
f32::BsdfEnvironment environment_weights(const MeasuredPaint& paint, float mu);

}  // namespace livery
