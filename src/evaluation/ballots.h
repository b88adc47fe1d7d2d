// Rounds of votes on looks: who, best, second best. SQLite, one file of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/database.h"
#include "evaluation/tally.h"

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

/// The statements that make the file: tables, and triggers that keep what is recorded.
const std::vector<std::string>& ballots_schema();

/// What a function has done is on disk when it returns. Several stores (and programs) may share a
/// file. Throws FileError of the file as Database does, and when the ballots are not what their log
/// says; std::invalid_argument for what makes no sense (unknown round, no such design, same design
/// twice, bad name); Refused, with the fix, for what the round's state forbids.
class BallotStore {
  public:
    /// Opens the file or makes it; reads the whole log and checks it.
    explicit BallotStore(const std::filesystem::path& file);

    /// At least two designs, all different. Refused while another round is open.
    int open_round(const std::vector<std::string>& designs, const std::string& calibration_id);
    /// A second ballot of the same evaluator (name_key) replaces the first, while the round is
    /// open; both stay in the log. Refused when it is closed.
    void vote(int round, const Ballot& ballot);
    /// For good. Refused when it is closed already.
    void close_round(int round);
    std::vector<Round> rounds() const;
    std::optional<Round> open_round() const;
    /// Refused while the round is open.
    Tally tally(int round) const;
    const std::filesystem::path& file() const { return database_.file(); }

  private:
    mutable Database database_;
};

}  // namespace livery
