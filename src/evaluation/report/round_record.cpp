#include "evaluation/report/round_record.h"

#include <algorithm>

#include "evaluation/ballots.h"

namespace livery {

RoundRecord read_round_record(const std::filesystem::path& file,
                              std::optional<int> id,
                              std::uint64_t seed) {
    RoundRecord record;
    record.round = read_closed_round(file, id, seed);
    record.file = file.filename().string();
    const BallotStore store(file);
    for (const Round& round : store.rounds()) {
        if (round.id != record.round.id) continue;
        record.codes = round.codes;
        record.codes_seed = round.seed;
        record.asks_least = round.asks_least;
        record.session = round.session;
    }
    record.seats = static_cast<int>(store.seats(record.session).size());
    for (const LogEntry& entry : store.log()) {
        if (entry.round != record.round.id) continue;
        if (entry.what == LogEntry::What::voting) record.voting_at = entry.at;
        if (entry.what == LogEntry::What::close) {
            record.locked_at = entry.at;
            record.log_entry = entry.id;
            record.log_hash = entry.hash;
        }
    }
    return record;
}

}  // namespace livery
