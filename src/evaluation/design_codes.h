// The numbers under which designs are shown and voted on.
#pragma once

#include <cstdint>
#include <vector>

namespace livery {

/// One a design, 123 to 987 and all different: a code says nothing about what it stands for, nor
/// about its place. No 0, no digit twice, no run (123, 321), none that reads as a number upside
/// down; of up to 26 no two with the same digits or that differ in one place alone. The same seed
/// and round give the same codes on every machine, other rounds other ones, so that none means what
/// it meant before. At most 400.
std::vector<int> draw_codes(int designs, std::uint64_t seed, int round);

/// A seed from the system: of a round whose codes nobody can guess.
int random_seed();

}  // namespace livery
