// Values in an order of chance that comes again with the same seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/random.h"

namespace livery {

/// Each order is equally likely (Fisher and Yates).
template <typename T>
void shuffle(std::vector<T>& values, Random& random) {
    for (std::size_t k = values.size(); k > 1; --k) {
        std::swap(values[k - 1], values[random.below(static_cast<std::uint32_t>(k))]);
    }
}

}  // namespace livery
