// Which simulated bench and mock-up a kept calibration was made on, so that a new session of the
// same need not make it again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scene/product.h"

namespace livery {

/// A hash of all that a calibration on this bench is made from: the bench's file with the files
/// that it names, the mock-up's shape, and how this version calibrates. Throws FileError.
std::string bench_key(const std::string& bench, const Product& product);

/// Notes in a calibration's folder what it was made on. Throws FileError.
void note_bench(const std::filesystem::path& calibration, const std::string& key);

/// The newest of the kept calibrations that was made on this; nothing: there is none.
std::optional<std::filesystem::path> kept_calibration_of(const std::string& key);

}  // namespace livery
