#include "ledger/accuracy/accuracy.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/paths.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {

namespace {

constexpr int kFullSamples = 256, kQuickSamples = 64;

std::vector<const AccuracyRow*> of_level(const AccuracyLedger& ledger, const AccuracyRow& like) {
    std::vector<const AccuracyRow*> rows;
    for (const AccuracyRow& row : ledger.rows) {
        if (row.called_for && row.effect == like.effect && row.level == like.level) {
            rows.push_back(&row);
        }
    }
    return rows;
}

}  // namespace

std::filesystem::path accuracy_folder() { return user_folder() / "cache" / "accuracy"; }

AccuracyLedger measure_accuracy(const AccuracyOptions& options, const Progress& progress) {
    check_argument(options.shards >= 1 && options.shard >= 1 && options.shard <= options.shards,
                   fmt::format("shard {} of {}", options.shard, options.shards));
    const std::vector<AccuracyScene> scenes = accuracy_scenes(options.quick, progress);
    TruthOptions truths;
    const int samples = options.quick ? kQuickSamples : kFullSamples;
    truths.samples_per_pixel = samples;
    truths.seed = options.seed;
    truths.folder = options.folder / "truths";
    const std::filesystem::path kept = options.folder / "rows";

    AccuracyLedger ledger;
    ledger.threads = thread_count();
    ledger.samples_per_pixel = samples;
    const std::vector<AccuracyRow> wanted = rows_to_measure(scenes);
    const HeadlessContext context(options.device);
    ledger.renderer = context.renderer();
    const auto keep = [&](AccuracyRow row) {
        ledger.rows.push_back(std::move(row));
        if (options.on_row) options.on_row(ledger);
    };
    for (std::size_t k = 0; k < scenes.size(); ++k) {
        const AccuracyScene& scene = scenes[k];
        const double begin = static_cast<double>(k) / static_cast<double>(scenes.size());
        const double end = static_cast<double>(k + 1) / static_cast<double>(scenes.size());
        const Progress part = progress.part(begin, end);
        const bool own = k % static_cast<std::size_t>(options.shards) ==
                         static_cast<std::size_t>(options.shard - 1);
        // The hash alone is asked for first: a scene whose rows are all there is not traced.
        const std::string hash = truth_hash(scene, truths);
        std::vector<const AccuracyRow*> of_scene;
        for (const AccuracyRow& row : wanted) {
            if (row.scene == scene.name) of_scene.push_back(&row);
        }
        std::optional<Truth> truth;
        std::optional<RowMeasurement> measurement;
        for (std::size_t r = 0; r < of_scene.size(); ++r) {
            AccuracyRow row = *of_scene[r];
            if (!row.called_for) {
                ledger.rows.push_back(row);
                continue;
            }
            const std::string row_hash = hash_of(row, hash);
            if (const auto known = read_row(kept, row_hash)) {
                AccuracyRow whole = *known;
                whole.index = row.index;
                whole.levels = row.levels;
                keep(std::move(whole));
                continue;
            }
            if (!own) {
                ++ledger.missing;
                continue;
            }
            if (!truth) {
                part.update(0.0, "tracing " + scene.name);
                truth = truth_of(scene, truths, part.part(0.0, 0.6));
                ledger.traced_seconds += truth->seconds;
                measurement.emplace(scene, *truth);
            }
            part.update(0.6 + 0.4 * static_cast<double>(r) / static_cast<double>(of_scene.size()),
                        row.effect + " " + row.level + ": " + scene.name);
            row = measurement->measured(row, Progress{{}, progress.stop});
            write_row(kept, row_hash, row);
            keep(std::move(row));
        }
    }
    return ledger;
}

std::vector<AccuracyLevel> levels_of(const AccuracyLedger& ledger) {
    std::vector<AccuracyLevel> levels;
    for (const AccuracyRow& row : ledger.rows) {
        if (std::any_of(levels.begin(), levels.end(), [&](const AccuracyLevel& known) {
                return known.effect == row.effect && known.level == row.level;
            })) {
            continue;
        }
        const auto rows = of_level(ledger, row);
        if (rows.empty()) continue;
        const auto middle = [&](const auto& value) {
            std::vector<double> values;
            for (const AccuracyRow* one : rows) values.push_back(value(*one));
            return median(values);
        };
        const auto largest = [&](const auto& value) {
            double worst = 0.0;
            for (const AccuracyRow* one : rows) worst = worse_of(worst, value(*one));
            return worst;
        };
        AccuracyLevel& level = levels.emplace_back();
        level.effect = row.effect;
        level.level = row.level;
        level.index = row.index;
        level.scenes = static_cast<int>(rows.size());
        level.own_ms = middle([](const AccuracyRow& r) { return r.own_ms; });
        level.solve_ms = middle([](const AccuracyRow& r) { return r.solve_ms; });
        level.swap_ms = middle([](const AccuracyRow& r) { return r.swap_ms; });
        level.median = middle([](const AccuracyRow& r) { return r.error.median; });
        level.p95 = largest([](const AccuracyRow& r) { return r.error.p95; });
        level.p99 = largest([](const AccuracyRow& r) { return r.p99; });
        level.floor_median = middle([](const AccuracyRow& r) { return r.floor_median; });
        level.floor_p95 = largest([](const AccuracyRow& r) { return r.floor_p95; });
        level.resolved = level.median > level.floor_median;
    }
    return levels;
}

std::vector<bool> front_of(const std::vector<AccuracyLevel>& levels) {
    int most = 0;
    for (const AccuracyLevel& level : levels) most = std::max(most, level.scenes);
    // The worst of two scenes is no match for the worst of sixteen
    const auto compares = [&](const AccuracyLevel& level) { return 2 * level.scenes >= most; };
    std::vector<bool> on_front;
    for (const AccuracyLevel& level : levels) {
        on_front.push_back(
            compares(level) &&
            std::none_of(levels.begin(), levels.end(), [&](const AccuracyLevel& other) {
                return compares(other) && other.solve_ms <= level.solve_ms &&
                       other.p95 <= level.p95 &&
                       (other.solve_ms < level.solve_ms || other.p95 < level.p95);
            }));
    }
    return on_front;
}

}  // namespace livery
