// What a presented round leaves beside its ballots, and that its report reads it.
#include "studio/presenting/round_files.h"

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "evaluation/report/report_document.h"
#include "evaluation/report/round_report.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Event = PresentationEvent;

std::shared_ptr<const ImageF> wanted_of(float level) {
    return std::make_shared<const ImageF>(16, 10, 4, level);
}

TEST(RoundFiles, OfAPresentedRoundAreWhatItsReportSays) {
    const TemporaryFolder folder;
    const auto file = folder / "ballots.sqlite";
    BallotStore store(file);
    RoundSetup setup;
    setup.designs = {"red", "blue"};
    setup.presenting = true;
    setup.seed = 4;
    setup.plan = PresentationPlan{{{1, 0}, {0, 1}}, {1.0, 1.0, 1.0}, "", "frames/x", {}};
    const int id = store.open_round(setup);
    const Round round = store.open_round().value();

    std::vector<FrozenLook> looks;
    for (const float level : {0.2f, 0.6f}) {
        looks.push_back({wanted_of(level), std::make_shared<const Image8>(16, 10, 3)});
    }
    const RoundDetails kept = write_frozen_looks(file, round, looks, ProjectorSetup());
    ASSERT_EQ(kept.looks.size(), 2u);
    EXPECT_FALSE(kept.looks[0].reachability) << "nothing is known without a calibration";
    EXPECT_TRUE(unfair_looks(kept).empty());
    EXPECT_EQ(read_image(kept.folder / kept.looks[1].picture).image.width, 16);

    PresentationState state;
    double now_s = 0.0;
    const auto send = [&](Event event) {
        state = after(*setup.plan, state, event, now_s += 0.1);
        store.record_step(id, state, event);
    };
    // Adaptation, blue, grey, red, once more, then votes; the second wave; then all is locked.
    for (const Event event :
         {Event::present, Event::next, Event::next, Event::next, Event::repeat}) {
        send(event);
    }
    for (int k = 0; k < 3 && state.phase != PresentationPhase::voting; ++k) send(Event::next);
    ASSERT_EQ(state.phase, PresentationPhase::voting);
    for (int k = 0; k < 3; ++k) store.vote(id, "paper " + std::to_string(k), {0, 1});
    send(Event::next);
    for (int k = 0; k < 8 && state.phase != PresentationPhase::voting; ++k) send(Event::next);
    send(Event::lock);

    const RoundReportSource source = round_report_source(file, id, 4);
    ASSERT_TRUE(source.record);
    const auto& showings = source.record->showings;
    const int red = round.codes[0], blue = round.codes[1];
    ASSERT_EQ(showings.size(), 2u);
    EXPECT_EQ(showings[0].codes, (std::vector<int>{blue, red, red}));
    EXPECT_EQ(showings[1].codes, (std::vector<int>{red, blue}));
    EXPECT_EQ(source.details.looks.size(), 2u);
    const std::string html = html_of(round_report(source));
    EXPECT_NE(
        html.find(std::to_string(blue) + ", " + std::to_string(red) + ", " + std::to_string(red)),
        std::string::npos);
}

TEST(RoundFiles, LooksAreFairUnlessMuchOfThemIsFarOff) {
    EXPECT_TRUE(is_fair({0.95, 0.2, 9.0})) << "a highlight that clips";
    EXPECT_TRUE(is_fair({0.3, 1.1, 2.5})) << "hard to see";
    EXPECT_FALSE(is_fair({0.5, 2.0, 8.0}));
    EXPECT_TRUE(is_fair({})) << "not known";
    RoundDetails details;
    details.looks = {{374, "", LookReachability{0.5, 2.0, 8.0}},
                     {512, "", LookReachability{1.0, 0.1, 0.3}}};
    EXPECT_EQ(unfair_looks(details), std::vector<int>{374});
    EXPECT_NE(reach_in_words(details.looks[0]).find("374: 50% of it as wanted"), std::string::npos);
}

}  // namespace
}  // namespace livery
