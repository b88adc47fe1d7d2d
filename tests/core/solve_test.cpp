// Fits that somebody stops.
#include "core/solve.h"

#include <atomic>

#include <gtest/gtest.h>

namespace livery {
namespace {

/// Rosenbrock's valley, which takes many iterations; asks for a stop in one of its evaluations.
struct Valley {
    int stops_at;
    int* evaluations;
    std::atomic<bool>* stop;

    bool operator()(const double* at, double* residual) const {
        if (++*evaluations == stops_at) *stop = true;
        residual[0] = 100.0 * (at[1] - at[0] * at[0]);
        residual[1] = 1.0 - at[0];
        return true;
    }
};

/// Evaluations that a fit from the same start takes.
int evaluations_until_end(int stops_at, bool& cancelled) {
    int evaluations = 0;
    std::atomic<bool> stop = false;
    double at[2] = {-1.9, 2.0};
    ceres::Problem problem;
    problem.AddResidualBlock(new ceres::NumericDiffCostFunction<Valley, ceres::CENTRAL, 2, 2>(
                                 new Valley{stops_at, &evaluations, &stop}),
                             nullptr,
                             at);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 1000;
    options.logging_type = ceres::SILENT;
    try {
        solved(options, problem, {nullptr, &stop});
        cancelled = false;
        EXPECT_NEAR(at[0], 1.0, 1e-3);
        EXPECT_NEAR(at[1], 1.0, 1e-3);
    } catch (const Cancelled&) {
        cancelled = true;
    }
    return evaluations;
}

TEST(Solved, EndsAtTheNextIterationWhenAsked) {
    bool cancelled = true;
    const int whole = evaluations_until_end(-1, cancelled);
    EXPECT_FALSE(cancelled);
    // An iteration is one evaluation of the step and four of its slopes at most.
    constexpr int kIteration = 6;
    for (const int stops_at : {1, 20, whole / 2}) {
        const int taken = evaluations_until_end(stops_at, cancelled);
        EXPECT_TRUE(cancelled) << stops_at;
        EXPECT_LE(taken, stops_at + 2 * kIteration) << "of " << whole;
        EXPECT_LT(taken, whole);
    }
}

}  // namespace
}  // namespace livery
