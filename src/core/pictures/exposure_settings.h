// How a photograph was exposed, as its file tells it.
#pragma once

#include <string>

namespace livery {

/// 0: the file does not say.
struct ExposureSettings {
    double time_s = 0.0, f_number = 0.0, iso = 0.0;
    bool operator==(const ExposureSettings&) const = default;
};

/// Whether both say how they were exposed, and not alike: a value that both have differs by more
/// than it may be rounded. Cameras on manual write the same numbers into every file.
bool are_exposed_otherwise(const ExposureSettings& a, const ExposureSettings& b);

/// By how many powers of two `a` was exposed more than `b`: log2 of time ISO / f-number^2, of what
/// both have.
double stops_over(const ExposureSettings& a, const ExposureSettings& b);

/// "1/125 s, f/8, ISO 200", of what it has.
std::string text_of(const ExposureSettings& settings);

}  // namespace livery
