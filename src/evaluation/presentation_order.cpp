#include "evaluation/presentation_order.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "core/error.h"
#include "core/random.h"
#include "evaluation/design_codes.h"
#include "evaluation/statistics/vote_counts.h"

namespace livery {

namespace {

void check_range(const char* name, int value, int low, int high) {
    check_argument(value >= low && value <= high,
                   std::string(name) + ": found " + std::to_string(value) + ", expected " +
                       std::to_string(low) + " to " + std::to_string(high));
}

// A stream of its own: one more code moves no wave.
constexpr std::uint64_t kWaveStream = 2;

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

}  // namespace livery
