// Radiance pictures of the usual kind, without the library that reads all kinds: loading that takes
// longer than everything else before a first frame.
#pragma once

#include <optional>
#include <string_view>

#include "core/image.h"

namespace livery {

/// R, G, B of a whole file's bytes: 32-bit_rle_rgbe, rows downward, run lengths as every writer of
/// the last decades codes them. Nothing for any other file, damaged ones among them: whoever asks
/// has a slower reader that says what is wrong.
std::optional<ImageF> decode_radiance_hdr(std::string_view bytes, std::size_t max_pixels);

}  // namespace livery
