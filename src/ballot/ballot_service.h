// What the phone page's server answers, and what it says in JSON: a function of the request, the
// clock and the ballots' file.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "ballot/ballot_guard.h"
#include "evaluation/ballots.h"

namespace livery {

// --- what a phone and the server say to one another: JSON ---

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

// --- the server ---

/// The page, compiled in: nothing is read from a folder, and no request leaves it.
std::string_view page_html();
std::string_view page_css();
std::string_view page_js();

struct BallotServiceSettings {
    ServerNames names;
    /// An address that has no seat yet gets one beyond this, up to 400, so that one phone cannot
    /// take them all.
    int most_seats = 40;
};

/// Keeps no vote in memory: every answer is read from the file, and a vote is told to be received
/// once it is on the disk. For one thread.
///
///     GET  /                    the page, with /page.css and /page.js
///     GET  /join/TOKEN          from the QR code: a seat, and a redirect to /
///     POST /join                {"code"}: the same by the eight characters
///     GET  /state               what the page shows
///     PUT  /ballot              {"round", "best", "second", "least"}; within ChangeLimit
///     PUT  /scales              {"round", "look", "steps"}: the same, after the ballot
class BallotService {
  public:
    /// Opens the file as BallotStore does, and makes its first session where there is none.
    BallotService(const std::filesystem::path& file, BallotServiceSettings settings);

    /// Never throws: what fails inside is an answer too.
    BallotResponse answer(const BallotRequest& request, double now_s);

    /// Gives the newest session its invitation, and a fresh code where the last has run out. To be
    /// called every now and then; seconds since 1970.
    void keep_invitation(double now_s);

    BallotStore& store() { return store_; }

  private:
    BallotResponse route(const BallotRequest& request, double now_s);
    BallotResponse join_by_token(const BallotRequest& request);
    BallotResponse join_by_code(const BallotRequest& request, double now_s);
    BallotResponse seated(const BallotRequest& request, BallotResponse response);
    template <typename Take>
    BallotResponse changed_by_seat(const BallotRequest& request, double now_s, const Take& take);
    BallotResponse take_vote(const BallotRequest& request, double now_s);
    BallotResponse take_rating(const BallotRequest& request, double now_s);
    bool is_join_code(const std::string& code, int session, double now_s);
    PageState state_for(const BallotRequest& request);
    int seat_of(const BallotRequest& request, int session);

    BallotStore store_;
    BallotServiceSettings settings_;
    ChangeLimit changes_;
    Invitation last_;                              ///< whose code was shown until a moment ago
    std::map<int, std::set<std::string>> seated_;  ///< addresses that have a seat, by session
};

}  // namespace livery
