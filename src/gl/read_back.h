// Textures back into plain pictures (row 0 = top, see gl/handles.h). Each call waits for OpenGL.
#pragma once

#include "core/image.h"
#include "gl/handles.h"

namespace livery {

/// A level and layer as floats, with the format's channels (bytes come as 0 to 1).
ImageF read_floats(const Texture2D& texture, int level = 0, int layer = 0);

/// Level 0 into a picture that is kept from frame to frame: no page of it is new.
void read_floats_into(const Texture2D& texture, ImageF* picture);

/// Level 0 of an 8-bit texture. `channels` may be fewer than the format's: 3 drops alpha.
Image8 read_bytes(const Texture2D& texture, int channels);

/// Level 0 of r32ui to rgba32ui.
Image<std::uint32_t> read_integers(const Texture2D& texture);

/// Level 0 of a texture that somebody else owns, as `channels` (1 to 4) floats.
ImageF read_floats(unsigned texture_name, int width, int height, int channels);

}  // namespace livery
