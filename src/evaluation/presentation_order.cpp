#include "evaluation/presentation_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include "core/error.h"
#include "core/shuffle.h"
#include "evaluation/statistics/vote_counts.h"

namespace livery {

namespace {

void check_range(const char* name, int value, int low, int high) {
    check_argument(value >= low && value <= high,
                   std::string(name) + ": found " + std::to_string(value) + ", expected " +
                       std::to_string(low) + " to " + std::to_string(high));
}

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

// What chance decides, each from a stream of its own: one more code moves no wave.
enum Stream : std::uint64_t { code_stream = 1, wave_stream = 2 };

}  // namespace

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

std::vector<std::string> random_codes(int designs, std::uint64_t seed) {
    check_range("designs", designs, 2, kMostDesigns);
    std::vector<int> all;
    for (int code = 100; code < 1000; ++code) {
        if (is_plain(code)) all.push_back(code);
    }
    Random random(seed, code_stream);
    std::vector<int> chosen;
    while (static_cast<int>(chosen.size()) < designs) {
        // Where the first ones leave no room for the others, from the beginning.
        chosen.clear();
        shuffle(all, random);
        for (const int code : all) {
            const bool free = std::none_of(
                chosen.begin(), chosen.end(), [&](int other) { return are_alike(code, other); });
            if (free) chosen.push_back(code);
            if (static_cast<int>(chosen.size()) == designs) break;
        }
    }
    std::vector<std::string> codes;
    for (const int code : chosen) codes.push_back(std::to_string(code));
    return codes;
}

PresentationOrder presentation_order(int designs,
                                     int evaluators,
                                     int wave_size,
                                     std::uint64_t seed) {
    PresentationOrder order;
    order.rows = williams_rows(designs);
    check_range("evaluators", evaluators, 0, kMostEvaluators);
    check_range("wave", wave_size, 1, kMostEvaluators);
    order.codes = random_codes(designs, seed);
    const auto rows = static_cast<int>(order.rows.size());
    const int waves = evaluators == 0 ? rows : (evaluators + wave_size - 1) / wave_size;
    Random random(seed, wave_stream);
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

}  // namespace livery
