// Which part the panels are about.
#pragma once

#include <cstddef>

#include "studio/studio.h"

namespace livery {

/// The chosen part; before one is chosen the body, or the first part of a product that has none.
/// Nothing without a product.
std::optional<std::size_t> chosen_part(const Studio& studio);

/// What a look paints a part with, by itself or as "*"; empty: the product's own.
std::string worn_paint(const Look& look, const std::string& part);

}  // namespace livery
