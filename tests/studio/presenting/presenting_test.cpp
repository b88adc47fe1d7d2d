// A vote in a studio without a projector: what may be done when, by keys and by the panel.
#include "studio/presenting/presenting.h"

#include <cstdlib>

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "studio/actions.h"
#include "studio/studio.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Phase = PresentationPhase;
using Event = PresentationEvent;

Document two_looks() {
    Document document;
    document.library = read_paint_library();
    for (int id = 1; id <= 2; ++id) {
        SessionLook look;
        look.id = id;
        look.look.name = "look " + std::to_string(id);
        look.look.parts = {{"*", "solid red"}};
        document.looks.push_back(look);
    }
    document.next_look_id = 3;
    return document;
}

class PresentingStudio : public ::testing::Test {
  protected:
    PresentingStudio() {
        setenv("LIVERY_HOME", home_.path().c_str(), 1);
        studio.ballots = std::make_unique<BallotStore>(home_ / "ballots.sqlite");
        keep_shown_looks_valid(studio);
        studio.now_s = 100.0;
    }

    void present() {
        RoundSetup setup;
        setup.designs = {"look 1", "look 2"};
        setup.presenting = true;
        setup.plan = PresentationPlan{{{1, 0}}, {10.0, 2.0, 3.0}, "", "frames/x", {}};
        const int id = studio.ballots->open_round(setup);
        const auto state = after(*setup.plan, {}, Event::present, studio.now_s);
        studio.ballots->record_step(id, state, Event::present);
        take_round(studio, studio.ballots->open_round().value(), *setup.plan, state);
        // As when they were loaded.
        for (const std::string& name : frames_needed(setup.plan->sittings)) {
            presenting(studio).presented->frames[name] = std::make_shared<Image8>(8, 8, 3);
        }
    }
    PresentationState state() { return presenting(studio).presented->state; }
    bool key(int code) { return vote_mode_key(studio, {code, false, false}, false); }

    TemporaryFolder home_;
    Studio studio{Session::unsaved(two_looks(), "a test")};
};

TEST_F(PresentingStudio, KeysOfARemoteStepPauseAndBlank) {
    EXPECT_FALSE(key(GLFW_KEY_PAGE_DOWN)) << "nothing is presented";
    present();
    EXPECT_TRUE(key(GLFW_KEY_PAGE_DOWN));
    EXPECT_EQ(state().phase, Phase::presenting);
    EXPECT_EQ(code_on_show(studio), studio.ballots->open_round()->codes[1]);
    EXPECT_TRUE(key(GLFW_KEY_SPACE));
    EXPECT_TRUE(state().paused);
    EXPECT_TRUE(vote_mode_key(studio, {GLFW_KEY_SPACE, false, false}, true));
    EXPECT_TRUE(state().paused) << "a key that is held counts once";
    EXPECT_TRUE(key(GLFW_KEY_PERIOD));
    EXPECT_TRUE(state().blank);
    EXPECT_FALSE(code_on_show(studio));
    EXPECT_TRUE(key(GLFW_KEY_B));
    EXPECT_FALSE(state().blank);
    EXPECT_TRUE(key(GLFW_KEY_RIGHT));
    EXPECT_TRUE(state().grey);
    EXPECT_TRUE(key(GLFW_KEY_LEFT));
    EXPECT_FALSE(state().grey);
    EXPECT_FALSE(vote_mode_key(studio, {GLFW_KEY_B, true, false}, false)) << "Ctrl+B is black";
    for (int k = 0; k < 4; ++k) key(GLFW_KEY_DOWN);
    EXPECT_EQ(state().phase, Phase::voting);
    EXPECT_FALSE(key(GLFW_KEY_PAGE_DOWN)) << "a remote ends no vote";
    EXPECT_FALSE(key(GLFW_KEY_B)) << "that is design B's";
}

