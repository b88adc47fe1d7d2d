// The numbers under which designs are shown and voted on.
#pragma once

#include <vector>

namespace livery {

/// Different three-digit numbers (100 to 999), one a design: a code says nothing about what it
/// stands for, nor about its place. The same seed gives the same codes. At most 900.
std::vector<int> draw_codes(int designs, int seed);

}  // namespace livery
