// One row of the ledger: what was timed, how often, and how long it took.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace livery {

struct LedgerLevel {
    std::string name;  ///< "1280x800, normal"
    double ms = 0.0;   ///< median
    double fastest_ms = 0.0;
    int repeats = 0;  ///< 0: it takes no time of its own
    double work_items = 0.0;
    std::optional<double> p95_ms, longest_ms;    ///< where a person waits for each one
    std::optional<double> error;                 ///< where there is a truth to compare with
    std::optional<double> error_p95, error_p99;  ///< where `error` is a median
    std::optional<double> swap_ms;               ///< beside `ms`, which is a new light's
    std::string unit;                            ///< of the error
    std::string against;  ///< what it is an error against, where levels of a ledger differ in that
    std::string missing;  ///< why it was not measured, where it was not
};

struct LedgerEffect {
    std::string name;
    std::vector<LedgerLevel> levels;
};

/// Median and fastest of the repeats, of which there is at least one.
LedgerLevel level_of(const std::string& name, std::vector<double> ms);
/// The same, for something that a person waits for.
LedgerLevel waited_level_of(const std::string& name, std::vector<double> ms);

}  // namespace livery
