// Phones: sessions, seats, rounds that are presented first, and ballots that change.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evaluation/ballot_file.h"
#include "evaluation/ballots.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

RoundSetup four(bool presenting = false, bool asks_least = false) {
    RoundSetup setup;
    setup.designs = {"a", "b", "c", "d"};
    setup.codes = {412, 907, 133, 560};
    setup.presenting = presenting;
    setup.asks_least = asks_least;
    return setup;
}

/// What a store refuses, or nothing.
template <typename Work>
std::string refusal(Work&& work) {
    try {
        work();
    } catch (const Refused& refused) {
        return refused.why();
    }
    return "";
}

TEST(Seats, APhoneHasOneAndKeepsIt) {
    const TemporaryFolder folder;
    const auto file = folder / "votes";
    {
        BallotStore store(file);
        EXPECT_FALSE(store.session());
        const int session = store.open_session();
        EXPECT_EQ(store.session(), session);
        EXPECT_EQ(store.join(session, "aa", 3), 1);
        EXPECT_EQ(store.join(session, "bb", 3), 2);
        EXPECT_EQ(store.join(session, "aa", 3), 1) << "the same phone";
        EXPECT_EQ(store.join(session, "cc", 3), 3);
        EXPECT_EQ(refusal([&] { store.join(session, "dd", 3); }), "all 3 seats are taken");
        store.invite(session, {"token", "K7M2PQ", 1700000000});
    }
    BallotStore store(file);
    EXPECT_EQ(store.seat_of_phone(1, "bb"), 2);
    EXPECT_FALSE(store.seat_of_phone(1, "dd"));
    EXPECT_FALSE(store.seat_of_phone(1, "' OR 1=1 --"));
    EXPECT_EQ(store.seats(1).size(), 3u);
    const auto invitation = store.invitation(1);
    ASSERT_TRUE(invitation);
    EXPECT_EQ(invitation->token, "token");
    EXPECT_EQ(invitation->code, "K7M2PQ");
    EXPECT_EQ(invitation->code_until_s, 1700000000);
    // The next audience starts with nobody.
    const int next = store.open_session();
    EXPECT_FALSE(store.seat_of_phone(next, "aa"));
    EXPECT_EQ(refusal([&] { store.join(1, "ee", 9); }), "this session is over");
    EXPECT_EQ(store.join(next, "aa", 3), 1);
}

TEST(Seats, JoiningClosesWhenTheRoundBegins) {
    const TemporaryFolder folder;
    BallotStore store(folder / "votes");
    const int session = store.open_session();
    store.join(session, "aa", 9);
    const int round = store.open_round(four(true));
    EXPECT_EQ(refusal([&] { store.join(session, "bb", 9); }), "round 1 has begun");
    EXPECT_EQ(store.join(session, "aa", 9), 1) << "who is in stays in";
    EXPECT_EQ(refusal([&] { store.open_session(); }), "round 1 is still open");
    store.close_round(round);
    EXPECT_EQ(store.join(session, "bb", 9), 2);
}

