// What of a view the mock-up itself takes: its pixels, and its own lines as the projector would
// draw them.
#pragma once

#include "core/image.h"
#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

/// 255 where the pixel's centre looks at the mesh, whichever part is in front; one channel.
Image8 mockup_mask(const Mesh& mesh, const View& view);

/// 255 where a picture with coverage in its fourth channel is covered by half or more.
Image8 coverage_mask(const ImageF& picture);

/// What wireframe_picture() is made of, 8-bit RGB.
struct WireframeColours {
    glm::u8vec3 outline{90, 255, 90};   ///< the mock-up's border, and where it hides itself
    glm::u8vec3 line{255, 255, 255};    ///< creases and the borders of parts
    glm::u8vec3 elsewhere{56, 56, 56};  ///< little light, by which the mock-up itself is seen
};

/// Lines a pixel wide along the mesh's outlines, creases of more than 30 degrees and borders
/// between parts, hidden ones left out; 3 channels of the view's size. Coarse facets show as
/// creases.
Image8 wireframe_picture(const Mesh& mesh, const View& view, const WireframeColours& colours = {});

}  // namespace livery
