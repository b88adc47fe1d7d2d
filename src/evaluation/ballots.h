// Rounds of votes on looks: who, best, second best. SQLite, one file of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/database.h"

namespace livery {

struct Ballot {
    std::string evaluator;     ///< as they want to be called; one ballot each a round
    int best = 0, second = 0;  ///< indices of the round's designs, different
};

struct Round {
    int id = 0;
    std::string created;  ///< ISO 8601, UTC
    std::vector<std::string> designs;
    std::string calibration_id;  ///< that the designs were shown under; empty: uncorrected
    bool closed = false;
    int ballots = 0;  ///< how many, all that is told before it is closed
};

/// Table 3 of the paper: counts a design.
struct Tally {
    std::vector<std::string> designs;
    std::vector<int> best, second;
};

/// Throws FileError of the file as Database does, std::invalid_argument for a ballot that makes no
/// sense (unknown round, same design twice, empty name, closed round).
class BallotStore {
  public:
    explicit BallotStore(const std::filesystem::path& file);

    int open_round(const std::vector<std::string>& designs, const std::string& calibration_id);
    /// A second ballot of the same evaluator replaces the first, while the round is open; both stay
    /// in the log.
    void vote(int round, const Ballot& ballot);
    void close_round(int round);
    std::vector<Round> rounds() const;
    std::optional<Round> open_round() const;
    /// Refused while the round is open.
    Tally tally(int round) const;

  private:
    mutable Database database_;
};

}  // namespace livery
