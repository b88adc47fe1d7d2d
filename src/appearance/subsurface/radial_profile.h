// A measured profile: R_d at radii, from a file of somebody's.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace livery {

struct ProfileSample {
    double r_mm = 0.0;
    double rd = 0.0;  ///< per mm^2 and unit power that enters; noise makes it 0 or less far out
};

/// Reads a CSV with the columns r_mm and rd among any others, the radii in any order; gives them
/// sorted. Throws FileError (a column missing, a cell that is no finite number, a radius below 0 or
/// there twice, under four rows, more than 5000, no rd above 0).
std::vector<ProfileSample> read_profile_csv(const std::filesystem::path& file);
/// The same of its text.
std::vector<ProfileSample> parse_profile_csv(const std::string& text,
                                             const std::filesystem::path& file);

}  // namespace livery
