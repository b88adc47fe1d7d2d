// The projector's light in photographs of a mock-up.
#pragma once

#include <cstdint>
#include <vector>

#include "core/bench_ports.h"
#include "core/image.h"

namespace livery {

/// Places of camera pixels.
using LitPixels = std::vector<std::uint32_t>;

/// What a photograph holds over one of black, mean of the channels, file units a second: 1 channel.
ImageF light_over_black(const Photograph& photograph, const Photograph& black);

/// Pixels with at least a tenth of the brightest ones' light, thinned to some 40000 where asked.
LitPixels lit_pixels(const ImageF& light, std::size_t thinned_to = 0);

/// Mean over these pixels; 0 for none.
double lit_mean(const ImageF& light, const LitPixels& lit);

/// A port that lights the mock-up alone (non-zero pixels), and what is near it: a pose that is a
/// little off, a lens that is a little soft. What stands around it stays dark in the show; if it
/// were lit here, its light on the mock-up would be taken for what the mock-up's own pixels send.
ShowPicture shown_on(const Image8& mockup, const ShowPicture& show);

}  // namespace livery
