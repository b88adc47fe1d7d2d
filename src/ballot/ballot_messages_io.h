// What a phone and the server say to one another: JSON.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/semantic_scale.h"

namespace livery {

/// A vote by the looks' codes.
struct VoteMessage {
    int round = 0, best = 0, second = 0;
    std::optional<int> least = {};
};

/// {"round": 3, "best": 412, "second": 907, "least": 133}; "least" may be missing or null. Throws
/// FileError that names the field, for anything else.
VoteMessage parse_vote(const std::string& body);

/// Where a look lies on the round's scales.
struct RatingMessage {
    int round = 0, look = 0;                ///< its code
    std::vector<std::optional<int>> steps;  ///< 1 to 7, one a scale; nothing: left open
};

/// {"round": 3, "look": 412, "steps": [4, null, 7]}. Throws FileError as above.
RatingMessage parse_rating(const std::string& body);

/// {"code": "K7M2PQ"}. Throws FileError as above.
std::string parse_join(const std::string& body);

/// What the page shows.
struct PageState {
    /// "join": no seat yet; "shut": no seat, and nobody is let in; "waiting": for a round;
    /// "presenting", "voting", "locked".
    std::string state = "waiting";
    int seat = 0;             ///< 0: none
    int round = 0;            ///< 0: none
    int wave = 0, waves = 0;  ///< the seat's, from 1, where people look in groups; 0: they do not
    std::vector<int> codes;   ///< while voting, in rising order
    bool asks_least = false;
    std::vector<SemanticScale> scales;  ///< while voting
    /// The seat's own answers, by the look's code.
    std::map<int, std::vector<std::optional<int>>> ratings;
    std::optional<VoteMessage> ballot;  ///< the seat's own
    std::string receipt;
};
std::string text_of(const PageState& state);

/// {"problem": "..."}
std::string problem_text(const std::string& problem);

}  // namespace livery
