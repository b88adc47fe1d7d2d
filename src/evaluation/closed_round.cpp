#include "evaluation/closed_round.h"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/random.h"
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

ScaleAnswers no_answers(const Round& round) {
    return {round.designs.size(), std::vector<int>(round.scales.size(), 0)};
}

std::map<int, ScaleAnswers> answers_by_seat(const BallotStore& store, const Round& round) {
    std::map<int, ScaleAnswers> answers;
    if (round.scales.empty()) return answers;
    for (const CastRatings& cast : store.ratings(round.id)) {
        ScaleAnswers& own = answers.try_emplace(cast.seat, no_answers(round)).first->second;
        for (const auto& [design, steps] : cast.steps) {
            for (std::size_t scale = 0; scale < steps.size(); ++scale) {
                own.at(static_cast<std::size_t>(design))[scale] = steps[scale].value_or(0);
            }
        }
    }
    return answers;
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
    closed.scales = round.scales;
    struct Evaluator {
        RankedBallot ballot;
        ScaleAnswers answers;
    };
    std::vector<Evaluator> evaluators;
    // Which refuses an open one
    const auto cast = store.ballots(round.id);
    const auto ratings = answers_by_seat(store, round);
    for (const CastBallot& one : cast) {
        const auto found = ratings.find(one.seat);
        evaluators.push_back(
            {{one.choices.best, one.choices.second, one.choices.least.value_or(-1)},
             found == ratings.end() ? no_answers(round) : found->second});
    }
    // In the order of the file neighbours would stay neighbours.
    constexpr std::uint64_t stream = 3;
    Random random(seed, stream);
    shuffle(evaluators, random);
    for (Evaluator& one : evaluators) {
        closed.ballots.push_back(one.ballot);
        if (!round.scales.empty()) closed.answers.push_back(std::move(one.answers));
    }
    const auto names_least = [](const RankedBallot& ballot) { return ballot.least >= 0; };
    closed.all_name_least = closed.designs.size() > 2 && !closed.ballots.empty() &&
                            std::all_of(closed.ballots.begin(), closed.ballots.end(), names_least);
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
    text += any_least ? "best,second,least" : "best,second";
    for (const std::string& design : round.designs) {
        for (const SemanticScale& scale : round.scales) {
            text += ',' + csv_field(design + ": " + scale.low + " - " + scale.high);
        }
    }
    text += "\r\n";
    const auto name = [&](int design) {
        return csv_field(round.designs[static_cast<std::size_t>(design)]);
    };
    for (std::size_t k = 0; k < round.ballots.size(); ++k) {
        const RankedBallot& ballot = round.ballots[k];
        text += name(ballot.best) + ',' + name(ballot.second);
        if (any_least) text += ',' + (ballot.least >= 0 ? name(ballot.least) : std::string());
        for (std::size_t design = 0; k < round.answers.size() && design < round.designs.size();
             ++design) {
            for (const int step : round.answers[k][design]) {
                text += ',' + (step > 0 ? std::to_string(step) : std::string());
            }
        }
        text += "\r\n";
    }
    return text;
}

}  // namespace livery
