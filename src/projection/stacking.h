// What lies above the projector's window.
#pragma once

#include <cstdint>

#include "projection/monitors.h"
#include "projection/x_connection.h"

namespace livery {

/// A window of ours that may lie above the picture.
void mark_as_overlay(const XConnection& x, std::uint32_t window);

/// Whether a window that was not marked so lies above `window` in that area.
bool is_covered_by_others(const XConnection& x, std::uint32_t window, const Monitor& area);

}  // namespace livery
