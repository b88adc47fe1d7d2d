// From the numbers in a photograph's file to light.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace livery {

/// Linear light from a file value, both in file units from 0 to `full_scale`: "linear" (an empty
/// function), "srgb", or a response file's path. Throws FileError.
std::function<double(double)> linearisation(const std::string& transfer, double full_scale);

/// Of a file by its name, where nobody says: "srgb" for JPEG, which picture styles are only nearly;
/// "linear" for the rest.
std::string usual_transfer(const std::filesystem::path& file);

/// The same as a table of the 256 values of an 8-bit file.
std::vector<float> linear_from_eight_bits(const std::string& transfer);

/// Writes a response file (docs/files.md): linear light for equally spaced file values, both from 0
/// to 1. Throws FileError.
void write_response(const std::filesystem::path& file, const std::vector<double>& linear_from_file);

}  // namespace livery
