// LIVERY_THOROUGH=1 (.ci/nightly) runs what is left out of sweeps at each change: more paints, more
// wrong data sheets, a second product.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <vector>

namespace livery {

inline bool thorough() { return std::getenv("LIVERY_THOROUGH") != nullptr; }

/// All of a sweep, or its first `few`.
template <typename Value>
std::vector<Value> chosen(std::vector<Value> all, std::size_t few) {
    if (!thorough() && all.size() > few)
        all.erase(all.begin() + static_cast<std::ptrdiff_t>(few), all.end());
    return all;
}

}  // namespace livery
