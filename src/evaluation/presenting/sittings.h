// In which order a presentation shows its looks: rows of a Williams square, by chance and seed.
#pragma once

#include <cstdint>
#include <vector>

namespace livery {

/// Everybody sees `passes` rows one after the other, in one sitting; 0, and more than there are:
/// all of them, so that each look stands equally often in each place. Throws std::invalid_argument
/// as presentation_order() does, and for a negative number.
std::vector<std::vector<int>> pass_sitting(int designs, int passes, std::uint64_t seed);

/// Waves of at most `wave_size`, each with a row and a sitting of its own.
std::vector<std::vector<int>> wave_sittings(int designs,
                                            int evaluators,
                                            int wave_size,
                                            std::uint64_t seed);

/// Seats in rising order of their numbers, shared out among the waves as evenly as they come: the
/// first waves have one more where they do not come out even. Throws std::invalid_argument without
/// waves.
std::vector<std::vector<int>> deal_seats(std::vector<int> seats, int waves);

}  // namespace livery
