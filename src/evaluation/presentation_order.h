// The codes under which designs are shown and voted on, and the order in which they are shown: rows
// of a Williams square, by chance and seed.
#pragma once

#include <cstdint>
#include <string>
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

/// Rows of designs (from 0) in which each design stands equally often in each place, and follows
/// each other one equally often (Williams 1949): as many rows as designs, or twice as many where
/// their number is odd. Throws std::invalid_argument outside 2 to 26.
std::vector<std::vector<int>> williams_rows(int designs);

/// Evaluators who look together, since one projector shows everyone one order.
struct Wave {
    int row = 0;
    int evaluators = 0;
    std::vector<int> designs;        ///< in the order shown: the row
    std::vector<std::string> codes;  ///< the same, as evaluators see them
};

struct PresentationOrder {
    std::vector<std::vector<int>> rows;
    std::vector<std::string> codes;  ///< of each design
    std::vector<Wave> waves;
    bool balanced = false;  ///< every row is used by as many waves
};

/// Waves of at most `wave_size`, as even as they come. No row comes a second time before all have
/// come once, in an order of chance. Without evaluators (0), a wave a row. All from the seed and
/// nothing else: the same on every machine. Throws std::invalid_argument: designs outside 2 to 26,
/// evaluators outside 0 to 1000, a wave outside 1 to 1000.
PresentationOrder presentation_order(int designs,
                                     int evaluators,
                                     int wave_size,
                                     std::uint64_t seed);

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
