// Empirical-Bayes shrinkage of per-pixel estimates: what noise explains is averaged over the
// neighbourhood, what it does not explain is kept.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace livery {

/// Where scattered samples lie on the picture's grid, cut to their bounding box.
struct SampleGrid {
    int left = 0, top = 0, width = 0, height = 0;
    std::vector<std::int32_t> sample_at;  ///< width x height; -1: none

    SampleGrid(int picture_width, const std::vector<std::uint32_t>& pixels);
};

struct Shrunk {
    std::vector<float> value;
    std::vector<float> variance;  ///< that is left
};

/// Shrinks each value towards the inverse-variance mean of the samples within `radius`, by how much
/// the scatter there exceeds the noise. With `toward_zero` (values are deviations from a pooled
/// estimate) that mean is itself drawn to zero unless it stands out of its own noise. No value is
/// moved by more than three of its own standard deviations. Values whose variance is not finite and
/// positive take no part and come back unchanged.
Shrunk shrink_locally(const SampleGrid& grid,
                      std::span<const float> values,
                      std::span<const float> variances,
                      int radius,
                      bool toward_zero);

}  // namespace livery
