#include "radiance/packed_fragments.h"

#include <algorithm>

#include "core/parallel.h"

namespace livery {

PixelRect PackedLayout::rectangle(std::size_t part) const {
    return {0, row_begin[part], kPackedWidth, row_begin[part + 1] - row_begin[part]};
}

PackedLayout layout_of(const SurfaceMap& map) {
    PackedLayout layout;
    layout.part_begin = map.part_begin;
    layout.row_begin.push_back(0);
    for (std::size_t p = 0; p + 1 < map.part_begin.size(); ++p) {
        const std::size_t rows = (layout.fragments(p) + kPackedWidth - 1) / kPackedWidth;
        layout.row_begin.push_back(layout.row_begin.back() + static_cast<int>(rows));
    }
    layout.rows = std::max(layout.row_begin.back(), 1);
    return layout;
}

std::vector<float> packed(const SurfaceMap& map,
                          const PackedLayout& layout,
                          const std::function<glm::vec4(std::size_t fragment)>& value) {
    std::vector<float> texels(static_cast<std::size_t>(layout.rows) * kPackedWidth * 4, 0.0f);
    parallel_for(map.fragments.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec4 v = value(i);
            float* texel = &texels[layout.address(i, map.fragments[i].part) * 4];
            for (int c = 0; c < 4; ++c) texel[c] = v[c];
        }
    });
    return texels;
}

}  // namespace livery
