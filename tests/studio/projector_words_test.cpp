// What the bar says of the projector.
#include <gtest/gtest.h>

#include "studio/projector.h"

namespace livery {
namespace {

using State = ProjectorScreen::State;
using Mood = ProjectorWords::Mood;

ProjectorFacts showing() {
    ProjectorFacts facts;
    facts.state = State::showing;
    facts.wanted = facts.shown = 7;
    return facts;
}

bool says_showing(const ProjectorFacts& facts) {
    const ProjectorWords words = projector_words(facts);
    return words.text == "showing" || words.mood == Mood::good;
}

TEST(ProjectorWords, SayShowingOnlyOfWhatIsShown) {
    EXPECT_TRUE(says_showing(showing()));
    const auto with = [](auto change) {
        ProjectorFacts facts = showing();
        change(facts);
        return facts;
    };
    EXPECT_FALSE(says_showing(with([](auto& f) { f.black = true; })));
    EXPECT_FALSE(says_showing(with([](auto& f) { f.frozen = true; })));
    EXPECT_FALSE(says_showing(with([](auto& f) { f.monitor_numbers = true; })));
    EXPECT_FALSE(says_showing(with([](auto& f) { f.instead = {"showing the test picture"}; })));
    EXPECT_FALSE(says_showing(with([](auto& f) { f.not_drawn = "a file is gone"; })));
    EXPECT_FALSE(says_showing(with([](auto& f) { f.other_product = "made for a bottle"; })));
    EXPECT_FALSE(says_showing(with([](auto& f) { f.state = State::off; })));
    EXPECT_FALSE(says_showing(with([](auto& f) { f.state = State::waiting_for_monitor; })));
    EXPECT_FALSE(says_showing(with([](auto& f) { f.only_screen = true; })));
    EXPECT_FALSE(says_showing(with([](auto& f) {
        f.wanted = 8;
        f.waited_s = kUnspokenWait_s;
    })));
    // Shorter than anybody reads: no flicker while the pointer goes over paints.
    EXPECT_TRUE(says_showing(with([](auto& f) { f.wanted = 8; })));
}

TEST(ProjectorWords, TellWhyALookIsNotShown) {
    ProjectorFacts facts = showing();
    facts.not_drawn = "a file is gone";
    EXPECT_EQ(projector_words(facts).mood, Mood::error);
    EXPECT_EQ(projector_words(facts).help, "a file is gone");
    facts.black = true;
    EXPECT_EQ(projector_words(facts).text, "black") << "nothing is to be seen at all";
}

}  // namespace
}  // namespace livery