TEST_F(PresentingStudio, NothingIsEditedUntilItIsOver) {
    commit(studio, RenameLook{1, "before"});
    const std::uint64_t revision = studio.session.revision();
    present();
    for (const Event event : {Event::tick, Event::next, Event::next, Event::next, Event::next}) {
        send(studio, event);
        studio.notices.clear();
        commit(studio, RenameLook{1, "meanwhile"});
        ASSERT_EQ(studio.notices.size(), 1u);
        EXPECT_NE(studio.notices[0].cause.find("Round 1"), std::string::npos);
        show_look(studio, 2);
        EXPECT_EQ(studio.shown_look, 1);
    }
    std::string allowed;
    for (const Action& action : all_actions()) {
        if (is_enabled(action, studio) && action.menu != "View" && action.menu != "Help") {
            allowed += action.id + " ";
        }
    }
    EXPECT_EQ(allowed, "give-up black quit ");
    EXPECT_FALSE(run_action(action_named("undo"), studio));
    send(studio, Event::next);
    ASSERT_EQ(phase_of(studio), Phase::voting);
    send(studio, Event::lock);
    EXPECT_TRUE(is_presenting(studio)) << "the result is on show";
    EXPECT_EQ(studio.session.revision(), revision);
    send(studio, Event::done);
    EXPECT_FALSE(is_presenting(studio));
    commit(studio, RenameLook{1, "after"});
    EXPECT_EQ(studio.session.revision(), revision + 1);
    EXPECT_FALSE(studio.ballots->open_round());
}

TEST_F(PresentingStudio, ComesBackPausedAndOnlyToItsOwnSession) {
    present();
    send(studio, Event::next);
    send(studio, Event::next);
    presenting(studio) = PresentingState();
    find_presented_round(studio);
    ASSERT_TRUE(presenting(studio).presented);
    EXPECT_TRUE(state().paused);
    EXPECT_TRUE(state().grey);
    send(studio, Event::pause);
    EXPECT_TRUE(state().paused) << "its frames are not there, so it does not go on";
    send(studio, Event::abort);
    EXPECT_FALSE(studio.ballots->open_round());

    RoundSetup other;
    other.designs = {"a", "b"};
    other.presenting = true;
    other.plan = PresentationPlan{{{0, 1}}, {}, "/another.livery", "frames/y", {}};
    studio.ballots->open_round(other);
    find_presented_round(studio);
    EXPECT_FALSE(is_presenting(studio));
}

TEST_F(PresentingStudio, SeatsTellWhoHasVotedAndALockFromElsewhereIsSeen) {
    const int session = studio.ballots->open_session();
    const int seat = studio.ballots->join(session, "a phone's", 9);
    present();
    for (int k = 0; k < 5; ++k) send(studio, Event::next);
    ASSERT_EQ(phase_of(studio), Phase::voting);
    BallotStore phones(home_ / "ballots.sqlite");
    phones.vote(1, seat, {0, 1});
    read_seats(studio);
    EXPECT_TRUE(presenting(studio).voted.empty()) << "read at most twice a second";
    studio.now_s += 1.0;
    read_seats(studio);
    EXPECT_EQ(presenting(studio).voted, (std::vector<int>{seat}));
    phones.close_round(1);
    studio.now_s += 1.0;
    read_seats(studio);
    EXPECT_EQ(phase_of(studio), Phase::locked);
    send(studio, Event::done);
    EXPECT_FALSE(is_presenting(studio));
}

TEST_F(PresentingStudio, WavesFollowFromWhoHasJoined) {
    PresentingSettings settings;
    settings.waves = true;
    settings.evaluators = 10;
    settings.wave_size = 3;
    EXPECT_EQ(sittings_of(settings, 4, 3, 0).size(), 4u)
        << "nobody joined: as many as are expected";
    EXPECT_EQ(sittings_of(settings, 4, 3, 7).size(), 3u);
    const std::vector<Seat> seats = {{1, ""}, {2, "Bo"}, {3, ""}};
    EXPECT_EQ(phones_in(seats), (std::vector<int>{1, 3}));
    EXPECT_EQ(
        waves_in_words({{1, 2, 3}, {4}, {}}),
        (std::vector<std::string>{"Wave 1: seats 1, 2, 3", "Wave 2: seat 4", "Wave 3: no phones"}));
    EXPECT_TRUE(waves_in_words({{1, 2}}).empty()) << "all at once";
    EXPECT_TRUE(waves_in_words({}).empty());
}

