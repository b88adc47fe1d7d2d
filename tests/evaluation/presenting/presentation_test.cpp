#include "evaluation/presenting/presentation.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "evaluation/presentation_order.h"

namespace livery {
namespace {

using Phase = PresentationPhase;
using Event = PresentationEvent;

PresentationPlan plan_of(int designs, bool waves, std::uint64_t seed = 7) {
    PresentationPlan plan;
    const int rows = static_cast<int>(williams_rows(designs).size());
    plan.sittings =
        waves ? wave_sittings(designs, 2 * rows, 2, seed) : pass_sitting(designs, 0, seed);
    return plan;
}

std::vector<Event> all_events() {
    std::vector<Event> events;
    for (int k = 0; k < kPresentationEvents; ++k) events.push_back(static_cast<Event>(k));
    return events;
}

/// Every state that a plan can be in, without what its clock says.
std::vector<PresentationState> all_states(const PresentationPlan& plan) {
    std::vector<PresentationState> states;
    for (int sitting = 0; sitting < static_cast<int>(plan.sittings.size()); ++sitting) {
        const int looks = static_cast<int>(plan.sittings[static_cast<std::size_t>(sitting)].size());
        for (int place = 0; place < looks; ++place) {
            for (int bits = 0; bits < 8; ++bits) {
                PresentationState state{Phase::presenting, sitting, place};
                state.grey = (bits & 1) != 0;
                state.paused = (bits & 2) != 0;
                state.blank = (bits & 4) != 0;
                states.push_back(state);
            }
        }
        for (const Phase phase : {Phase::adapting, Phase::voting, Phase::locked}) {
            for (int bits = 0; bits < (phase == Phase::adapting ? 4 : 1); ++bits) {
                PresentationState state{phase, sitting};
                state.paused = (bits & 1) != 0;
                state.blank = (bits & 2) != 0;
                states.push_back(state);
            }
        }
    }
    states.emplace_back();
    for (PresentationState& state : states) {
        state.left_s = step_s(plan, state);
        state.at_s = 10.0;
    }
    return states;
}

/// What must hold whatever has happened.
void expect_sound(const PresentationPlan& plan, const PresentationState& state) {
    ASSERT_GE(state.sitting, 0);
    ASSERT_LT(state.sitting, static_cast<int>(plan.sittings.size()));
    const auto& sitting = plan.sittings[static_cast<std::size_t>(state.sitting)];
    ASSERT_GE(state.place, 0);
    ASSERT_LT(state.place, static_cast<int>(sitting.size()));
    ASSERT_FALSE(std::isnan(state.left_s));
    ASSERT_LE(state.left_s, step_s(plan, state));
    const auto needed = frames_needed(plan.sittings);
    const std::string frame = frame_of(plan, state);
    const bool nothing = state.phase == Phase::edit;
    ASSERT_EQ(frame.empty(), nothing);
    if (!nothing) {
        ASSERT_NE(std::find(needed.begin(), needed.end(), frame), needed.end()) << frame;
    }
    const int design = design_of(plan, state);
    if (design >= 0) {
        ASSERT_EQ(design, sitting[static_cast<std::size_t>(state.place)]) << "the stored order";
        ASSERT_EQ(frame, frame_of_look(design));
    }
    ASSERT_FALSE(state.phase == Phase::edit && is_running(state));
}

TEST(Presentation, EveryEventInEveryStateIsSoundAndDoesNothingWhereItIsNotAllowed) {
    for (const bool waves : {false, true}) {
        const PresentationPlan plan = plan_of(3, waves);
        for (const PresentationState& state : all_states(plan)) {
            for (const Event event : all_events()) {
                const std::string what =
                    std::string(to_string(event)) + " in " + text_of(state, Event::tick);
                for (const double now_s : {9.0, 10.0, 12.5, 1e6}) {
                    const PresentationState next = after(plan, state, event, now_s);
                    expect_sound(plan, next);
                    if (::testing::Test::HasFatalFailure()) FAIL() << what;
                    const bool nothing = !is_allowed(plan, state, event) ||
                                         (event == Event::tick && !is_running(state));
                    EXPECT_TRUE(!nothing || next == state) << what;
                }
            }
        }
    }
}

TEST(Presentation, AllowsWhatThePhaseAllows) {
    const PresentationPlan plan = plan_of(4, true);
    const auto allowed = [&](const PresentationState& state) {
        std::set<std::string> names;
        for (const Event event : all_events()) {
            if (is_allowed(plan, state, event)) names.insert(to_string(event));
        }
        return names;
    };
    const std::set<std::string> while_shown = {
        "tick", "pause", "blank", "repeat", "next", "back", "abort", "resume"};
    EXPECT_EQ(allowed({}), (std::set<std::string>{"tick", "present", "resume"}));
    EXPECT_EQ(allowed({Phase::adapting}), while_shown);
    EXPECT_EQ(allowed({Phase::presenting, 1, 2}), while_shown);
    EXPECT_EQ(allowed({Phase::voting, 0}),
              (std::set<std::string>{"tick", "next", "back", "lock", "resume"}));
    const int last = static_cast<int>(plan.sittings.size()) - 1;
    EXPECT_EQ(allowed({Phase::voting, last}),
              (std::set<std::string>{"tick", "back", "lock", "resume"}));
    EXPECT_EQ(allowed({Phase::locked}), (std::set<std::string>{"tick", "done", "resume"}));
}

/// What is seen from `present` on, and for how long, when ticks come every `step_s`.
std::vector<std::pair<std::string, double>> seen(const PresentationPlan& plan, double step_s) {
    std::vector<std::pair<std::string, double>> frames;
    PresentationState state = after(plan, {}, Event::present, 0.0);
    for (int k = 1; state.left_s < kWaits && k < 1000000; ++k) {
        const std::string frame = frame_of(plan, state);
        if (frames.empty() || frames.back().first != frame) frames.emplace_back(frame, 0.0);
        frames.back().second += step_s;
        state = after(plan, state, Event::tick, k * step_s);
    }
    return frames;
}

TEST(Presentation, ShowsEachLookOfTheOrderForItsTimeWithTheirOwnGreyBetween) {
    for (int designs = 2; designs <= 7; ++designs) {
        PresentationPlan plan = plan_of(designs, false);
        const auto& order = plan.sittings.at(0);
        const double step = 0.0625;  // binary: no rounding
        plan.times = {12.0, 9.0, 4.5};
        const auto frames = seen(plan, step);
        ASSERT_EQ(frames.size(), 2 * order.size());
        EXPECT_EQ(frames[0], (std::pair<std::string, double>{kWhiteFrame, 12.0}));
        double total = 0.0;
        for (std::size_t k = 0; k < order.size(); ++k) {
            EXPECT_EQ(frames[2 * k + 1].first, frame_of_look(order[k]));
            EXPECT_EQ(frames[2 * k + 1].second, 9.0);
            if (k + 1 == order.size()) continue;
            EXPECT_EQ(frames[2 * k + 2].first, frame_of_grey(order[k], order[k + 1]));
            EXPECT_EQ(frames[2 * k + 2].second, 4.5);
        }
        for (const auto& [frame, time_s] : frames) total += time_s;
        EXPECT_EQ(total, duration_s(plan));
    }
    EXPECT_EQ(duration_s(plan_of(4, false)), 120.0 + 16 * 9.0 + 15 * 4.5);
    EXPECT_EQ(duration_s(plan_of(4, true)), 4 * (120.0 + 4 * 9.0 + 3 * 4.5));
}

TEST(Presentation, NoLookIsCutShortByTicksThatComeLate) {
    PresentationPlan plan = plan_of(3, false);
    PresentationState state = after(plan, {}, Event::present, 0.0);
    // A machine that slept for ten minutes shows the next look for all of its time.
    state = after(plan, state, Event::tick, 720.0);
    EXPECT_EQ(state.phase, Phase::presenting);
    EXPECT_EQ(state.place, 0);
    EXPECT_EQ(left_s(state, 720.0), 9.0);
    EXPECT_EQ(left_s(state, 722.5), 6.5);
    EXPECT_EQ(left_s(state, 700.0), 9.0) << "a clock that went back";
}

TEST(Presentation, PausesRepeatsStepsAndBlanks) {
    const PresentationPlan plan = plan_of(3, false);
    const auto& order = plan.sittings.at(0);
    PresentationState state = after(plan, {}, Event::present, 0.0);
    state = after(plan, state, Event::next, 5.0);
    EXPECT_EQ(design_of(plan, state), order[0]);
    state = after(plan, state, Event::pause, 8.0);
    EXPECT_EQ(left_s(state, 500.0), 6.0);
    EXPECT_EQ(after(plan, state, Event::tick, 500.0), state);
    state = after(plan, state, Event::pause, 500.0);
    EXPECT_EQ(left_s(state, 502.0), 4.0);
    state = after(plan, state, Event::blank, 502.0);
    EXPECT_EQ(frame_of(plan, state), kRestFrame);
    EXPECT_EQ(after(plan, state, Event::tick, 900.0), state);
    state = after(plan, state, Event::blank, 900.0);
    EXPECT_EQ(design_of(plan, state), order[0]);
    EXPECT_EQ(left_s(state, 900.0), 4.0);
    state = after(plan, state, Event::repeat, 901.0);
    EXPECT_EQ(left_s(state, 901.0), 9.0);
    state = after(plan, state, Event::next, 902.0);
    EXPECT_TRUE(state.grey) << "no look follows another one without grey";
    state = after(plan, state, Event::next, 902.0);
    EXPECT_EQ(design_of(plan, state), order[1]);
    state = after(plan, state, Event::next, 902.0);
    state = after(plan, state, Event::repeat, 903.0);
    EXPECT_EQ(design_of(plan, state), order[1]) << "in a grey, the look before it";
    state = after(plan, state, Event::back, 903.0);
    EXPECT_EQ(design_of(plan, state), order[0]);
    state = after(plan, state, Event::back, 903.0);
    EXPECT_EQ(state.phase, Phase::adapting);
    // Steps while it is paused stay paused.
    state = after(plan, after(plan, state, Event::pause, 903.0), Event::next, 903.0);
    EXPECT_EQ(design_of(plan, state), order[0]);
    EXPECT_TRUE(state.paused);
    EXPECT_EQ(after(plan, state, Event::abort, 904.0).phase, Phase::edit);
}

TEST(Presentation, WavesVoteOneAfterTheOther) {
    const PresentationPlan plan = plan_of(2, true);
    ASSERT_EQ(plan.sittings.size(), 2u);
    PresentationState state = after(plan, {}, Event::present, 0.0);
    for (int k = 0; k < 4; ++k) state = after(plan, state, Event::next, 1.0);
    EXPECT_EQ(frame_of(plan, state), kRestFrame) << "people remember before they vote";
    EXPECT_EQ(left_s(state, 1e9), kWaits);
    const PresentationState seen = state;
    state = after(plan, state, Event::next, 2.0);
    EXPECT_EQ(state.phase, Phase::voting);
    state = after(plan, state, Event::back, 2.0);
    EXPECT_EQ(std::tie(state.phase, state.place, state.grey, state.sitting),
              std::tie(seen.phase, seen.place, seen.grey, seen.sitting))
        << "Next pressed twice is taken back";
    EXPECT_EQ(frame_of(plan, state), kRestFrame) << "which nobody sees";
    state = after(plan, state, Event::next, 2.0);
    EXPECT_EQ(state.phase, Phase::voting);
    state = after(plan, state, Event::next, 3.0);
    EXPECT_EQ(state.phase, Phase::adapting);
    EXPECT_EQ(state.sitting, 1);
    for (int k = 0; k < 5; ++k) state = after(plan, state, Event::next, 4.0);
    EXPECT_EQ(state.phase, Phase::voting);
    state = after(plan, state, Event::lock, 5.0);
    EXPECT_EQ(state.phase, Phase::locked);
    EXPECT_EQ(after(plan, state, Event::done, 6.0).phase, Phase::edit);
}

TEST(Presentation, WhateverHappensItIsSoundAndComesBackFromItsText) {
    constexpr std::uint64_t seed = 23;
    std::cout << "seed " << seed << std::endl;
    Random random(seed);
    for (int run = 0; run < 300; ++run) {
        const PresentationPlan plan =
            plan_of(2 + static_cast<int>(random.below(5)), random.below(2) == 1, random.next());
        PresentationState state;
        double now_s = 100.0;
        std::set<std::string> phases;
        for (int k = 0; k < 200; ++k) {
            now_s += 6.0 * random.uniform();
            const auto event = static_cast<Event>(random.below(kPresentationEvents));
            state = after(plan, state, event, now_s);
            expect_sound(plan, state);
            ASSERT_FALSE(::testing::Test::HasFatalFailure()) << to_string(event);
            // Killed now, it is back where it was, and waits.
            const auto step = parse_step(text_of(state, event), "log");
            EXPECT_EQ(step.event, event);
            const PresentationState back = after(plan, step.state, Event::resume, 3.0);
            EXPECT_EQ(std::tie(back.phase, back.sitting, back.place, back.grey),
                      std::tie(state.phase, state.sitting, state.place, state.grey));
            EXPECT_FALSE(is_running(back));
            EXPECT_EQ(back.left_s, step_s(plan, back));
        }
    }
}

TEST(Presentation, PassesAndWavesAreRowsOfTheWilliamsSquare) {
    for (int designs = 2; designs <= 9; ++designs) {
        const auto order = presentation_order(designs, 0, 1, 5);
        const auto all = pass_sitting(designs, 0, 5), two = pass_sitting(designs, 2, 5);
        ASSERT_EQ(all.size(), 1u);
        ASSERT_EQ(all[0].size(), order.rows.size() * static_cast<std::size_t>(designs));
        std::vector<int> joined;
        for (const Wave& wave : order.waves) {
            joined.insert(joined.end(), wave.designs.begin(), wave.designs.end());
        }
        EXPECT_EQ(all[0], joined);
        EXPECT_EQ(two[0], std::vector<int>(joined.begin(), joined.begin() + 2 * designs));
        const auto waves = wave_sittings(designs, 10, 3, 5);
        EXPECT_EQ(waves.size(), 4u);
        for (const auto& sitting : waves) {
            EXPECT_EQ(std::count(order.rows.begin(), order.rows.end(), sitting), 1);
        }
        EXPECT_EQ(waves, wave_sittings(designs, 10, 3, 5));
    }
    EXPECT_EQ(pass_sitting(3, 9, 5)[0].size(), 18u) << "six rows, and no more";
    EXPECT_THROW(pass_sitting(3, -1, 5), std::invalid_argument);
}

TEST(Presentation, PlansAreCheckedAndComeBackFromTheirText) {
    PresentationPlan plan = plan_of(5, true);
    plan.session = "/home/a b/ü.livery";
    plan.folder = "frames/1";
    plan.frames = {{"white", "ab"}, {"look-0", "cd"}};
    EXPECT_EQ(parse_plan(text_of(plan), "log"), plan);
    EXPECT_NO_THROW(check_plan(plan, 5));
    EXPECT_THROW(check_plan(plan, 4), std::invalid_argument);
    EXPECT_THROW(check_plan(plan, 6), std::invalid_argument);
    EXPECT_THROW(check_plan({}, 2), std::invalid_argument);
    for (const double bad : {0.0, -1.0, 3601.0, std::nan("")}) {
        PresentationPlan wrong = plan;
        wrong.times.look_s = bad;
        EXPECT_THROW(check_plan(wrong, 5), std::invalid_argument) << bad;
    }
    for (const char* text : {"",
                             "{",
                             "[]",
                             "{}",
                             R"({"event": "jump"})",
                             R"({"event": "next", "phase": "presenting", "sitting": -1})"}) {
        EXPECT_THROW(parse_step(text, "log"), FileError) << text;
        EXPECT_THROW(parse_plan(text, "log"), FileError) << text;
    }
}

TEST(Sittings, SeatsAreDealtEvenlyInTheirOrder) {
    using Seats = std::vector<std::vector<int>>;
    EXPECT_EQ(deal_seats({4, 2, 9, 1, 7}, 2), (Seats{{1, 2, 4}, {7, 9}}));
    EXPECT_EQ(deal_seats({1, 2, 3, 4, 5, 6, 7}, 3), (Seats{{1, 2, 3}, {4, 5}, {6, 7}}));
    EXPECT_EQ(deal_seats({3}, 2), (Seats{{3}, {}}));
    EXPECT_EQ(deal_seats({}, 1), (Seats{{}}));
    EXPECT_THROW(deal_seats({1}, 0), std::invalid_argument);
    // As many waves as the sittings have, and none with more than its size
    for (int evaluators = 1; evaluators <= 30; ++evaluators) {
        std::vector<int> seats(static_cast<std::size_t>(evaluators));
        std::iota(seats.begin(), seats.end(), 1);
        for (int size = 1; size <= 5; ++size) {
            const auto waves = wave_sittings(4, evaluators, size, 1).size();
            for (const auto& wave : deal_seats(seats, static_cast<int>(waves))) {
                EXPECT_LE(wave.size(), static_cast<std::size_t>(size));
                EXPECT_GE(wave.size(), 1u);
            }
        }
    }
}

}  // namespace
}  // namespace livery
