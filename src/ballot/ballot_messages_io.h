// What a phone and the server say to one another: JSON.
#pragma once

#include <optional>
#include <string>

#include "evaluation/ballot_books.h"

namespace livery {

/// {"round": 3, "best": 412, "second": 907, "least": 133}, looks by their codes; "least" may be
/// missing or null. `round` is the one under vote. Throws FileError that names the field, for
/// anything else and for a code that is none of the round's, and Refused for another round.
Ballot parse_vote(const std::string& body, const std::optional<Round>& round);

/// Where a look lies on the round's scales.
struct RatingMessage {
    int design = 0;
    ScaleSteps steps;
};
/// {"round": 3, "look": 412, "steps": [4, null, 7]}; null: left open. Throws as parse_vote().
RatingMessage parse_rating(const std::string& body, const std::optional<Round>& round);

/// {"code": "K7M2PQ"}. Throws FileError as above.
std::string parse_join(const std::string& body);

/// What the page shows.
struct PageState {
    /// "join": no seat yet; "shut": no seat, and nobody is let in; "waiting": for a round;
    /// "presenting", "voting", "locked".
    std::string state = "waiting";
    int seat = 0;             ///< 0: none
    int wave = 0, waves = 0;  ///< the seat's, from 1, where people look in groups; 0: they do not
    std::optional<Round> round = {};
    bool votes = false;                     ///< the seat may vote: it is shown codes and scales
    ScaleAnswers answers = {};              ///< the seat's own
    std::optional<CastBallot> ballot = {};  ///< the same
};
std::string text_of(const PageState& state);

/// {"problem": "..."}
std::string problem_text(const std::string& problem);

}  // namespace livery
