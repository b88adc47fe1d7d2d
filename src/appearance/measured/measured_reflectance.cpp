#include "appearance/measured/measured_reflectance.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "appearance/measured/half_difference.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/random.h"
#include "core/spectrum.h"

namespace livery {

namespace {

constexpr double kReach = 2.0;  ///< of a sample, in usual distances to the next
constexpr int kCoveragePairs = 20'000;

std::string suffix_of(const std::filesystem::path& file) {
    std::string suffix = file.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return suffix;
}

/// XYZ of 1 per steradian at one wavelength alone, the neighbours being 0: integration is linear.
std::vector<glm::dvec3> xyz_of_wavelengths(const std::vector<double>& wavelengths_nm) {
    std::vector<glm::dvec3> xyz;
    std::vector<double> one(wavelengths_nm.size(), 0.0);
    for (double& value : one) {
        value = 1.0;
        xyz.push_back(
            xyz_from_reflectance(spectrum_from_samples(wavelengths_nm, one), illuminant_d65()));
        value = 0.0;
    }
    return xyz;
}

bool is_measured_at(const MeasuredReflectance& measured, glm::dvec3 angles) {
    if (measured.table) return merl_measured(*measured.table, angles);
    return measured.interpolator->distance_to_nearest(angles) <=
           kReach * measured.interpolator->spacing();
}

}  // namespace

const char* name_of(MeasuredFormat format) {
    switch (format) {
        case MeasuredFormat::merl:
            return "MERL table";
        case MeasuredFormat::spectral_text:
            return "spectral samples";
        case MeasuredFormat::csv:
            return "samples";
    }
    throw std::invalid_argument("unknown format of measured reflectance");
}

bool is_measured_file(const std::filesystem::path& file) {
    const std::string suffix = suffix_of(file);
    return suffix == ".binary" || suffix == ".brdf" || suffix == ".csv";
}

MeasuredReflectance read_measured_file(const std::filesystem::path& file) {
    const std::string suffix = suffix_of(file);
    if (suffix == ".binary") return measured_from(read_merl_file(file), file);
    if (suffix == ".brdf") {
        return measured_from(read_spectral_samples(file), MeasuredFormat::spectral_text, file);
    }
    if (suffix == ".csv") return measured_from(read_measured_csv(file), MeasuredFormat::csv, file);
    throw FileError(file, "suffix", suffix.empty() ? "none" : suffix, ".binary, .brdf or .csv");
}

MeasuredReflectance measured_from(MeasuredSamples samples,
                                  MeasuredFormat format,
                                  const std::filesystem::path& file) {
    MeasuredReflectance measured;
    measured.file = file;
    measured.format = format;
    measured.interpolator = std::make_unique<SampleInterpolator>(samples);
    measured.xyz_of_channel =
        samples.wavelengths_nm.empty()
            ? std::vector<glm::dvec3>{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}
            : xyz_of_wavelengths(samples.wavelengths_nm);
    measured.samples = std::move(samples);
    return measured;
}

MeasuredReflectance measured_from(MerlTable table, const std::filesystem::path& file) {
    MeasuredReflectance measured;
    measured.file = file;
    measured.format = MeasuredFormat::merl;
    measured.table = std::make_unique<MerlTable>(std::move(table));
    return measured;
}

glm::dvec3 evaluate_at(const MeasuredReflectance& measured, glm::dvec3 angles) {
    if (measured.table) return working_from_rec709() * merl_value(*measured.table, angles);
    std::vector<double> values(measured.interpolator->channels());
    measured.interpolator->evaluate(angles, values);
    glm::dvec3 xyz(0.0);
    for (std::size_t c = 0; c < values.size(); ++c) xyz += values[c] * measured.xyz_of_channel[c];
    return working_from_xyz() * xyz;
}

glm::dvec3 evaluate(const MeasuredReflectance& measured, glm::dvec3 wi, glm::dvec3 wo) {
    if (!(wi.z > 0.0 && wo.z > 0.0)) return glm::dvec3(0.0);
    return evaluate_at(measured, f64::half_difference(wi, wo));
}

std::vector<double> evaluate_spectrum(const MeasuredReflectance& measured,
                                      glm::dvec3 wi,
                                      glm::dvec3 wo) {
    check_argument(measured.is_spectral(), "evaluate_spectrum: a file without wavelengths");
    std::vector<double> values(measured.interpolator->channels(), 0.0);
    if (wi.z > 0.0 && wo.z > 0.0) {
        measured.interpolator->evaluate(f64::half_difference(wi, wo), values);
    }
    return values;
}

bool is_measured(const MeasuredReflectance& measured, glm::dvec3 wi, glm::dvec3 wo) {
    return wi.z > 0.0 && wo.z > 0.0 && is_measured_at(measured, f64::half_difference(wi, wo));
}

MeasuredCoverage coverage_of(const MeasuredReflectance& measured) {
    MeasuredCoverage coverage;
    double smallest = 0.5 * std::numbers::pi;
    const auto include = [&](double theta_i, double theta_o, double theta_d) {
        coverage.largest_theta_i = std::max(coverage.largest_theta_i, theta_i);
        coverage.largest_theta_o = std::max(coverage.largest_theta_o, theta_o);
        coverage.largest_theta_d = std::max(coverage.largest_theta_d, theta_d);
        smallest = std::min(smallest, theta_d);
    };
    const auto polar = [](const glm::dvec3& w) { return std::atan2(std::hypot(w.x, w.y), w.z); };
    Random random(1);
    int hits = 0;
    for (int k = 0; k < kCoveragePairs; ++k) {
        const auto direction = [&] {
            return direction_from_angles(std::acos(1.0 - random.uniform()),
                                         2.0 * std::numbers::pi * random.uniform());
        };
        const glm::dvec3 wi = direction();
        const glm::dvec3 wo = direction();
        if (!is_measured(measured, wi, wo)) continue;
        ++hits;
        if (measured.table) include(polar(wi), polar(wo), f64::half_difference(wi, wo).y);
    }
    coverage.fraction = static_cast<double>(hits) / kCoveragePairs;
    for (const DirectionPair& pair : measured.samples.pairs) {
        include(polar(pair.wi), polar(pair.wo), f64::half_difference(pair.wi, pair.wo).y);
    }
    coverage.smallest_theta_d = smallest;
    coverage.masked = measured.table ? measured.table->masked : measured.samples.masked;
    coverage.samples = measured.table ? measured.table->values.size() - measured.table->masked
                                      : measured.samples.pairs.size();
    return coverage;
}

glm::dvec3 directional_albedo(const MeasuredReflectance& measured, glm::dvec3 wo, int points) {
    glm::dvec3 sum(0.0);
    for (const auto& [wi, weight] : directions_by_half_vector(wo, points)) {
        sum += weight * evaluate(measured, wi, wo);
    }
    return sum;
}

}  // namespace livery
