// What the ballots keep of audiences: sessions, invitations, seats.
#include "core/error.h"
#include "evaluation/ballot_log.h"
#include "evaluation/ballot_rows.h"
#include "evaluation/ballot_tables.h"
#include "evaluation/ballots.h"

namespace livery {

int BallotStore::open_session() {
    Transaction transaction(database_);
    if (const auto other = open_round()) {
        throw Refused(round_name(other->id) + " is still open",
                      "close it before the next audience comes in");
    }
    const int session = make_session(database_);
    transaction.commit();
    return session;
}

std::optional<int> BallotStore::session() const { return newest_session(database_); }

std::optional<Invitation> BallotStore::invitation(int session) const {
    const auto rows =
        database_.run("SELECT token, code, code_until FROM invitations WHERE session = ?1",
                      {std::int64_t{session}});
    if (rows.empty()) return std::nullopt;
    const auto* until = std::get_if<std::int64_t>(&rows[0][2]);
    return Invitation{
        as_text(database_, rows[0][0]), as_text(database_, rows[0][1]), until ? *until : 0};
}

void BallotStore::invite(int session, const Invitation& invitation) {
    database_.run(
        "INSERT INTO invitations VALUES (?1, ?2, ?3, ?4) ON CONFLICT (session) DO "
        "UPDATE SET token = excluded.token, code = excluded.code, "
        "code_until = excluded.code_until",
        {std::int64_t{session}, invitation.token, invitation.code, invitation.code_until_s});
}

int BallotStore::join(int session, const std::string& secret_hash, int most_seats) {
    Transaction transaction(database_);
    if (const auto seat = seat_with_key(database_, session, phone_seat_key(secret_hash))) {
        return *seat;
    }
    if (session != newest_session(database_)) {
        throw Refused("this session is over", "join the one that is shown now");
    }
    if (const auto round = open_round()) {
        throw Refused(round_name(round->id) + " has begun", "join before the next round");
    }
    const auto phones = static_cast<int>(phone_seats(database_, session).size());
    if (phones >= most_seats) {
        throw Refused("all " + std::to_string(most_seats) + " seats are taken",
                      "ask the operator for more, or for a ballot on paper");
    }
    const int seat = make_seat(database_, session, secret_hash, true);
    transaction.commit();
    return seat;
}

std::optional<int> BallotStore::seat_of_phone(int session, const std::string& secret_hash) const {
    return seat_with_key(database_, session, phone_seat_key(secret_hash));
}

std::vector<Seat> BallotStore::seats(int session) const {
    std::vector<Seat> seats;
    for (const auto& row :
         database_.run("SELECT seat, name FROM seats WHERE session = ?1 ORDER BY seat",
                       {std::int64_t{session}})) {
        seats.push_back({as_int(database_, row[0]), as_text(database_, row[1])});
    }
    return seats;
}

}  // namespace livery
