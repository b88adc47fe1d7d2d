// How much light the parts of a mesh may send to one another, told without a ray.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/mesh.h"

namespace livery {

/// Shares of a hemisphere, weighted by the cosine (form factors), with nothing in between: at least
/// what is seen; of a two-sided place the side that sees more. A closed convex mesh has none.
struct PartExchange {
    std::size_t parts = 0;
    std::vector<float> share;  ///< parts x parts

    /// Of the places on part `to`, 95% see no more of part `from` than this.
    float of(std::size_t to, std::size_t from) const { return share[to * parts + from]; }
};

/// From points spread over the surface by area; the same mesh gives the same answer.
PartExchange part_exchange(const Mesh& mesh);

}  // namespace livery
