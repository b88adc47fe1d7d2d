// Reflectance that somebody measured, from a file of any kind that is read (docs/files.md).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "appearance/measured/measured_merl.h"
#include "appearance/measured/measured_samples.h"

namespace livery {

enum class MeasuredFormat { merl, spectral_text, csv };
/// "MERL table", "spectral samples", ...
const char* name_of(MeasuredFormat format);

/// Isotropic and reciprocal: what a file holds beyond that is averaged. One of `table` and
/// `interpolator` is there. Read-only once made, so threads may share it.
struct MeasuredReflectance {
    std::filesystem::path file;
    MeasuredFormat format = MeasuredFormat::csv;
    std::unique_ptr<const MerlTable> table;
    MeasuredSamples samples;
    std::unique_ptr<const SampleInterpolator> interpolator;
    std::vector<glm::dvec3> xyz_of_channel;  ///< of `interpolator`'s; spectra under D65

    bool is_spectral() const { return !samples.wavelengths_nm.empty(); }
};

/// Whether the file's name is one of measured reflectance: .binary, .brdf or .csv.
bool is_measured_file(const std::filesystem::path& file);

/// Takes the format from the suffix. Throws FileError.
MeasuredReflectance read_measured_file(const std::filesystem::path& file);
MeasuredReflectance measured_from(MeasuredSamples samples,
                                  MeasuredFormat format,
                                  const std::filesystem::path& file);
MeasuredReflectance measured_from(MerlTable table, const std::filesystem::path& file);

/// In the working space, per steradian, 0 below the horizon. Saturated colours may have a channel
/// slightly below 0. Beyond what was measured: the nearest that was.
glm::dvec3 evaluate(const MeasuredReflectance& measured, glm::dvec3 wi, glm::dvec3 wo);
/// The same at coordinates of half_difference(), also where one direction lies below the horizon.
glm::dvec3 evaluate_at(const MeasuredReflectance& measured, glm::dvec3 half_difference);
/// One value a wavelength. Throws std::invalid_argument when the file has none.
std::vector<double> evaluate_spectrum(const MeasuredReflectance& measured,
                                      glm::dvec3 wi,
                                      glm::dvec3 wo);

/// Whether something near these directions was measured: the bin itself, or a sample within twice
/// the usual distance from one to the next.
bool is_measured(const MeasuredReflectance& measured, glm::dvec3 wi, glm::dvec3 wo);

/// Of the angles that were measured, radians.
struct MeasuredCoverage {
    double largest_theta_i = 0.0, largest_theta_o = 0.0;
    double smallest_theta_d = 0.0, largest_theta_d = 0.0;
    double fraction = 0.0;  ///< of pairs of directions, even in solid angle, that is_measured()
    std::size_t samples = 0, masked = 0;
};
MeasuredCoverage coverage_of(const MeasuredReflectance& measured);

/// Share of the light leaving along wo under uniform light, in the working space, by quadrature
/// over the half vector: `points` a side.
glm::dvec3 directional_albedo(const MeasuredReflectance& measured, glm::dvec3 wo, int points = 128);

}  // namespace livery
