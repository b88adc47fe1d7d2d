#include "evaluation/closed_round.h"

#include <algorithm>
#include <system_error>

#include "core/error.h"
#include "core/shuffle.h"
#include "evaluation/ballots.h"
#include "evaluation/csv_field.h"

namespace livery {

namespace {

Round find_round(const BallotStore& store, std::optional<int> id) {
    const std::vector<Round> rounds = store.rounds();
    const auto found = std::find_if(rounds.rbegin(), rounds.rend(), [&](const Round& round) {
        // One that was broken off before people could vote says nothing.
        return id ? round.id == *id : round.closed && round.voting;
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
    ClosedRound closed{round.id, round.created, round.calibration_id, round.designs, {}, false};
    // Which refuses an open one
    for (const CastBallot& cast : store.ballots(round.id)) {
        closed.ballots.push_back(
            {cast.choices.best, cast.choices.second, cast.choices.least.value_or(-1)});
    }
    const auto names_least = [](const RankedBallot& ballot) { return ballot.least >= 0; };
    closed.all_name_least = closed.designs.size() > 2 && !closed.ballots.empty() &&
                            std::all_of(closed.ballots.begin(), closed.ballots.end(), names_least);
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
    const bool any_least =
        std::any_of(round.ballots.begin(), round.ballots.end(), [](const RankedBallot& ballot) {
            return ballot.least >= 0;
        });
    text += any_least ? "best,second,least\r\n" : "best,second\r\n";
    const auto name = [&](int design) {
        return csv_field(round.designs[static_cast<std::size_t>(design)]);
    };
    for (const RankedBallot& ballot : round.ballots) {
        text += name(ballot.best) + ',' + name(ballot.second);
        if (any_least) text += ',' + (ballot.least >= 0 ? name(ballot.least) : std::string());
        text += "\r\n";
    }
    return text;
}

}  // namespace livery
