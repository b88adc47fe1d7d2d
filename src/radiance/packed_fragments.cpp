#include "radiance/packed_fragments.h"

#include <algorithm>

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

}  // namespace livery
