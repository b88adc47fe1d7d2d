#include "evaluation/presenting/sittings.h"

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

}  // namespace livery
