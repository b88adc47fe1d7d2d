// What a ballots file keeps of answers on scales.
#include <functional>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evaluation/closed_round.h"
#include "evaluation/report/report_document.h"
#include "evaluation/report/round_report.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

class Ratings : public ::testing::Test {
  protected:
    Ratings() {
        const int session = store_.open_session();
        for (int phone = 1; phone <= 3; ++phone) {
            store_.join(session, "phone " + std::to_string(phone), 9);
        }
        RoundSetup setup;
        setup.designs = {"red", "silver, light"};
        setup.scales = {{"cheap", "precious"}, {"cold", "warm"}};
        round_ = store_.open_round(setup);
        store_.vote(round_, 1, {0, 1});
        store_.rate(round_, 1, 0, {2, 0});
        store_.rate(round_, 1, 1, {7, 4});
        store_.vote(round_, 2, {1, 0});
        store_.rate(round_, 2, 1, {6, 5});
        store_.rate(round_, 2, 1, {0, 3});
    }
    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "ballots.sqlite";
    BallotStore store_{file_};
    int round_ = 0;
};

TEST_F(Ratings, AreKeptWithTheBallotAndChangeUntilTheLock) {
    BallotStore again(file_);
    EXPECT_EQ(again.open_round()->scales.size(), 2u);
    EXPECT_EQ(again.ratings_of(round_, 1).at(0), (ScaleSteps{2, 0}));
    EXPECT_EQ(again.ratings_of(round_, 2).at(1), (ScaleSteps{0, 3}));
    EXPECT_EQ(again.ratings_of(round_, 3), (ScaleAnswers{{0, 0}, {0, 0}}));
    const std::size_t entries = again.log().size();
    again.rate(round_, 1, 1, {7, 4});
    EXPECT_EQ(again.log().size(), entries) << "nothing changed";
    EXPECT_THROW(again.rate(round_, 3, 0, {1, 1}), Refused) << "no ballot yet";
    EXPECT_THROW(again.ratings(round_), Refused) << "while it is open";
    for (const auto& wrong :
         std::vector<std::function<void()>>{[&] {
                                                again.rate(round_, 1, 2, {1, 1});
                                            },
                                            [&] { again.rate(round_, 1, 0, {1}); },
                                            [&] {
                                                again.rate(round_, 1, 0, {8, 1});
                                            },
                                            [&] {
                                                again.rate(round_, 1, 0, {-1, 1});
                                            }}) {
        EXPECT_THROW(wrong(), std::invalid_argument);
    }
    again.close_round(round_);
    EXPECT_THROW(again.rate(round_, 1, 0, {1, 1}), Refused);
    EXPECT_EQ(again.ratings(round_).size(), 2u);
    const int plain = again.open_round({"a", "b"}, "");
    again.vote(plain, 1, {0, 1});
    EXPECT_THROW(again.rate(plain, 1, 0, {}), std::invalid_argument);
}

TEST_F(Ratings, AreExportedBesideTheirBallotWithoutNames) {
    store_.close_round(round_);
    const ClosedRound closed = read_closed_round(file_, round_, 4);
    ASSERT_EQ(closed.answers.size(), 2u);
    const std::size_t first = closed.ballots[0].best == 0 ? 0 : 1;
    EXPECT_EQ(closed.answers[first], (ScaleAnswers{{2, 0}, {7, 4}}));
    EXPECT_EQ(closed.answers[1 - first], (ScaleAnswers{{0, 0}, {0, 3}}));
    const std::string csv = ballots_csv(closed, 4);
    EXPECT_NE(
        csv.find("best,second,red: cheap - precious,red: cold - warm,\"silver, light: cheap - "
                 "precious\",\"silver, light: cold - warm\"\r\n"),
        std::string::npos)
        << csv;
    EXPECT_NE(csv.find("red,\"silver, light\",2,,7,4\r\n"), std::string::npos) << csv;
}

TEST_F(Ratings, TheReportHasThemAndTheDuelAsText) {
    store_.close_round(round_);
    RoundSetup setup;
    setup.designs = {"<b>red</b>", "blue"};
    setup.scales = {{"<script>1</script>", "\"><img>"}};
    const int hostile = store_.open_round(setup);
    store_.vote(hostile, 1, {0, 1});
    store_.rate(hostile, 1, 0, {3});
    store_.close_round(hostile);
    const std::string html = html_of(round_report(round_report_source(file_, hostile, 1)));
    EXPECT_NE(html.find("Where the looks lie between words"), std::string::npos);
    EXPECT_NE(html.find("&lt;script&gt;1&lt;/script&gt;"), std::string::npos);
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("<img>"), std::string::npos);
    EXPECT_EQ(html.find("<b>red"), std::string::npos);

    // A repeat's report says the whole duel.
    setup.scales.clear();
    int last = 0;
    for (int repeat = 0; repeat < 2; ++repeat) {
        setup.series = SeriesPlace{last, 2, round_};
        const int held = store_.open_round(setup);
        if (last == 0) last = held;
        store_.vote(held, 1, {0, 1});
        store_.close_round(held);
    }
    const std::string duel = html_of(round_report(round_report_source(file_, last, 1)));
    EXPECT_NE(duel.find("The duel"), std::string::npos);
    EXPECT_NE(duel.find("too few to show a preference"), std::string::npos);
    EXPECT_EQ(duel.find("<b>red"), std::string::npos);
    EXPECT_EQ(html_of(round_report(round_report_source(file_, round_, 1))).find("The duel"),
              std::string::npos);
}

}  // namespace
}  // namespace livery
