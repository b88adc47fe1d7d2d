// `livery bench --suite accuracy`: what each level of each effect costs in time, and what it costs
// in colour to spend less. docs/accuracy.md holds its tables and plot.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gl/context.h"
#include "ledger/accuracy/rows.h"
#include "ledger/level.h"

namespace livery {

struct AccuracyLedger {
    std::string renderer;
    int threads = 0, samples_per_pixel = 0;
    std::vector<AccuracyRow> rows;  ///< all that are known, of every shard that shares the folder
    std::size_t missing = 0;        ///< rows of other shards that are not there yet
    double traced_seconds = 0.0;
};

struct AccuracyOptions {
    GlDevice device = GlDevice::automatic;
    bool quick = false;
    int shard = 1, shards = 1;  ///< this process measures every `shards`-th scene, from `shard` on
    std::filesystem::path folder;  ///< of truths and rows that are kept
    std::uint64_t seed = 1;
    /// Hears of the ledger as it grows, after every row; may be empty.
    std::function<void(const AccuracyLedger&)> on_row;
};
/// Where truths and rows are kept unless somebody says otherwise: in the user's folder.
std::filesystem::path accuracy_folder();

/// Throws FileError where the folder cannot be written. A stop loses one row at most: the next run
/// goes on with the rest.
AccuracyLedger measure_accuracy(const AccuracyOptions& options, const Progress& progress = {});

/// A level over all scenes that call for it: medians of what their rows say, and the worst p95 and
/// p99.
struct AccuracyLevel {
    std::string effect, level;
    int index = 0, scenes = 0;
    double own_ms = 0.0, solve_ms = 0.0, swap_ms = 0.0;
    double median = 0.0, p95 = 0.0, p99 = 0.0;
    double floor_median = 0.0, floor_p95 = 0.0;
    bool resolved = true;  ///< its median is above what the truth itself may err by
};
std::vector<AccuracyLevel> levels_of(const AccuracyLedger& ledger);
/// Of each level, whether nothing takes as little time for a new light and errs as little at the
/// 95th percentile. Levels of effects that less than half of the scenes call for stand aside.
std::vector<bool> front_of(const std::vector<AccuracyLevel>& levels);

std::vector<LedgerEffect> effects_of(const AccuracyLedger& ledger);
std::string markdown_of(const AccuracyLedger& ledger);
/// Every row: scene, effect, level, times and errors, with a heading.
std::string csv_of(const AccuracyLedger& ledger);
/// Error against time, both logarithmic, with the front of what nothing beats in both.
std::string plot_of(const AccuracyLedger& ledger);

/// As JSON: what it was measured on, and the rows that are called for.
void write_accuracy(const std::filesystem::path& file, const AccuracyLedger& ledger);
/// Rows of effects and levels that this version does not know are left out. Throws FileError for a
/// malformed text.
AccuracyLedger parse_accuracy(const std::string& text, const std::filesystem::path& file);
std::filesystem::path accuracy_file();  ///< of the last ledger of this machine
struct KnownAccuracy {
    AccuracyLedger ledger;
    bool measured_here = false;  ///< else shipped with the program
};
KnownAccuracy known_accuracy();

}  // namespace livery
