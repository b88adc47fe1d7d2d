// The file behind a ballot store, for tests that look inside or do harm.
#pragma once

#include <filesystem>

#include "core/database.h"
#include "evaluation/ballots.h"

namespace livery {

constexpr std::int32_t kBallotsId = 0x4c765642;

inline Database raw_ballots(const std::filesystem::path& file) {
    return {file, Database::Mode::existing, kBallotsId, 5, ballots_schema()};
}

/// Appends what no store would: sealed as Livery does, for entries that a forger might write.
inline void forge(const std::filesystem::path& file, int session, int round, LogEntry::What what) {
    Database database = raw_ballots(file);
    LogSeal end = seal_of(database);
    LogEntry entry{session, round, "2026-01-01T00:00:00Z", std::move(what)};
    append_to_log(database, end, entry);
}

}  // namespace livery
