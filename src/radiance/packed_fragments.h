// Fragments in dense textures: each part starts on a row of its own, so that shading a part is one
// rectangle without a wasted pixel but in its last row. Which of them make each pixel, and the mean
// over what covers it: the projector's picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/parallel.h"
#include "gl/draw.h"
#include "gl/handles.h"
#include "gl/program.h"
#include "radiance/surface_map.h"

namespace livery {

/// A little below the largest half float, 65504: sums that round up stay finite.
inline constexpr float kLargestHalf = 65000.0f;

inline constexpr int kPackedWidth = 1024;

struct PackedLayout {
    int rows = 0;
    std::vector<int> row_begin;             ///< parts + 1
    std::vector<std::uint32_t> part_begin;  ///< SurfaceMap's

    PixelRect rectangle(std::size_t part) const;  ///< height 0 for a part that is not seen
    std::size_t fragments(std::size_t part) const {
        return part_begin[part + 1] - part_begin[part];
    }
    /// y * kPackedWidth + x of a fragment in the textures.
    std::size_t address(std::size_t fragment, std::size_t part) const {
        return static_cast<std::size_t>(row_begin[part]) * kPackedWidth + fragment -
               part_begin[part];
    }
};
PackedLayout layout_of(const SurfaceMap& map);

/// Into a float texture, value(fragment index), a glm::vec4, at each fragment's place. `texels` may
/// be that of another value and the same layout; of none it becomes 0 between parts.
template <typename Value>
void pack(const PackedLayout& layout, const Value& value, std::vector<float>& texels) {
    const std::size_t size = static_cast<std::size_t>(layout.rows) * kPackedWidth * 4;
    if (texels.size() != size) texels.assign(size, 0.0f);
    for (std::size_t part = 0; part + 1 < layout.part_begin.size(); ++part) {
        const std::size_t first = layout.part_begin[part];
        float* to = texels.data() + layout.address(first, part) * 4;
        parallel_for(layout.fragments(part), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const glm::vec4 v = value(first + k);
                for (int c = 0; c < 4; ++c) to[4 * k + static_cast<std::size_t>(c)] = v[c];
            }
        });
    }
}

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
