// Where the pixels of a view lie across edges of the mock-up.
#pragma once

#include "core/image.h"
#include "scene/view.h"

namespace livery {

/// What each pixel of a view lies on, collected while its rays are traced.
struct PixelGround {
    explicit PixelGround(const View& view);

    Image8 seen;   ///< 255 where at least half of the pixel lies on the mock-up
    Image8 lit;    ///< 255 where at least half of the pixel lies on lit mock-up
    Image8 mixed;  ///< 255: more than one part, or only some of the pixel is met (or lit)
    Image16 part;  ///< the mesh's part; 0xffff: none
    ImageF place;  ///< 6 channels: mean position in mm, mean unit normal
};

/// 255 within 2 px of a silhouette, depth or part edge: of mixed pixels, of neighbours on different
/// parts, and of lit neighbours off each other's tangent plane by more than two pixels' width.
Image8 edge_band(const PixelGround& ground, const View& view, const PixelRectangle& rectangle);

}  // namespace livery
