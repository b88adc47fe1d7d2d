#include "evaluation/closed_round.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/random.h"

namespace livery {

namespace {

Round find_round(const BallotStore& store, std::optional<int> id) {
    const std::vector<Round> rounds = store.rounds();
    const auto found = std::find_if(rounds.rbegin(), rounds.rend(), [&](const Round& round) {
        // One that was broken off before people could vote says nothing.
        return id ? round.id == *id : round.closed() && round.voting();
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

std::vector<LookShowing> showings_of(const PresentationPlan& plan,
                                     const std::vector<PresentationStep>& steps,
                                     const std::vector<int>& codes) {
    std::vector<LookShowing> showings;
    int sitting = -1, shown = -1;
    for (const PresentationStep& step : steps) {
        const int design = design_of(plan, step.state);
        if (design < 0) {
            shown = -1;  // grey, white: the next look is shown anew
            continue;
        }
        if (step.state.sitting != sitting) {
            const auto at = static_cast<std::size_t>(step.state.sitting);
            showings.push_back(
                {step.at, at < plan.seats.size() ? plan.seats[at] : std::vector<int>(), {}});
        }
        sitting = step.state.sitting;
        const bool again = step.event == PresentationEvent::repeat;
        const int place = step.state.place;
        if (place != shown || again) {
            showings.back().codes.push_back(codes.at(static_cast<std::size_t>(design)));
        }
        shown = place;
    }
    return showings;
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
    ClosedRound closed{find_round(store, id), file.filename().string()};
    const Round& round = closed.round;
    // Which refuses an open one
    const auto cast = store.ballots(round.id);
    closed.seats = static_cast<int>(store.seats(round.session).size());
    closed.duel = duel_of(store, round.id);
    if (const auto plan = store.plan_of(round.id)) {
        closed.showings = showings_of(*plan, store.steps_of(round.id), round.codes);
    }
    struct Evaluator {
        Ballot ballot;
        ScaleAnswers answers;
    };
    std::vector<Evaluator> evaluators;
    for (const CastBallot& one : cast) {
        evaluators.push_back({one.ballot, store.ratings_of(round.id, one.seat)});
    }
    // In the order of the file neighbours would stay neighbours.
    constexpr std::uint64_t stream = 3;
    Random random(seed, stream);
    shuffle(evaluators, random);
    for (Evaluator& one : evaluators) {
        closed.ballots.push_back(one.ballot);
        if (!round.scales.empty()) closed.answers.push_back(std::move(one.answers));
    }
    const auto names_least = [](const Ballot& ballot) { return ballot.least >= 0; };
    closed.all_name_least = round.designs.size() > 2 && !closed.ballots.empty() &&
                            std::all_of(closed.ballots.begin(), closed.ballots.end(), names_least);
    return closed;
}

std::string ballots_csv(const ClosedRound& closed, std::uint64_t seed) {
    const Round& round = closed.round;
    std::string text = "# round " + std::to_string(round.id) + " of " + round.created + "\r\n";
    text += "# calibration " +
            (round.calibration_id.empty() ? std::string("none") : round.calibration_id) + "\r\n";
    text += "# order of chance, seed " + std::to_string(seed) + "\r\n";
    const bool any_least = std::any_of(closed.ballots.begin(),
                                       closed.ballots.end(),
                                       [](const Ballot& ballot) { return ballot.least >= 0; });
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
    for (std::size_t k = 0; k < closed.ballots.size(); ++k) {
        const Ballot& ballot = closed.ballots[k];
        text += name(ballot.best) + ',' + name(ballot.second);
        if (any_least) text += ',' + (ballot.least >= 0 ? name(ballot.least) : std::string());
        for (std::size_t design = 0; k < closed.answers.size() && design < round.designs.size();
             ++design) {
            for (const int step : closed.answers[k][design]) {
                text += ',' + (step > 0 ? std::to_string(step) : std::string());
            }
        }
        text += "\r\n";
    }
    return text;
}

}  // namespace livery