TEST(Seats, VoteWhenTheLooksHaveBeenShownAndUntilTheRoundIsLocked) {
    const TemporaryFolder folder;
    const auto file = folder / "votes";
    BallotStore store(file);
    const int session = store.open_session(), seat = store.join(session, "aa", 9);
    const int round = store.open_round(four(true, true));
    EXPECT_FALSE(store.last_round(session).value().voting());
    EXPECT_EQ(refusal([&] {
                  store.vote(round, seat, {0, 1});
              }),
              "round 1 is still presented, so the ballot of seat 1 is too early");
    store.start_voting(round);
    EXPECT_EQ(refusal([&] { store.start_voting(round); }), "round 1 takes votes already");

    const CastBallot first = store.vote(round, seat, {0, 1, 3});
    EXPECT_EQ(first.receipt.size(), 8u);
    EXPECT_EQ(store.ballot_of(round, seat).value().receipt, first.receipt);
    // Sent twice: one ballot, one entry, one receipt.
    EXPECT_EQ(store.vote(round, seat, {0, 1, 3}).receipt, first.receipt);
    const CastBallot second = store.vote(round, seat, {2, 1});
    EXPECT_NE(second.receipt, first.receipt);
    EXPECT_EQ(store.ballot_of(round, seat).value().ballot, (Ballot{2, 1}));
    EXPECT_EQ(store.voted(round), std::vector<int>{seat});
    EXPECT_NE(refusal([&] { store.ballots(round); }), "");
    {
        auto raw = raw_ballots(file);
        EXPECT_EQ(raw.run("SELECT count(*) FROM log WHERE what = 'vote'"),
                  (std::vector<std::vector<DatabaseValue>>{{std::int64_t{2}}}));
        EXPECT_EQ(
            raw.run("SELECT count(*) FROM log WHERE substr(hash, 1, 8) = ?1", {second.receipt}),
            (std::vector<std::vector<DatabaseValue>>{{std::int64_t{1}}}));
    }
    // A ballot on paper, typed in beside.
    store.vote(round, "paper 7", {2, 0, 1});
    store.close_round(round);
    EXPECT_EQ(refusal([&] {
                  store.vote(round, seat, {0, 1});
              }),
              "round 1 is closed, so the ballot of seat 1 is too late");
    const auto ballots = store.ballots(round);
    ASSERT_EQ(ballots.size(), 2u);
    EXPECT_EQ(ballots[1].ballot, (Ballot{2, 0, 1}));
    const VoteCounts tally = store.tally(round);
    EXPECT_EQ(tally.best, (std::vector<int>{0, 0, 2, 0}));
    EXPECT_EQ(tally.second, (std::vector<int>{1, 1, 0, 0}));
    EXPECT_EQ(tally.least, (std::vector<int>{0, 1, 0, 0}));
    EXPECT_NO_THROW(BallotStore{file});
}

TEST(Seats, RefuseWhatMakesNoSense) {
    const TemporaryFolder folder;
    BallotStore store(folder / "votes");
    const int session = store.open_session(), seat = store.join(session, "aa", 9);
    const int round = store.open_round(four());
    for (const auto& [choices, part] :
         std::vector<std::pair<Ballot, std::string>>{{{1, 1}, "as best and as second best"},
                                                     {{0, 4}, "found design 4, expected 0 to 3"},
                                                     {{-1, 0}, "found design -1"},
                                                     {{0, 1, 2}, "round 1 does not ask for it"}}) {
        try {
            store.vote(round, seat, choices);
            ADD_FAILURE() << part;
        } catch (const std::invalid_argument& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(store.vote(round, 2, {0, 1}), std::invalid_argument);
    EXPECT_THROW(store.vote(9, seat, {0, 1}), std::invalid_argument);
    store.close_round(round);
    for (const std::vector<int>& codes :
         std::vector<std::vector<int>>{{412}, {412, 412, 133, 560}, {99, 1, 2, 3}}) {
        RoundSetup setup = four();
        setup.codes = codes;
        EXPECT_THROW(store.open_round(setup), std::invalid_argument);
    }
    const int asks = store.open_round(four(false, true));
    EXPECT_THROW(store.vote(asks, seat, {0, 1, 1}), std::invalid_argument);
    EXPECT_TRUE(store.voted(asks).empty());
}

TEST(Seats, SayWhenAnotherProgramHasChangedTheFile) {
    const TemporaryFolder folder;
    BallotStore one(folder / "votes"), other(folder / "votes");
    const auto before = one.others_changes();
    one.open_session();
    EXPECT_EQ(one.others_changes(), before) << "its own changes are no other's";
    other.open_round(four());
    EXPECT_NE(one.others_changes(), before);
}

}  // namespace
}  // namespace livery
