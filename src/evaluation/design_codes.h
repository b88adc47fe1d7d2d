// The numbers under which designs are shown and voted on.
#pragma once

#include <vector>

namespace livery {

/// Different three-digit numbers (100 to 999), one a design: a code says nothing about what it
/// stands for, nor about its place. The same seed and round give the same codes, other rounds other
/// ones, so that none means what it meant before. At most 900.
std::vector<int> draw_codes(int designs, int seed, int round);

}  // namespace livery
