// The file behind a ballot store, for tests that look inside or do harm.
#pragma once

#include <filesystem>

#include "core/database.h"
#include "evaluation/ballots.h"

namespace livery {

constexpr std::int32_t kBallotsId = 0x4c765642;

inline Database raw_ballots(const std::filesystem::path& file) {
    return {file, Database::Mode::existing, kBallotsId, 4, ballots_schema()};
}

}  // namespace livery
