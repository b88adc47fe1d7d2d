// What was asked of OpenGL, counted at its calls: whoever wants to know what something costs takes
// the difference of two.
#pragma once

#include <cstdint>

namespace livery {

struct GlCounters {
    std::uint64_t programs = 0;       ///< linked
    std::uint64_t shader_bytes = 0;   ///< of source, compiled
    std::uint64_t textures = 0;       ///< made
    std::uint64_t texture_bytes = 0;  ///< of all their layers and levels
    std::uint64_t buffers = 0;        ///< made
    std::uint64_t buffer_bytes = 0;
    std::uint64_t framebuffers = 0;  ///< made
    std::uint64_t upload_bytes = 0;  ///< to textures and buffers
    std::uint64_t draws = 0;
    std::uint64_t dispatches = 0;  ///< of compute programs

    bool operator==(const GlCounters&) const = default;
};
GlCounters operator-(const GlCounters& later, const GlCounters& earlier);

/// Of this thread so far: a context is current on one thread only.
const GlCounters& gl_counters();

namespace gl_detail {
GlCounters& counted();
}

}  // namespace livery
