// Rounds of votes on looks: who, best, second best, perhaps least. One file of their own, an SQLite
// database with a log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/database.h"
#include "evaluation/ballot_books.h"

namespace livery {

struct RoundSetup {
    std::vector<std::string> designs;
    std::string calibration_id = {};  ///< that the designs are shown under; empty: uncorrected
    std::vector<int> codes = {};  ///< a design each, 100 to 999; empty: drawn from seed and round
    int seed = 1;
    bool asks_least = false;
    bool presenting = false;  ///< votes count from start_voting() on; else at once
    /// How it is presented: by this program, which records each step (record_step()). Of all
    /// designs; with `presenting`. One of several sittings without seats has the phones that are in
    /// dealt to them when the round is opened (deal_seats()).
    std::optional<PresentationPlan> plan = {};
    std::optional<SeriesPlace> series = {};
    std::vector<SemanticScale> scales = {};  ///< on which each look may be placed; at most 5
};

/// Of those who have names and no phones.
using NamedBallots = std::vector<std::pair<std::string, Ballot>>;

/// How phones come in: by the token in the QR code, or by eight characters typed in.
struct Invitation {
    std::string token, code;
    std::int64_t code_until_s = 0;  ///< seconds since 1970
};

/// The statements that make the file, then names of tables that files of format 4 have beside the
/// log.
const std::vector<std::string>& ballots_schema();

/// What a function has done is on disk when it returns. Several stores (and programs) may share a
/// file: each begins with what the others have added to the log since it last looked. Throws
/// FileError of the file as Database does, and when the log is not as Livery wrote it;
/// std::invalid_argument for what makes no sense and Refused, with the fix, for what the round's
/// state forbids, as apply() has it.
class BallotStore {
  public:
    /// Opens the file or makes it; reads the whole log and checks it. A file of format 4 becomes
    /// one of format 5, in one transaction.
    explicit BallotStore(const std::filesystem::path& file);

    /// A new audience: phones join anew. Refused while a round is open.
    int open_session();
    /// The newest; nothing in an empty file.
    std::optional<int> session() const;
    std::optional<Invitation> invitation(int session) const;
    void invite(int session, const Invitation& invitation);
    /// The seat of the phone with this secret's hash, a new one where it has none. Refused while a
    /// round is open (who joined then would not have seen every look) and when `most_seats` phones
    /// are in.
    int join(int session, const std::string& secret_hash, int most_seats);
    std::optional<int> seat_of_phone(int session, const std::string& secret_hash) const;
    std::vector<Seat> seats(int session) const;

    /// In the newest session, which is made where there is none. At least two designs, all
    /// different. Refused while another round is open.
    int open_round(const RoundSetup& setup);
    int open_round(const std::vector<std::string>& designs, const std::string& calibration_id) {
        return open_round(RoundSetup{designs, calibration_id});
    }
    /// Refused when votes are taken already, and when it is closed.
    void start_voting(int round);
    /// A second ballot of the same seat replaces the first, while the round is open; both stay in
    /// the log. One that is as the seat's ballot is already changes nothing. Refused when the round
    /// is closed or still presented, and while the seat's turn is to come.
    CastBallot vote(int round, int seat, const Ballot& ballot);
    /// The same for who has a name (name_key) and no phone: a new seat where it has none.
    CastBallot vote(int round, const std::string& evaluator, const Ballot& ballot);
    /// All of them or, where one throws, none.
    std::vector<CastBallot> vote(int round, const NamedBallots& ballots);
    /// Places a look on the round's scales; a step that is left open (0) takes an earlier one back.
    /// One that is as it was changes nothing. Refused as vote() is, and before the seat has voted.
    void rate(int round, int seat, int design, const ScaleSteps& steps);
    /// For good. Refused when it is closed already.
    void close_round(int round);
    /// What the audience sees from now on, and what led there. Voting begins and ends with it: a
    /// state that votes starts the voting, one that is locked or `abort` closes the round. Refused
    /// for a round without a plan.
    void record_step(int round, const PresentationState& state, PresentationEvent event);

    std::vector<Round> rounds() const;
    Round round(int id) const;
    std::optional<Round> open_round() const;
    /// The newest round of a session.
    std::optional<Round> last_round(int session) const;
    std::optional<CastBallot> ballot_of(int round, int seat) const;
    /// The seat's own answers on scales, all open where it has none.
    ScaleAnswers ratings_of(int round, int seat) const;
    /// The seats that have voted, never for what.
    std::vector<int> voted(int round) const;
    /// In the order of seats. Refused while the round is open, or its series under way.
    std::vector<CastBallot> ballots(int round) const;
    VoteCounts tally(int round) const;
    /// Answers on scales by seat, of those that have any. Refused as ballots().
    std::map<int, ScaleAnswers> ratings(int round) const;

    /// Nothing for a round that was opened without one.
    std::optional<PresentationPlan> plan_of(int round) const;
    /// All steps of a round with their times: the order in which its looks were shown.
    std::vector<PresentationStep> steps_of(int round) const;
    Turn turn_of(int round, int seat) const;
    /// The newest round with a plan whose presentation has not ended, and where it stands.
    struct Presented {
        Round round;
        PresentationPlan plan;
        PresentationStep step;
    };
    std::optional<Presented> presented() const;

    /// Nothing for a round that is no repeat.
    std::optional<Series> series_of(int round) const;
    std::optional<Series> series_under_way() const;

    const std::filesystem::path& file() const { return database_.file(); }
    /// All that happened, in order.
    std::vector<LogEntry> log() const;
    /// Changes when another program or store has changed the file.
    std::int64_t others_changes() const;

  private:
    class Writing;
    CastBallot vote_within(Writing& writing, int round, int seat, const Ballot& ballot);
    void check_told(int round) const;
    /// With all that is in the log now.
    const BallotBooks& books() const;

    mutable Database database_;
    mutable BallotBooks books_;
};

}  // namespace livery
