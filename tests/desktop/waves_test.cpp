// People who look in groups: each sees its own order and votes after it, also after a kill.
#include <csignal>

#include <gtest/gtest.h>

#include "desktop/presented_vote.h"
#include "support/ballot_phone.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

constexpr const char* kWavesOfNine = R"({"format_version": 1, "settings": {
  "presenting-adapt-s": "600", "presenting-look-s": "600", "presenting-grey-s": "600",
  "presenting-seed": "7", "presenting-wave-size": "9", "phones-port": "0"
}})";

constexpr int kKept = 200, kNotNow = 409;

class Waves : public PresentedVote {
  protected:
    std::string state_of(int seat) {
        return phones.at(static_cast<std::size_t>(seat) - 1).state()["state"];
    }
    int vote(int seat, int best, int second) {
        return phones.at(static_cast<std::size_t>(seat) - 1)
            .vote(presented.round.id, code_of(best), code_of(second));
    }
    /// Each look of the wave that sits now, by the operator's mouse, until people vote.
    void show_all(std::size_t wave) {
        const auto& order = presented.plan.sittings.at(wave);
        for (const int design : order) {
            program->click("vote:next");
            EXPECT_EQ(program->state("vote_code"), code_of(design));
            EXPECT_TRUE(projector_shows_frame(frame_of_look(design)));
            EXPECT_EQ(filled_segment().number, 1);
            program->click("vote:next");
        }
        EXPECT_TRUE(projector_shows_frame(kRestFrame));
    }

    std::vector<testing::BallotPhone> phones;
};

TEST_F(Waves, NightlySeeTheirOwnOrderAndVoteInTheirTurn) {
    start_vote(kWavesOfNine, 3);
    const Segment edit = filled_segment();
    EXPECT_EQ(edit.number, 0);
    program->click("present:order");
    program->click("present:order:waves");
    program->click("present:wave");
    program->press_key("ctrl+a");
    desktop->type("3");
    program->press_key("Return");
    const std::string address = let_phones_vote();
    for (int seat = 1; seat <= 5; ++seat) {
        phones.emplace_back(address);
        ASSERT_EQ(phones.back().seat(), seat);
    }
    program->item("vote:waves");

    // --- the first wave sits down ---
    present_paused();
    EXPECT_EQ(presented.plan.seats, (std::vector<std::vector<int>>{{1, 2, 3}, {4, 5}}));
    ASSERT_EQ(presented.plan.sittings.size(), 2u);
    EXPECT_NE(presented.plan.sittings[0], presented.plan.sittings[1]);
    EXPECT_FALSE(testing::BallotPhone(address).has_seat()) << "joining is closed";
    EXPECT_TRUE(projector_shows_frame(kWhiteFrame));
    const Segment shows = filled_segment();
    EXPECT_EQ(shows.number, 1);
    EXPECT_GT(distance(shows.colour, edit.colour), 20);
    EXPECT_EQ(state_of(3), "presenting");
    EXPECT_EQ(state_of(4), "waiting");
    for (int seat = 1; seat <= 5; ++seat) EXPECT_EQ(vote(seat, 0, 1), kNotNow) << seat;
    show_all(0);
    EXPECT_EQ(vote(1, 0, 1), kNotNow) << "people remember first";

    // --- it votes, and nobody else ---
    program->click("vote:next");
    program->wait_for_state("vote", "voting");
    EXPECT_TRUE(projector_shows_frame(kRestFrame));
    const Segment votes = filled_segment();
    EXPECT_EQ(votes.number, 2);
    EXPECT_GT(distance(votes.colour, shows.colour), 20);
    EXPECT_EQ(state_of(1), "voting");
    EXPECT_EQ(state_of(5), "waiting");
    for (int seat = 1; seat <= 3; ++seat) EXPECT_EQ(vote(seat, 0, 1), kKept) << seat;
    for (int seat = 4; seat <= 5; ++seat) EXPECT_EQ(vote(seat, 0, 1), kNotNow) << seat;

    // --- the second wave, white for its eyes first ---
    program->click("vote:next-wave");
    program->wait_for_state("vote", "adapting");
    EXPECT_TRUE(projector_shows_frame(kWhiteFrame));
    EXPECT_EQ(filled_segment().number, 1);
    EXPECT_EQ(state_of(5), "presenting");
    EXPECT_EQ(vote(5, 0, 1), kNotNow);
    EXPECT_EQ(vote(2, 1, 0), kKept) << "who has seen everything may think again";
    program->click("vote:next");
    const int first = presented.plan.sittings[1][0];
    EXPECT_TRUE(projector_shows_frame(frame_of_look(first)));

    // --- killed, the second wave goes on where it was ---
    program->process().send(SIGKILL);
    ASSERT_EQ(program->process().wait(60s), 128 + SIGKILL);
    const BallotStore::Presented before = presented;
    start_program_at_home();
    program->wait_for_state("vote_loaded", true);
    load_frames();
    EXPECT_EQ(presented.plan, before.plan);
    EXPECT_EQ(presented.step.state.sitting, 1);
    EXPECT_EQ(program->state("vote_paused"), true);
    EXPECT_EQ(program->state("vote_code"), code_of(first));
    EXPECT_TRUE(projector_shows_frame(frame_of_look(first)));
    const std::string again = let_phones_vote();
    for (auto& phone : phones) phone.move_to(again);
    EXPECT_EQ(state_of(4), "presenting") << "a seat is kept";
    EXPECT_EQ(vote(4, 0, 1), kNotNow);
    program->click("vote:back");
    EXPECT_TRUE(projector_shows_frame(kWhiteFrame));
    show_all(1);
    program->click("vote:next");
    program->wait_for_state("vote", "voting");
    EXPECT_FALSE(program->has_item("vote:next-wave")) << "there is no third";
    EXPECT_EQ(vote(4, 2, 1), kKept);
    EXPECT_EQ(vote(5, 2, 1), kKept);
    EXPECT_EQ(vote(1, 0, 2), kKept);

    // --- one result for both ---
    program->click("vote:lock");
    program->click("vote:confirm");
    program->wait_for_state("vote", "locked");
    const Segment locked = filled_segment();
    EXPECT_EQ(locked.number, 3);
    EXPECT_GT(distance(locked.colour, votes.colour), 20);
    EXPECT_TRUE(projector_shows_frame(kRestFrame));
    EXPECT_EQ(vote(4, 0, 1), kNotNow);
    const BallotStore store(home / "ballots.sqlite");
    EXPECT_EQ(store.tally(presented.round.id).best, (std::vector<int>{2, 1, 2}));
    EXPECT_EQ(store.tally(presented.round.id).second, (std::vector<int>{1, 3, 1}));
}

}  // namespace
}  // namespace livery
