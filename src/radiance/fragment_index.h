// Which fragments make each pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "radiance/packed_fragments.h"
#include "radiance/surface_map.h"

namespace livery {

/// Words are [more: 1][covering samples: enough bits][address: the rest]. In a pixel's word `more`
/// says that the address is that of a list; in a list, that another word follows. A word's address
/// else is a fragment's place in the packed layout.
struct FragmentIndex {
    unsigned address_bits = 0;
    int samples_per_pixel = 0;
    std::vector<std::uint32_t> pixels;  ///< those that are covered, rising: y * width + x
    std::vector<std::uint32_t> words;   ///< one for each of `pixels`
    std::vector<std::uint32_t> lists;

    std::uint32_t address(std::uint32_t word) const { return word & ((1u << address_bits) - 1u); }
    std::uint32_t samples(std::uint32_t word) const { return (word & 0x7fffffffu) >> address_bits; }
    static bool more(std::uint32_t word) { return (word & 0x80000000u) != 0u; }
};

/// Throws std::invalid_argument for more fragments than words can address.
FragmentIndex index_fragments(const SurfaceMap& map, const PackedLayout& layout);

}  // namespace livery
