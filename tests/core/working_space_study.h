// How the working space was chosen: what candidates lose on measured reflectances.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>

#include "core/spectrum.h"

namespace livery {

/// One candidate's losses. Differences are CIEDE2000 against the spectral computation.
struct WorkingSpaceResult {
    std::string name;
    glm::dmat3 xyz_from_rgb{1.0};
    double negative_fraction = 0.0;  ///< of the reflectances, with a component below -0.0001
    double most_negative = 0.0;      ///< lowest component; a perfect white has 1
    double bounce_median = 0.0, bounce_p95 = 0.0;  ///< reflectance x reflectance under D65
    double light_median = 0.0, light_p95 = 0.0;    ///< reflectance under the second illuminant
};

/// Compares Rec.709 (for scale), Rec.2020, ACEScg (AP1) and ACES (AP0), each with its primaries
/// around a D65 white, without adaptation: products of RGB only depend on the primaries once white
/// is (1,1,1). Two bounces take every pair of reflectances. Under the second illuminant the white
/// of CIEDE2000 is the light itself. Throws std::invalid_argument without reflectances.
std::vector<WorkingSpaceResult> measure_working_spaces(const std::vector<Spectrum>& reflectances,
                                                       const Spectrum& second_illuminant);

/// The reflectances of the study: 24 chart patches, 190 real surfaces, and the three measured
/// paints (per wavelength the median of pi times the scattered samples), from a folder of reference
/// data. Throws FileError.
std::vector<Spectrum> read_study_reflectances(const std::filesystem::path& reference_data);

/// A column of a table whose first column is the wavelength in nm. Throws FileError.
Spectrum read_spectrum_column(const std::filesystem::path& csv, const std::string& column);

}  // namespace livery
