#include "evaluation/design_codes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <string>

#include "core/error.h"
#include "core/random.h"

namespace livery {

namespace {

constexpr int kMostUnlike = 26, kMost = 400;

std::array<int, 3> digits_of(int code) { return {code / 100, code / 10 % 10, code % 10}; }

bool is_plain(int code) {
    const auto [a, b, c] = digits_of(code);
    if (b == 0 || c == 0 || a == b || b == c || a == c) return false;
    if (b - a == c - b && (b - a == 1 || b - a == -1)) return false;
    const auto turns = [](int digit) {
        return digit == 1 || digit == 6 || digit == 8 || digit == 9;
    };
    return !(turns(a) && turns(b) && turns(c));
}

bool are_alike(int one, int other) {
    auto a = digits_of(one), b = digits_of(other);
    int same = 0;
    for (std::size_t k = 0; k < 3; ++k) same += a[k] == b[k] ? 1 : 0;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return same >= 2 || a == b;
}

}  // namespace

std::vector<int> draw_codes(int designs, std::uint64_t seed, int round) {
    check_argument(
        designs >= 0 && designs <= kMost,
        "designs: found " + std::to_string(designs) + ", expected 0 to " + std::to_string(kMost));
    std::vector<int> all;
    for (int code = 100; code < 1000; ++code) {
        if (is_plain(code)) all.push_back(code);
    }
    Random random(seed, static_cast<std::uint64_t>(round));
    std::vector<int> chosen;
    do {
        // Where the first ones leave no room for the others, from the beginning.
        chosen.clear();
        shuffle(all, random);
        for (const int code : all) {
            if (static_cast<int>(chosen.size()) == designs) break;
            const bool free = std::none_of(chosen.begin(), chosen.end(), [&](int other) {
                return designs <= kMostUnlike && are_alike(code, other);
            });
            if (free) chosen.push_back(code);
        }
    } while (static_cast<int>(chosen.size()) < designs);
    return chosen;
}

int random_seed() { return static_cast<int>(std::random_device()() & 0x3fffffffu); }

}  // namespace livery
