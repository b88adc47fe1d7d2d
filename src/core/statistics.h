// Order statistics of plain vectors, and which of several things most are like.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace livery {

/// Value at a fraction in [0, 1] of the sorted values, the nearest of them; 0 for none. What is no
/// number counts as larger than all that are. Reorders the values.
template <typename T>
T quantile_in_place(std::span<T> values, double fraction) {
    if (values.empty()) return T{};
    const auto rank =
        static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1) + 0.5);
    auto end = values.end();
    if constexpr (std::floating_point<T>) {
        end = std::partition(values.begin(), end, [](T value) { return !std::isnan(value); });
        if (rank >= end - values.begin()) return std::numeric_limits<T>::quiet_NaN();
    }
    std::nth_element(values.begin(), values.begin() + rank, end);
    return values[static_cast<std::size_t>(rank)];
}

/// The same of a copy.
template <typename T>
T quantile(std::vector<T> values, double fraction) {
    return quantile_in_place(std::span<T>(values), fraction);
}

template <typename T>
T median(std::vector<T> values) {
    return quantile(std::move(values), 0.5);
}

/// Place of the one of `count` things that most of them are like, by `alike(a, b)` of two places;
/// the first of equals. Not of none.
template <typename Alike>
std::size_t usual_of(std::size_t count, const Alike& alike) {
    std::size_t usual = 0, most = 0;
    for (std::size_t k = 0; k < count; ++k) {
        std::size_t like = 0;
        for (std::size_t other = 0; other < count; ++other) like += alike(k, other) ? 1u : 0u;
        if (like <= most) continue;
        usual = k;
        most = like;
        if (2 * most > count) break;
    }
    return usual;
}

}  // namespace livery
