// Order statistics of plain vectors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace livery {

/// Value at a fraction in [0, 1] of the sorted values, the nearest of them; 0 for none. Takes a
/// copy to reorder.
template <typename T>
T quantile(std::vector<T> values, double fraction) {
    if (values.empty()) return T{};
    const auto rank =
        static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

template <typename T>
T median(std::vector<T> values) {
    return quantile(std::move(values), 0.5);
}

}  // namespace livery
