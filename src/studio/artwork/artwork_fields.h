// Every field of one artwork that its shape reads, live on the mock-up while it is dragged.
#pragma once

#include <cstddef>

#include "studio/studio.h"

namespace livery {

void draw_artwork_fields(Studio& studio, std::size_t at);

}  // namespace livery
