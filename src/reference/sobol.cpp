#include "reference/sobol.h"

#include <array>

#include "core/random.h"

namespace livery {

namespace {

constexpr std::uint32_t kDimensions = SobolPoint::kDimensions;
constexpr std::uint32_t kBits = 32;

constexpr std::uint32_t reversed(std::uint32_t x) {
    x = ((x >> 1u) & 0x55555555u) | ((x & 0x55555555u) << 1u);
    x = ((x >> 2u) & 0x33333333u) | ((x & 0x33333333u) << 2u);
    x = ((x >> 4u) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4u);
    x = ((x >> 8u) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8u);
    return (x >> 16u) | (x << 16u);
}

/// A primitive polynomial over two elements, its inner coefficients as bits, and the first odd
/// numbers m (Joe and Kuo 2008). The first dimension has none: it is van der Corput's.
struct Polynomial {
    std::uint32_t degree, inner;
    std::array<std::uint32_t, 5> m;
};
constexpr std::array<Polynomial, kDimensions - 1> kPolynomials{{{1, 0, {1, 0, 0, 0, 0}},
                                                                {2, 1, {1, 3, 0, 0, 0}},
                                                                {3, 1, {1, 3, 1, 0, 0}},
                                                                {3, 2, {1, 1, 1, 0, 0}},
                                                                {4, 1, {1, 1, 3, 3, 0}},
                                                                {4, 4, {1, 3, 5, 13, 0}},
                                                                {5, 2, {1, 1, 5, 5, 17}},
                                                                {5, 4, {1, 1, 5, 5, 5}},
                                                                {5, 7, {1, 1, 7, 11, 19}},
                                                                {5, 11, {1, 1, 5, 1, 1}},
                                                                {5, 13, {1, 1, 1, 3, 11}},
                                                                {5, 14, {1, 3, 5, 5, 31}}}};

/// The generator matrix's columns, their most significant digits in the lowest bits.
constexpr std::array<std::uint32_t, kBits> generator_columns(std::uint32_t dimension) {
    std::array<std::uint32_t, kBits> v{};  // most significant digit first
    for (std::uint32_t k = 0; k < kBits; ++k) {
        if (dimension == 0) {
            v[k] = 1u << (kBits - 1 - k);
            continue;
        }
        const Polynomial& p = kPolynomials[dimension - 1];
        if (k < p.degree) {
            v[k] = p.m[k] << (kBits - 1 - k);
            continue;
        }
        v[k] = v[k - p.degree] ^ (v[k - p.degree] >> p.degree);
        for (std::uint32_t i = 1; i < p.degree; ++i) {
            if ((p.inner >> (p.degree - 1 - i)) & 1u) v[k] ^= v[k - i];
        }
    }
    for (std::uint32_t& column : v) column = reversed(column);
    return v;
}

/// What each byte of an index adds to each dimension.
using ByteTable = std::array<std::array<std::array<std::uint32_t, 256>, 4>, kDimensions>;

ByteTable byte_table() {
    ByteTable table{};
    for (std::uint32_t d = 0; d < kDimensions; ++d) {
        const auto columns = generator_columns(d);
        for (std::uint32_t byte = 0; byte < 4; ++byte) {
            for (std::uint32_t value = 0; value < 256; ++value) {
                for (std::uint32_t bit = 0; bit < 8; ++bit) {
                    if ((value >> bit) & 1u) table[d][byte][value] ^= columns[8 * byte + bit];
                }
            }
        }
    }
    return table;
}
const ByteTable kTable = byte_table();

/// Owen's scrambling of digits that stand lowest bit first: each bit is flipped by a hash of those
/// below it (Laine and Karras 2011; the constants are N. Vegdahl's of 2021).
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

}  // namespace

SobolPoint::SobolPoint(std::uint32_t index, std::uint32_t seed)
    : shuffled_(reversed(scrambled(reversed(index), seed))), seed_(seed) {}

float SobolPoint::operator[](std::uint32_t dimension) const {
    const auto& bytes = kTable[dimension];
    const std::uint32_t digits = bytes[0][shuffled_ & 0xffu] ^ bytes[1][(shuffled_ >> 8u) & 0xffu] ^
                                 bytes[2][(shuffled_ >> 16u) & 0xffu] ^ bytes[3][shuffled_ >> 24u];
    const std::uint32_t owen = reversed(scrambled(digits, hash_3d(seed_, dimension, 0x50b01u)));
    return static_cast<float>(owen >> 8u) * 0x1p-24f;
}

glm::vec2 SobolPoint::pair(std::uint32_t dimension) const {
    return {(*this)[dimension], (*this)[dimension + 1]};
}

SobolPoint PathNumbers::at(std::uint32_t vertex) const {
    return {k_, hash_3d(pixel_seed_, vertex, 0)};
}

glm::vec2 PathNumbers::on_light(const SobolPoint& at, std::uint32_t vertex, std::uint32_t l) const {
    if (l == 0) return at.pair(first_light);
    if (l == 1) return at.pair(second_light);
    return SobolPoint(k_, hash_3d(pixel_seed_, vertex, l)).pair(0);
}

Random PathNumbers::independent(std::uint32_t vertex) const {
    return Random(hash_3d(pixel_seed_, vertex, k_), k_);
}

}  // namespace livery
