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
    void check_stop() const {
        if (stop && stop->load(std::memory_order_relaxed)) throw Cancelled();
    }
};

}  // namespace livery
