// The reference on the mock-up, when somebody asks for it: traced beside everything else, shown as
// another picture of the frame that is there, and gone with the next change.
#pragma once

#include <memory>
#include <string>

#include "live/frame_pictures.h"
#include "live/reference_thread.h"

namespace livery {

struct Studio;

struct ReferenceTracing {
    std::unique_ptr<ReferenceThread> thread;  ///< none: nobody asked yet
    std::uint64_t asked = 0;                  ///< the frame that is traced
    std::shared_ptr<const TracedFrame> taken;
    std::unique_ptr<TexturePool> textures;  ///< of the window's context
};

/// Why it cannot be traced now, in a sentence; empty: it can.
std::string why_not_traced(const Studio& studio);
/// Of the frame on the mock-up. Throws Refused when it cannot be.
void trace_reference_of(Studio& studio);
bool is_tracing(const Studio& studio);

/// A new picture to the projector, once a frame of the window; ended where something else is to be
/// shown.
void take_traced(Studio& studio);

void draw_reference_row(Studio& studio);

}  // namespace livery
