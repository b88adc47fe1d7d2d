#include "ledger/accuracy/chain.h"

#include <utility>

#include "core/error.h"
#include "core/statistics.h"
#include "core/worst_error.h"
#include "ledger/accuracy/chain_steps.h"

namespace livery {

void set_errors(ChainRow& row, const std::vector<float>& errors) {
    const auto at = [&](double fraction) {
        return static_cast<double>(worst_if_nan(quantile(errors, fraction)));
    };
    row.compared = errors.size();
    row.median = at(0.5);
    row.p95 = at(0.95);
    row.p99 = at(0.99);
}

std::vector<ChainPart> chain_parts(const AccuracyOptions& options) {
    std::vector<ChainPart> parts;
    for (const auto& of_step :
         {artwork_parts, half_float_parts, bit_parts, correction_parts, spectral_parts}) {
        for (ChainPart& part : of_step(options)) parts.push_back(std::move(part));
    }
    return parts;
}

std::vector<ChainRow> measured_rows(const std::vector<ChainPart>& parts,
                                    const AccuracyOptions& options,
                                    const Progress& progress) {
    check_argument(options.shard >= 1 && options.shards >= options.shard,
                   "a shard is one of all shards, counted from 1");
    const std::filesystem::path kept = options.folder / "rows";
    std::vector<ChainRow> rows;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const ChainPart& part = parts[k];
        const Progress own =
            progress.part(static_cast<double>(k) / static_cast<double>(parts.size()),
                          static_cast<double>(k + 1) / static_cast<double>(parts.size()));
        std::vector<ChainRow> of_part = part.rows;
        const auto leave_out = [&](const char* because) {
            for (ChainRow& row : of_part) row.missing = because;
        };
        own.update(0.0, of_part.front().what);
        const std::string hash = hash_of(part);
        if (auto known = read_chain_rows(kept, hash)) {
            of_part = std::move(*known);
        } else if (options.quick && part.slow) {
            leave_out("not measured by --quick");
        } else if (k % static_cast<std::size_t>(options.shards) !=
                   static_cast<std::size_t>(options.shard - 1)) {
            leave_out("another shard's, not there yet");
        } else {
            part.measure(of_part, own);
            for (ChainRow& row : of_part) {
                if (row.compared == 0) row.missing = "nothing to compare";
            }
            write_chain_rows(kept, hash, of_part);
        }
        for (ChainRow& row : of_part) rows.push_back(std::move(row));
    }
    return rows;
}

ChainLedger measure_chain(const AccuracyOptions& options, const Progress& progress) {
    ChainLedger ledger;
    const HeadlessContext context(options.device);
    ledger.renderer = context.renderer();
    ledger.rows = measured_rows(chain_parts(options), options, progress);
    return ledger;
}

}  // namespace livery
