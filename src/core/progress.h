// How long work tells how far it is, and how it is stopped.
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

#include "core/error.h"

namespace livery {

/// Passed down to anything that may take more than two seconds. Default-constructed: silent.
struct Progress {
    /// Fraction in [0, 1] of the current stage, and what the stage is doing, for a person.
    std::function<void(double fraction, std::string_view stage)> report;
    const std::atomic<bool>* stop = nullptr;

    /// Reports and throws Cancelled when a stop was asked for.
    void update(double fraction, std::string_view stage) const {
        check_stop();
        if (report) report(fraction, stage);
    }
    /// For one part of the work, whose own 0 to 1 is `from` to `to` of the whole.
    Progress part(double from, double to) const {
        if (!report) return *this;
        return {[whole = report, from, to](double fraction, std::string_view stage) {
                    whole(from + (to - from) * fraction, stage);
                },
                stop};
    }
    void check_stop() const {
        if (stop && stop->load(std::memory_order_relaxed)) throw Cancelled();
    }
};

}  // namespace livery
