#include "evaluation/design_codes.h"

#include <numeric>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/random.h"

namespace livery {

std::vector<int> draw_codes(int designs, int seed, int round) {
    std::vector<int> codes(900);
    std::iota(codes.begin(), codes.end(), 100);
    check_argument(designs >= 0 && designs <= static_cast<int>(codes.size()),
                   "draw_codes: found " + std::to_string(designs) + " designs, expected 0 to 900");
    Random random(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(round));
    // Fisher and Yates, as far as it is needed.
    for (int k = 0; k < designs; ++k) {
        const auto rest = static_cast<std::uint32_t>(codes.size()) - static_cast<std::uint32_t>(k);
        std::swap(codes[static_cast<std::size_t>(k)],
                  codes[static_cast<std::size_t>(k) + random.below(rest)]);
    }
    codes.resize(static_cast<std::size_t>(designs));
    return codes;
}

}  // namespace livery
