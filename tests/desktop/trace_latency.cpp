#include "desktop/trace_latency.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

namespace livery {

double trace_now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::vector<std::optional<double>> to_projector_ms(const std::vector<TraceLine>& trace,
                                                   const std::vector<double>& inputs_s) {
    std::vector<std::optional<double>> answers;
    for (std::size_t i = 0; i < inputs_s.size(); ++i) {
        const double from = inputs_s[i], to = i + 1 < inputs_s.size() ? inputs_s[i + 1] : 1e300;
        std::optional<std::uint64_t> asked;
        std::optional<double> shown_s;
        for (const TraceLine& line : trace) {
            if (line.t_s < from || line.t_s >= to) continue;
            if (line.event == "frame-asked" && !asked) asked = line.number;
            if (line.event == "shown" && asked && line.number >= *asked) {
                shown_s = shown_s ? std::min(*shown_s, line.t_s) : line.t_s;
            }
        }
        answers.push_back(shown_s ? std::optional(1e3 * (*shown_s - from)) : std::nullopt);
    }
    return answers;
}

double percentile_of(std::vector<double> values, double fraction) {
    if (values.empty()) throw std::invalid_argument("percentile_of() needs values");
    std::ranges::sort(values);
    const auto last = static_cast<double>(values.size() - 1);
    return values[static_cast<std::size_t>(std::lround(fraction * last))];
}

}  // namespace livery
