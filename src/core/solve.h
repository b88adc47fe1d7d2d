// Least squares that somebody can stop.
#pragma once

#include <ceres/ceres.h>

#include "core/progress.h"

namespace livery {

/// ceres::Solve(), which ends at the next step when a stop is asked for. Throws Cancelled then.
inline ceres::Solver::Summary solved(ceres::Solver::Options options,
                                     ceres::Problem& problem,
                                     const Progress& progress) {
    struct StopWhenAsked : ceres::IterationCallback {
        explicit StopWhenAsked(const Progress& of) : progress(of) {}
        ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
            const bool stop = progress.stop && progress.stop->load(std::memory_order_relaxed);
            return stop ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
        }
        const Progress& progress;
    } stop(progress);
    options.callbacks.push_back(&stop);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    progress.check_stop();
    return summary;
}

}  // namespace livery
