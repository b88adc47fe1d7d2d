#include "evaluation/presentation_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <random>
#include <string>

#include "core/error.h"
#include "core/random.h"
#include "evaluation/ballot.h"

namespace livery {

namespace {

constexpr int kMostUnlike = 26, kMostCodes = 400;

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

void check_range(const char* name, int value, int low, int high) {
    check_argument(value >= low && value <= high,
                   std::string(name) + ": found " + std::to_string(value) + ", expected " +
                       std::to_string(low) + " to " + std::to_string(high));
}

// A stream of its own: one more code moves no wave.
constexpr std::uint64_t kWaveStream = 2;

}  // namespace

std::vector<int> draw_codes(int designs, std::uint64_t seed, int round) {
    check_argument(designs >= 0 && designs <= kMostCodes,
                   "designs: found " + std::to_string(designs) + ", expected 0 to " +
                       std::to_string(kMostCodes));
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

std::vector<std::vector<int>> williams_rows(int designs) {
    check_range("designs", designs, 2, kMostDesigns);
    // 0, 1, k - 1, 2, k - 2, ...: each difference of neighbours comes once.
    std::vector<int> first = {0};
    for (int step = 1; static_cast<int>(first.size()) < designs; ++step) {
        first.push_back(step);
        if (static_cast<int>(first.size()) < designs) first.push_back(designs - step);
    }
    std::vector<std::vector<int>> rows;
    for (int shift = 0; shift < designs; ++shift) {
        std::vector<int> row;
        for (const int design : first) row.push_back((design + shift) % designs);
        rows.push_back(std::move(row));
    }
    // Of an odd number each difference comes twice, and its opposite in the rows read backwards.
    if (designs % 2 == 1) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(designs); ++k) {
            rows.emplace_back(rows[k].rbegin(), rows[k].rend());
        }
    }
    return rows;
}

PresentationOrder presentation_order(int designs,
                                     int evaluators,
                                     int wave_size,
                                     std::uint64_t seed) {
    PresentationOrder order;
    order.rows = williams_rows(designs);
    check_range("evaluators", evaluators, 0, kMostEvaluators);
    check_range("wave", wave_size, 1, kMostEvaluators);
    for (const int code : draw_codes(designs, seed, 1)) order.codes.push_back(std::to_string(code));
    const auto rows = static_cast<int>(order.rows.size());
    const int waves = evaluators == 0 ? rows : (evaluators + wave_size - 1) / wave_size;
    Random random(seed, kWaveStream);
    std::vector<int> sequence(order.rows.size());
    std::iota(sequence.begin(), sequence.end(), 0);
    for (int w = 0; w < waves; ++w) {
        if (w % rows == 0) shuffle(sequence, random);
        Wave wave;
        wave.row = sequence[static_cast<std::size_t>(w % rows)];
        wave.evaluators = evaluators / waves + (w < evaluators % waves ? 1 : 0);
        wave.designs = order.rows[static_cast<std::size_t>(wave.row)];
        for (const int design : wave.designs) {
            wave.codes.push_back(order.codes[static_cast<std::size_t>(design)]);
        }
        order.waves.push_back(std::move(wave));
    }
    order.balanced = waves % rows == 0;
    return order;
}

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
