// Fragments in dense textures: each part starts on a row of its own, so that shading a part is one
// rectangle without a wasted pixel but in its last row.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "gl/handles.h"
#include "radiance/surface_map.h"

namespace livery {

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

/// A float texture with value(fragment index) at each fragment's place, 0 between parts.
std::vector<float> packed(const SurfaceMap& map,
                          const PackedLayout& layout,
                          const std::function<glm::vec4(std::size_t fragment)>& value);

}  // namespace livery
