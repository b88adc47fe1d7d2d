// What a phone, or anybody, may send: a cookie header, a join code and a body, each on a line of
// its own.
#include <algorithm>
#include <string>

#include "ballot/ballot_guard.h"
#include "ballot/ballot_service.h"
#include "core/json.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const std::size_t line = std::min(text.find('\n'), text.size());
    const std::string first = text.substr(0, line);
    const std::string rest = text.substr(std::min(line + 1, text.size()));
    if (const auto secret = seat_secret(first)) {
        fuzz::require(secret->size() == 32, "a secret has 32 digits");
        fuzz::require(secret->find_first_not_of("0123456789abcdef") == std::string::npos,
                      "a secret is hexadecimal");
        fuzz::require(seat_secret(seat_cookie(*secret, true)) == secret, "a cookie comes back");
    }
    BallotRequest request;
    request.host = first;
    request.origin = "http://" + rest;
    const ServerNames names{false, {"127.0.0.1:8470"}};
    fuzz::require(!host_is_ours(request, names) || first.size() == 14, "one host is ours");
    fuzz::require(!origin_is_ours(request, names) || first.size() == rest.size(),
                  "an origin is the host's");
    fuzz::require(same_secret(first, rest) == (first == rest), "secrets are compared");
    bool told = true;
    try {
        told = parse_json(problem_text(first), "answer").contains("problem");
    } catch (const FileError&) {
        told = false;
    }
    fuzz::require(told, "an answer is JSON, whatever it quotes");
    try {
        parse_join(rest);
    } catch (const FileError&) {
    }
    Round round;
    round.id = 1;
    round.codes = {481, 376, 912};
    round.designs = {"red", "silver", "sand"};
    PageState state{"voting", 1, 0, 0, round, true};
    try {
        const RatingMessage rating = parse_rating(rest, round);
        fuzz::require(rating.design >= 0 && rating.design < 3, "a look of the round");
        fuzz::require(!rating.steps.empty() && rating.steps.size() <= kMostScales,
                      "a step a scale");
        for (const int step : rating.steps) {
            fuzz::require(step >= 0 && step <= kScaleSteps, "a step is 1 to 7, or open");
        }
        state.answers = {rating.steps};
    } catch (const FileError&) {
    } catch (const Refused&) {
    }
    // Whatever the words are, the page gets them as they are, as text of JSON.
    state.round->scales = {{first.substr(0, 40), "b"}};
    try {
        parse_json(text_of(state), "answer");
    } catch (const FileError&) {
        fuzz::require(false, "an answer is JSON, whatever the words are");
    }
    try {
        const Ballot ballot = parse_vote(rest, round);
        for (const int look : {ballot.best, ballot.second, std::max(ballot.least, 0)}) {
            fuzz::require(look >= 0 && look < 3, "a look of the round");
        }
        state.ballot = CastBallot{1, ballot, "00000000"};
        fuzz::require(!text_of(state).empty(), "a vote can be told");
    } catch (const Refused&) {
    }
}
