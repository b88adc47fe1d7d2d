// In which order looks are shown, and under which codes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace livery {

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

}  // namespace livery
