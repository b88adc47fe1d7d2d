// The pointer as it is drawn on the screen.
#pragma once

namespace livery {

/// Opaque pixels of its picture; 0: hidden.
int visible_pointer_pixels();

}  // namespace livery
