// What pictures of half floats may hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/parallel.h"
#include "gl/handles.h"
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

}  // namespace livery
