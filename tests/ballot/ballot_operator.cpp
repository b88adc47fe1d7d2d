// The operator's side of a ballots file, for tests in other languages: one command, JSON on stdout.
//
//   ballot_operator FILE open NAMES [present] [least]   a round, names with commas; its number
//   ballot_operator FILE voting|lock ROUND
//   ballot_operator FILE invitation                     {"token", "code"}, or null
//   ballot_operator FILE show                           checks the log; rounds, seats, who has
//   voted ballot_operator FILE ballots ROUND                  of a locked round: {"seat": [best,
//   second]} ballot_operator FILE session                        a new audience

#include <cstdio>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "evaluation/ballots.h"

namespace {

using namespace livery;
using Json = nlohmann::json;

Json shown(const BallotStore& store) {
    Json rounds = Json::array();
    for (const Round& round : store.rounds()) {
        rounds.push_back({{"id", round.id},
                          {"codes", round.codes},
                          {"voting", round.voting},
                          {"closed", round.closed},
                          {"voted", store.voted(round.id)}});
    }
    const auto session = store.session();
    return {{"rounds", rounds}, {"seats", session ? store.seats(*session).size() : 0}};
}

Json done(BallotStore& store, const std::vector<std::string>& words) {
    const std::string& what = words.at(0);
    if (what == "open") {
        RoundSetup setup;
        std::istringstream names(words.at(1));
        for (std::string name; std::getline(names, name, ',');) setup.designs.push_back(name);
        for (std::size_t k = 2; k < words.size(); ++k) {
            setup.presenting = setup.presenting || words[k] == "present";
            setup.asks_least = setup.asks_least || words[k] == "least";
        }
        return store.open_round(setup);
    }
    if (what == "voting") store.start_voting(std::stoi(words.at(1)));
    if (what == "lock") store.close_round(std::stoi(words.at(1)));
    if (what == "session") return store.open_session();
    if (what == "show") return shown(store);
    if (what == "invitation") {
        const auto invitation = store.invitation(store.session().value());
        if (!invitation) return nullptr;
        return {{"token", invitation->token}, {"code", invitation->code}};
    }
    if (what == "ballots") {
        Json ballots = Json::object();
        for (const CastBallot& ballot : store.ballots(std::stoi(words.at(1)))) {
            ballots[std::to_string(ballot.seat)] = {
                ballot.choices.best, ballot.choices.second, ballot.receipt};
        }
        return ballots;
    }
    return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 3) throw std::invalid_argument("FILE and a command");
        BallotStore store(argv[1]);
        std::puts(done(store, {argv + 2, argv + argc}).dump().c_str());
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "ballot_operator: %s\n", error.what());
        return 1;
    }
}
