#include "evaluation/presenting/sittings.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "core/error.h"
#include "evaluation/presentation_order.h"

namespace livery {

std::vector<std::vector<int>> pass_sitting(int designs, int passes, std::uint64_t seed) {
    check_argument(passes >= 0, "passes: found " + std::to_string(passes) + ", expected 0 or more");
    std::vector<int> sitting;
    int shown = 0;
    for (const Wave& wave : presentation_order(designs, 0, 1, seed).waves) {
        if (passes > 0 && shown++ >= passes) break;
        sitting.insert(sitting.end(), wave.designs.begin(), wave.designs.end());
    }
    return {sitting};
}

std::vector<std::vector<int>> wave_sittings(int designs,
                                            int evaluators,
                                            int wave_size,
                                            std::uint64_t seed) {
    check_argument(evaluators >= 1,
                   "evaluators: found " + std::to_string(evaluators) + ", expected 1 or more");
    std::vector<std::vector<int>> sittings;
    for (const Wave& wave : presentation_order(designs, evaluators, wave_size, seed).waves) {
        sittings.push_back(wave.designs);
    }
    return sittings;
}

std::vector<std::vector<int>> deal_seats(std::vector<int> seats, int waves) {
    check_argument(waves >= 1, "waves: found " + std::to_string(waves) + ", expected 1 or more");
    std::sort(seats.begin(), seats.end());
    std::vector<std::vector<int>> dealt(static_cast<std::size_t>(waves));
    const auto each = seats.size() / dealt.size(), more = seats.size() % dealt.size();
    auto next = seats.begin();
    for (std::size_t w = 0; w < dealt.size(); ++w) {
        const auto end = next + static_cast<std::ptrdiff_t>(each + (w < more ? 1 : 0));
        dealt[w].assign(next, end);
        next = end;
    }
    return dealt;
}

}  // namespace livery
