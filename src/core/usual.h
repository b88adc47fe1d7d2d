// Which of several things most of them are like.
#pragma once

#include <cstddef>

namespace livery {

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
