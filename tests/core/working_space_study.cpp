#include "core/working_space_study.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <glm/matrix.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

struct StudyTable {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;  // empty cells are NaN
};

StudyTable read_table(const std::filesystem::path& csv) {
    std::istringstream lines(read_text_file(csv));
    const auto cells_of = [](std::string line) {
        if (line.ends_with('\r')) line.pop_back();
        std::vector<std::string> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
        return cells;
    };
    StudyTable table;
    std::string line;
    std::getline(lines, line);
    table.names = cells_of(line);
    if (table.names.size() < 2) throw FileError(csv, "line 1", line, "names of columns");
    table.columns.resize(table.names.size());
    for (int row = 2; std::getline(lines, line); ++row) {
        const auto cells = cells_of(line);
        for (std::size_t c = 0; c < table.columns.size(); ++c) {
            double value = std::nan("");
            if (c < cells.size() && !cells[c].empty()) {
                std::istringstream stream(cells[c]);
                if (!(stream >> value)) {
                    throw FileError(csv, "line " + std::to_string(row), cells[c], "a number");
                }
            }
            table.columns[c].push_back(value);
        }
    }
    return table;
}

Spectrum spectrum_of_column(const StudyTable& table, std::size_t column) {
    std::vector<double> wavelengths_nm, values;
    for (std::size_t row = 0; row < table.columns[column].size(); ++row) {
        if (std::isnan(table.columns[column][row])) continue;
        wavelengths_nm.push_back(table.columns[0][row]);
        values.push_back(table.columns[column][row]);
    }
    return spectrum_from_samples(wavelengths_nm, values);
}

/// Median over the scattering samples of a Cornell paint file: "# num wls", "# wls", then rows of
/// four angles and one value (1/sr) a wavelength.
Spectrum read_paint(const std::filesystem::path& file) {
    std::istringstream lines(read_text_file(file));
    std::vector<double> numbers;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream stream(line);
        for (double value = 0.0; stream >> value;) numbers.push_back(value);
    }
    const auto count = numbers.empty() ? 0 : static_cast<std::size_t>(numbers[0]);
    if (count == 0 || numbers.size() < 1 + count + 4 + count ||
        (numbers.size() - 1 - count) % (4 + count) != 0) {
        throw FileError(file, "", std::to_string(numbers.size()) + " numbers", "whole samples");
    }
    std::vector<double> medians(count);
    for (std::size_t k = 0; k < count; ++k) {
        std::vector<double> values;
        for (std::size_t at = 1 + count; at < numbers.size(); at += 4 + count) {
            values.push_back(std::numbers::pi * numbers[at + 4 + k]);
        }
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        medians[k] = *middle;
    }
    return spectrum_from_samples(std::span(numbers).subspan(1, count), medians);
}

double quantile(std::vector<double>& sorted, double fraction) {
    const auto last = static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(std::lround(fraction * last))];
}

Spectrum product(const Spectrum& a, const Spectrum& b) {
    Spectrum result{};
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = a[k] * b[k];
    return result;
}

}  // namespace

std::vector<WorkingSpaceResult> measure_working_spaces(const std::vector<Spectrum>& reflectances,
                                                       const Spectrum& second_illuminant) {
    check_argument(!reflectances.empty(), "measure_working_spaces: no reflectances");
    const glm::dvec2 white(0.3127, 0.3290);
    std::vector<WorkingSpaceResult> results(4);
    results[0].name = "Rec.709";
    results[0].xyz_from_rgb = xyz_from_rgb_matrix({0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, white);
    results[1].name = "Rec.2020";
    results[1].xyz_from_rgb =
        xyz_from_rgb_matrix({0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, white);
    results[2].name = "ACEScg (AP1)";
    results[2].xyz_from_rgb =
        xyz_from_rgb_matrix({0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, white);
    results[3].name = "ACES (AP0)";
    results[3].xyz_from_rgb =
        xyz_from_rgb_matrix({0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, white);

    // What is compared against, once for all candidates.
    const Spectrum& d65 = illuminant_d65();
    const glm::dvec3 second_xyz =
        xyz_from_power(second_illuminant) / xyz_from_power(second_illuminant).y;
    std::vector<glm::dvec3> under_d65, bounce_lab, light_lab;
    for (std::size_t i = 0; i < reflectances.size(); ++i) {
        under_d65.push_back(xyz_from_reflectance(reflectances[i], d65));
        light_lab.push_back(
            lab_from_xyz(xyz_from_reflectance(reflectances[i], second_illuminant), second_xyz));
        for (std::size_t j = 0; j <= i; ++j) {
            const auto both = product(reflectances[i], reflectances[j]);
            bounce_lab.push_back(lab_from_xyz(xyz_from_reflectance(both, d65), d65_xyz()));
        }
    }

    for (auto& result : results) {
        const glm::dmat3 rgb_from_xyz = glm::inverse(result.xyz_from_rgb);
        const glm::dvec3 second_rgb = rgb_from_xyz * second_xyz;
        std::vector<glm::dvec3> rgb;
        std::vector<double> bounce, light;
        int negative = 0;
        for (std::size_t i = 0; i < reflectances.size(); ++i) {
            rgb.push_back(rgb_from_xyz * under_d65[i]);
            const double lowest = std::min({rgb[i].r, rgb[i].g, rgb[i].b});
            negative += lowest < -1e-4 ? 1 : 0;
            result.most_negative = std::min(result.most_negative, lowest);
            light.push_back(
                ciede2000(light_lab[i],
                          lab_from_xyz(result.xyz_from_rgb * (rgb[i] * second_rgb), second_xyz)));
            for (std::size_t j = 0; j <= i; ++j) {
                bounce.push_back(
                    ciede2000(bounce_lab[bounce.size()],
                              lab_from_xyz(result.xyz_from_rgb * (rgb[i] * rgb[j]), d65_xyz())));
            }
        }
        std::sort(bounce.begin(), bounce.end());
        std::sort(light.begin(), light.end());
        result.negative_fraction = negative / static_cast<double>(reflectances.size());
        result.bounce_median = quantile(bounce, 0.5);
        result.bounce_p95 = quantile(bounce, 0.95);
        result.light_median = quantile(light, 0.5);
        result.light_p95 = quantile(light, 0.95);
    }
    return results;
}

std::vector<Spectrum> read_study_reflectances(const std::filesystem::path& reference_data) {
    std::vector<Spectrum> reflectances;
    for (const char* name : {"colorchecker24_ohta1997.csv", "rawtoaces_190_Patches.csv"}) {
        const auto table = read_table(reference_data / "spectral" / name);
        for (std::size_t c = 1; c < table.columns.size(); ++c) {
            reflectances.push_back(spectrum_of_column(table, c));
        }
    }
    for (const char* name : {"cayman.brdf", "garnet_red.brdf", "krylon_blue.brdf"}) {
        reflectances.push_back(read_paint(reference_data / "paint" / name));
    }
    return reflectances;
}

Spectrum read_spectrum_column(const std::filesystem::path& csv, const std::string& column) {
    const auto table = read_table(csv);
    const auto name = std::find(table.names.begin() + 1, table.names.end(), column);
    if (name == table.names.end()) throw FileError(csv, "line 1", "no " + column, "this column");
    return spectrum_of_column(table, static_cast<std::size_t>(name - table.names.begin()));
}

}  // namespace livery
