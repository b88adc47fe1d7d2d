// Reflectance measured at scattered pairs of directions, and its value between them.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/directions.h"

namespace livery {

/// As a file has them. Rows with a negative wavelength (or, for colours, a negative X, Y or Z) are
/// left out and counted.
struct MeasuredSamples {
    std::vector<double> wavelengths_nm;  ///< empty: the channels are X, Y, Z under D65
    std::vector<DirectionPair> pairs;
    std::vector<double> values;  ///< per steradian; channels() for each pair
    std::size_t masked = 0;

    std::size_t channels() const { return wavelengths_nm.empty() ? 3 : wavelengths_nm.size(); }
};

/// The text format of Cornell's Light Measurement Laboratory that pbrt 2 reads: lines that start
/// with # are comments; then how many wavelengths, the wavelengths in nm, and for each sample
/// theta_i, phi_i, theta_o, phi_o in radians and a value for each wavelength. Throws FileError.
MeasuredSamples read_spectral_samples(const std::filesystem::path& file);
MeasuredSamples parse_spectral_samples(const std::string& text, const std::filesystem::path& file);

/// A CSV with the columns theta_i, phi_i, theta_o, phi_o in radians and either r, g, b (linear
/// signed Rec.709 under D65) or one for each wavelength, named by it in nm. Throws FileError.
MeasuredSamples read_measured_csv(const std::filesystem::path& file);
MeasuredSamples parse_measured_csv(const std::string& text, const std::filesystem::path& file);

/// The text of such a CSV with colours. `comments` stand first, a line each. Throws
/// std::invalid_argument unless there is a value for each pair.
std::string measured_csv(std::span<const DirectionPair> pairs,
                         std::span<const glm::dvec3> values_rec709,
                         std::span<const std::string> comments);

/// Throws FileError unless there are enough samples to interpolate.
void check_samples(const MeasuredSamples& samples, const std::filesystem::path& file);
/// The wavelengths rise and reach over the visible ones. Throws FileError about `field`.
void check_wavelengths(std::span<const double> wavelengths_nm,
                       const std::filesystem::path& file,
                       const std::string& field);

inline constexpr double kLargestReflectance = 1e9;  ///< per steradian; more is a mistake

/// Interpolates between scattered samples in half and difference coordinates: exactly a sample's
/// value at a sample, never outside the values around, reciprocal, the same whichever way a surface
/// without a grain is turned.
class SampleInterpolator {
  public:
    explicit SampleInterpolator(const MeasuredSamples& samples);

    std::size_t channels() const { return channels_; }
    /// Angles as half_difference() gives them; `values` takes channels() of them.
    void evaluate(glm::dvec3 half_difference, std::span<double> values) const;
    /// How far the nearest sample is, in the interpolator's own metric: 1 is a right angle of
    /// theta_d.
    double distance_to_nearest(glm::dvec3 half_difference) const;
    /// The median sample's distance to its nearest neighbour.
    double spacing() const { return spacing_; }

  private:
    static constexpr std::size_t kAxes = 4;
    using Point = std::array<double, kAxes>;
    struct Near {
        double distance2;
        std::size_t point;
        bool operator<(const Near& other) const { return distance2 < other.distance2; }
    };

    static Point point_of(glm::dvec3 half_difference);
    void build_tree(std::size_t begin, std::size_t end, std::size_t axis);
    void find_nearest(const Point& at,
                      std::size_t begin,
                      std::size_t end,
                      std::size_t axis,
                      std::size_t count,
                      std::vector<Near>& heap) const;

    std::size_t channels_ = 0;
    std::vector<Point> points_;       ///< ordered as a tree: the middle of each range splits it
    std::vector<std::size_t> order_;  ///< the row of logarithms_ of each point
    std::vector<double> logarithms_;
    double spacing_ = 0.0;
};

}  // namespace livery
