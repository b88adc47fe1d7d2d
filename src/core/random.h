// A small, fast, repeatable random generator: PCG-XSH-RR 64/32 (O'Neill 2014).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace livery {

class Random {
  public:
    explicit Random(std::uint64_t seed = 1, std::uint64_t stream = 0)
        : state_(0), increment_((stream << 1u) | 1u) {
        next();
        state_ += seed;
        next();
    }
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ULL + increment_;
        const auto xorshifted = static_cast<std::uint32_t>(((old >> 18u) ^ old) >> 27u);
        const auto rot = static_cast<std::uint32_t>(old >> 59u);
        return (xorshifted >> rot) | (xorshifted << ((32u - rot) & 31u));
    }
    /// In [0, 1), with 32 random bits.
    double uniform() { return next() * 0x1p-32; }
    float uniform_float() { return static_cast<float>(next() >> 8u) * 0x1p-24f; }
    /// In [0, count); the bias is below count / 2^32.
    std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>((static_cast<std::uint64_t>(next()) * count) >> 32u);
    }
    /// Standard normal (Box-Muller).
    double normal() {
        const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
        return radius * std::cos(2.0 * std::numbers::pi * uniform());
    }

  private:
    std::uint64_t state_, increment_;
};

/// A well-mixed 32-bit value from up to three integers (PCG3D, Jarzynski and Olano 2020); for
/// noise that depends on a pixel's place and not on the order of work.
inline std::uint32_t hash_3d(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    x = x * 1664525u + 1013904223u;
    y = y * 1664525u + 1013904223u;
    z = z * 1664525u + 1013904223u;
    x += y * z;
    y += z * x;
    z += x * y;
    x ^= x >> 16u;
    y ^= y >> 16u;
    z ^= z >> 16u;
    x += y * z;
    y += z * x;
    z += x * y;
    return x ^ (y * 0x9e3779b9u) ^ z;
}

/// Each order is equally likely (Fisher and Yates).
template <typename T>
void shuffle(std::vector<T>& values, Random& random) {
    for (std::size_t k = values.size(); k > 1; --k) {
        std::swap(values[k - 1], values[random.below(static_cast<std::uint32_t>(k))]);
    }
}

}  // namespace livery
