#include "evaluation/closed_round.h"

#include <algorithm>
#include <system_error>

#include "core/database.h"
#include "core/error.h"
#include "core/shuffle.h"
#include "evaluation/ballot_log.h"
#include "evaluation/ballots.h"
#include "evaluation/csv_field.h"

namespace livery {

namespace {

Round find_round(const BallotStore& store, std::optional<int> id) {
    const std::vector<Round> rounds = store.rounds();
    const auto found = std::find_if(rounds.rbegin(), rounds.rend(), [&](const Round& round) {
        return id ? round.id == *id : round.closed;
    });
    if (found != rounds.rend()) return *found;
    if (id) {
        throw std::invalid_argument("found round " + std::to_string(*id) +
                                    ", expected one of the " + std::to_string(rounds.size()) +
                                    " rounds in " + store.file().string());
    }
    throw Refused("no round in " + store.file().string() +
                      " is closed: counts told before would "
                      "sway the votes to come",
                  "close the round, then ask for what it says");
}

/// The store tells counts alone. It has been opened before, so the file is sound.
std::vector<RankedBallot> ballots_of(const std::filesystem::path& file, int round) {
    constexpr std::int32_t application_id = 0x4c765642;
    constexpr int newest_version = 1;
    Database database(
        file, Database::Mode::read_only, application_id, newest_version, ballots_schema());
    std::vector<RankedBallot> ballots;
    for (const auto& row :
         database.run("SELECT best, second FROM ballots WHERE round = ?1 ORDER BY name_key",
                      {std::int64_t{round}})) {
        ballots.push_back({as_int(database, row[0]), as_int(database, row[1])});
    }
    return ballots;
}

}  // namespace

ClosedRound read_closed_round(const std::filesystem::path& file,
                              std::optional<int> id,
                              std::uint64_t seed) {
    std::error_code error;
    // Opening a store would make the file.
    if (!std::filesystem::exists(file, error)) {
        throw FileError(file, "", "no such file", "ballots that Livery keeps");
    }
    const BallotStore store(file);
    const Round round = find_round(store, id);
    store.tally(round.id);  // which refuses an open one
    ClosedRound closed{
        round.id, round.created, round.calibration_id, round.designs, ballots_of(file, round.id)};
    // In the order of the file neighbours would stay neighbours.
    constexpr std::uint64_t stream = 3;
    Random random(seed, stream);
    shuffle(closed.ballots, random);
    return closed;
}

std::string ballots_csv(const ClosedRound& round, std::uint64_t seed) {
    std::string text = "# round " + std::to_string(round.id) + " of " + round.created + "\r\n";
    text += "# calibration " +
            (round.calibration_id.empty() ? std::string("none") : round.calibration_id) + "\r\n";
    text += "# order of chance, seed " + std::to_string(seed) + "\r\n";
    text += "best,second\r\n";
    const auto name = [&](int design) {
        return csv_field(round.designs[static_cast<std::size_t>(design)]);
    };
    for (const RankedBallot& ballot : round.ballots) {
        text += name(ballot.best) + ',' + name(ballot.second) + "\r\n";
    }
    return text;
}

}  // namespace livery
