// Well-spread random numbers for paths: Owen-scrambled Sobol points.
#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "core/random.h"

namespace livery {

/// A point of an Owen-scrambled Sobol sequence, its numbers worked out one by one (direction
/// numbers of Joe and Kuo 2008). The sequence's order and each dimension are scrambled after Owen
/// (1995) by hashes of the seed (Laine and Karras 2011, Burley 2020): any aligned power of two of
/// points fills the unit interval of each dimension evenly, and the square of the first two; the
/// mean of any function of them is that of independent numbers, and other seeds' points are
/// independent.
class SobolPoint {
  public:
    static constexpr std::uint32_t kDimensions = 13;

    SobolPoint(std::uint32_t index, std::uint32_t seed);
    /// In [0, 1).
    float operator[](std::uint32_t dimension) const;
    /// Of that dimension and the next.
    glm::vec2 pair(std::uint32_t dimension) const;

  private:
    std::uint32_t shuffled_, seed_;
};

/// The numbers of one path: at each vertex a point of a sequence of its own, index k for the k-th
/// path of a pixel.
class PathNumbers {
  public:
    PathNumbers(std::uint32_t pixel_seed, std::uint32_t k) : pixel_seed_(pixel_seed), k_(k) {}

    /// What a vertex asks numbers for. The place in the pixel, at the first vertex, shares a
    /// sequence with what is sampled there: a shadow's edge is one function of both.
    enum Dimension : std::uint32_t {
        place = 0,      ///< and the next
        direction = 2,  ///< and the next
        first_light = 4,
        environment = 6,  ///< and the next
        lobe = 8,
        paint = 9,
        roulette = 10,
        second_light = 11,
    };
    SobolPoint at(std::uint32_t vertex) const;
    /// On the l-th light's disc.
    glm::vec2 on_light(const SobolPoint& at, std::uint32_t vertex, std::uint32_t l) const;
    /// For a walk inside from a vertex, which asks for more numbers than a sequence has.
    Random independent(std::uint32_t vertex) const;

  private:
    std::uint32_t pixel_seed_, k_;
};

}  // namespace livery
