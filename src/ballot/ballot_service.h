// What the phone page's server answers: a function of the request, the clock and the ballots' file.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "ballot/ballot_guard.h"
#include "ballot/ballot_messages_io.h"
#include "evaluation/ballots.h"

namespace livery {

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
