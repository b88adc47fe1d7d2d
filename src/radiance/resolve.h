// From shaded fragments to the projector's picture: which fragments make each pixel, and the mean
// over what covers it.
#pragma once

#include <cstdint>
#include <vector>

#include "gl/draw.h"
#include "gl/handles.h"
#include "gl/program.h"
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

/// Draws only the tiles that the product covers.
class ResolvePass {
  public:
    ResolvePass(const SurfaceMap& map, const PackedLayout& layout);

    void run(const Texture2D& shaded_fragments, const Framebuffer& target);
    std::size_t pixels() const { return pixels_; }  ///< that one run touches

  private:
    Program program_;
    Texture2D first_;  ///< of each pixel: one fragment, or where its list begins
    Texture2D lists_;
    Buffer corners_;
    VertexArray vertices_;
    int vertex_count_ = 0;
    std::size_t pixels_ = 0;
};

}  // namespace livery