TEST_F(PresentingStudio, WhoSitsLaterIsNotWaitedFor) {
    present();
    PresentingState& now = presenting(studio);
    now.seats = {{1, ""}, {2, ""}, {3, ""}, {4, "Bo"}};
    now.voted = {1, 4};
    EXPECT_EQ(votes_so_far(now), (VotesSoFar{2, 4, 0})) << "all look at once";
    now.presented->plan.sittings = {{0, 1}, {1, 0}};
    now.presented->plan.seats = {{1, 2}, {3}};
    EXPECT_EQ(votes_so_far(now), (VotesSoFar{2, 3, 1}));
    EXPECT_TRUE(sits_later(now, 3));
    EXPECT_EQ(question_in_words(now), "") << "nothing is asked";
    now.asking_to_lock = true;
    EXPECT_EQ(question_in_words(now),
              "Lock it for good? 1 seat has not voted yet. 1 wave has not seen the looks.");
    now.voted = {1, 2, 4};
    EXPECT_EQ(question_in_words(now), "Lock it for good? 1 wave has not seen the looks.");
    now.presented->state.sitting = 1;
    now.voted = {1, 2, 3, 4};
    EXPECT_EQ(votes_so_far(now), (VotesSoFar{4, 4, 0}));
    EXPECT_FALSE(sits_later(now, 3));
    EXPECT_EQ(question_in_words(now), "Lock it for good?");
    now.asking_to_lock = false;
    now.asking_to_abort = true;
    EXPECT_EQ(question_in_words(now), "Abort it? Nobody votes on this round.");
}

TEST_F(PresentingStudio, ItsSettingsAreKept) {
    studio.settings = read_user_settings();
    PresentingSettings& settings = presenting_settings(studio);
    EXPECT_EQ(settings.times, (PresentationTimes{120.0, 9.0, 4.5}));
    EXPECT_EQ(settings.network, "lo") << "nobody else reaches the ballots unless it is asked for";
    settings.times = {30.0, 8.5, 4.0};
    settings.waves = true;
    settings.wave_size = 2;
    EXPECT_FALSE(settings.asks_least) << "unless it is ticked";
    settings.asks_least = true;
    EXPECT_FALSE(settings.asks_scales) << "unless it is ticked";
    EXPECT_EQ(settings.scales.size(), 3u) << "some are offered";
    EXPECT_TRUE(scales_asked(settings).empty());
    settings.asks_scales = true;
    settings.scales = {{"schlicht", "auffällig"}, {"a b", "<i>"}};
    keep_presenting_settings(studio);
    PresentingState fresh;
    presenting(studio) = std::move(fresh);
    studio.settings = read_user_settings();
    EXPECT_EQ(presenting_settings(studio).times, (PresentationTimes{30.0, 8.5, 4.0}));
    EXPECT_TRUE(presenting_settings(studio).waves);
    EXPECT_TRUE(presenting_settings(studio).asks_least);
    EXPECT_EQ(scales_asked(presenting_settings(studio)),
              (std::vector<SemanticScale>{{"schlicht", "auffällig"}, {"a b", "<i>"}}));
    EXPECT_EQ(presenting_settings(studio).wave_size, 2);
    EXPECT_EQ(sittings_of(presenting_settings(studio), 4, 3).size(), 5u);
}

TEST_F(PresentingStudio, AListOfWordsThatAHandHasBrokenIsTakenAsFarAsItGoes) {
    for (const auto& [kept, count] : std::vector<std::pair<std::string, std::size_t>>{
             {";", 0}, {"a,b;c;d,e", 2}, {"a,b;a,b", 1}, {"a,b;c,d;e,f;g,h;i,j;k,l", 5}}) {
        presenting(studio) = PresentingState();
        studio.settings.values["presenting-scales"] = kept;
        EXPECT_EQ(presenting_settings(studio).scales.size(), count) << kept;
    }
}

TEST(PresentingTimes, ReadAsPeopleSayThem) {
    EXPECT_EQ(time_in_words(8.2), "9 s");
    EXPECT_EQ(time_in_words(60.0), "1:00");
    EXPECT_EQ(time_in_words(331.5), "5:32");
}

}  // namespace
}  // namespace livery
