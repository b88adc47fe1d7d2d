// Paper ballots: lines of a file, and keys on a terminal.

#include "evaluation/paper_ballots.h"

#include <string>

#include <gtest/gtest.h>

#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

Round some_round(bool least) {
    Round round;
    round.id = 1;
    round.designs = {"red", "silver", "sand"};
    round.codes = {481, 376, 912};
    round.asks_least = least;
    return round;
}

TEST(PaperBallots, AreReadInEveryUsualShape) {
    for (const char* text : {"481,376\n912,481\n",
                             "481;376\r\n912;481\r\n",
                             "481 376\n 912\t481 ",
                             "# a comment\n\nbest,second\n481, 376\n912, 481",
                             "\xef\xbb\xbfsecond,best\n376,481\n481,912\n"}) {
        const auto ballots = parse_paper_ballots(text, "votes.csv", some_round(false));
        ASSERT_EQ(ballots.size(), 2u) << text;
        EXPECT_EQ(ballots[0].ballot, (Ballot{0, 1})) << text;
        EXPECT_EQ(ballots[1].ballot, (Ballot{2, 0})) << text;
        EXPECT_EQ(ballots[0].paper, 0);
    }
    const auto least =
        parse_paper_ballots("481,376,912\n376,912,\n912,481\n", "votes.csv", some_round(true));
    EXPECT_EQ(least[0].ballot, (Ballot{0, 1, 2}));
    EXPECT_EQ(least[1].ballot, (Ballot{1, 2}));
    EXPECT_EQ(least[2].ballot, (Ballot{2, 0}));
    const auto numbered =
        parse_paper_ballots("paper,best,second\n7,481,376\n3,912,481\n", "v", some_round(false));
    EXPECT_EQ(numbered[0].paper, 7);
    EXPECT_EQ(numbered[1].paper, 3);
}

TEST(PaperBallots, BadLinesAreRefusedByNumber) {
    const auto refused = [](const std::string& text, const std::string& part, bool least = false) {
        const std::string message =
            message_of([&] { parse_paper_ballots(text, "votes.csv", some_round(least)); });
        EXPECT_EQ(message.find("votes.csv"), 0u) << message;
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    refused("481,376\n481,99\n",
            "line 2: found \"99\", expected a code of the round: 376, 481 or 912");
    refused("481,481\n", "line 1: found one look twice");
    refused("481,376,481\n", "line 1: found one look twice", true);
    refused("481\n", "line 1: found 1 cell, expected best, second");
    refused("481,376,912\n", "line 1: found 3 cells");
    refused("best,second\n481,\n", "line 2: found \"\"");
    refused("best,third\n", "line 1: found \"third\"");
    refused("best,best\n", "line 1: found \"best\"");
    refused("best\n", "expected best and second");
    refused("481,376\nbest,second\n", "line 2: found \"best\"");
    refused("", "found no ballot");
    refused("# nothing\n", "found no ballot");
    refused("paper,best,second\n7,481,376\n7,376,481\n", "line 3: found paper 7 a second time");
    refused("paper,best,second\n0,481,376\n", "line 2: found \"0\"");
    refused("481.0,376\n", "found \"481.0\"");
    refused("481481481481,376\n", "found \"481481481481\"");
    std::string many;
    for (int k = 0; k < 1001; ++k) many += "481,376\n";
    refused(many, "line 1001: found more ballots, expected at most 1000");
}

TEST(PaperBallots, GetNumbersThatAreFree) {
    const std::vector<PaperBallot> papers = {{0, {0, 1}}, {5, {0, 1}}, {0, {1, 0}}};
    const auto ballots = numbered(papers, 4);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(ballots[static_cast<std::size_t>(k)].paper, 4 + k);
    EXPECT_EQ(next_paper({}), 1);
    EXPECT_EQ(next_paper({{1, "paper 9"}, {2, ""}, {3, "paper plane"}, {4, "Eve"}}), 10);
    EXPECT_NE(message_of([&] { numbered(papers, 9999); }).find("10000"), std::string::npos);
}

class PaperTypingTest : public ::testing::Test {
  protected:
    int opened(bool least) {
        RoundSetup setup{{"red", "silver", "sand"}, "", {481, 376, 912}};
        setup.asks_least = least;
        return store_.open_round(setup);
    }
    static std::string typed(PaperTyping& typing, const std::vector<std::string>& lines) {
        std::string said;
        for (const std::string& line : lines) said += typing.take(line);
        return said;
    }
    TemporaryFolder folder_;
    BallotStore store_{folder_ / "votes.sqlite"};
};

TEST_F(PaperTypingTest, KeepsEachBallotWhenTheNextBegins) {
    const int round = opened(false);
    PaperTyping typing(store_, round);
    EXPECT_EQ(typing.prompt(), "paper 1, best: ");
    EXPECT_EQ(typed(typing, {"481"}), "");
    EXPECT_EQ(typing.prompt(), "paper 1, second: ");
    EXPECT_EQ(typed(typing, {" 376 "}), "paper 1: best 481, second 376.\n");
    EXPECT_EQ(store_.voted(round).size(), 0u) << "it can still be taken back";
    EXPECT_EQ(typing.prompt(), "paper 2, best: ");
    typed(typing, {"912"});
    EXPECT_EQ(store_.voted(round).size(), 1u);
    typed(typing, {"481", "*"});
    EXPECT_TRUE(typing.done());
    EXPECT_EQ(typing.kept().size(), 2u);
    store_.close_round(round);
    EXPECT_EQ(store_.tally(round).best, (std::vector<int>{1, 0, 1}));
    EXPECT_EQ(store_.seats(1)[1].name, "paper 2");
}

TEST_F(PaperTypingTest, TakesBackACodeOrTheLastBallotAndNoMore) {
    const int round = opened(true);
    PaperTyping typing(store_, round);
    EXPECT_NE(typed(typing, {"-"}).find("Nothing can be taken back"), std::string::npos);
    EXPECT_EQ(typed(typing, {"481", "-"}), "best 481 is taken back.\n");
    EXPECT_EQ(typing.prompt(), "paper 1, best: ");
    EXPECT_EQ(typed(typing, {"481", "376", "912"}), "paper 1: best 481, second 376, least 912.\n");
    EXPECT_EQ(typed(typing, {"-"}), "paper 1 is taken back: type it again, or end.\n");
    EXPECT_EQ(typing.prompt(), "paper 1, best: ");
    EXPECT_NE(typed(typing, {"-"}).find("Nothing can be taken back"), std::string::npos);
    EXPECT_EQ(typed(typing, {"376", "481", ""}), "paper 1: best 376, second 481, no least.\n");
    EXPECT_EQ(typing.finish(), "");
    EXPECT_EQ(store_.ballot_of(round, 1)->ballot, (Ballot{1, 0}));
}

TEST_F(PaperTypingTest, ReplacesAnEarlierPaper) {
    const int round = opened(false);
    PaperTyping typing(store_, round);
    typed(typing, {"481", "376", "481", "376"});
    EXPECT_EQ(typed(typing, {".1"}), "paper 1 was typed before: what comes now replaces it.\n");
    typed(typing, {"912", "376"});
    EXPECT_EQ(typing.prompt(), "paper 3, best: ");
    typed(typing, {"*"});
    ASSERT_EQ(typing.kept().size(), 3u);
    EXPECT_TRUE(typing.kept()[2].replaced);
    EXPECT_EQ(store_.voted(round).size(), 2u);
    EXPECT_EQ(store_.ballot_of(round, 1)->ballot, (Ballot{2, 1}));
}

TEST_F(PaperTypingTest, SaysWhatIsWrongAndGoesOn) {
    const int round = opened(false);
    PaperTyping typing(store_, round);
    EXPECT_EQ(typed(typing, {"999"}), "\"999\" is no code of this round: 376, 481 or 912.\n");
    EXPECT_NE(typed(typing, {"4x"}).find("is no code"), std::string::npos);
    EXPECT_NE(typed(typing, {""}).find("Type the code of the best look"), std::string::npos);
    EXPECT_NE(typed(typing, {"481", "481"}).find("481 is the best of this paper already"),
              std::string::npos);
    EXPECT_NE(typed(typing, {"*"}).find("is begun"), std::string::npos);
    EXPECT_FALSE(typing.done());
    EXPECT_NE(typed(typing, {".3"}).find("is begun"), std::string::npos);
    EXPECT_NE(typed(typing, {"376", "."}).find("a paper's number"), std::string::npos);
    EXPECT_NE(typed(typing, {".99999"}).find("a paper's number"), std::string::npos);
    const std::string sum = typed(typing, {"+"});
    EXPECT_NE(sum.find("1 ballot typed here; round 1 holds 0, and paper 1"), std::string::npos)
        << sum;
    typed(typing, {"912"});
    EXPECT_EQ(typing.finish(), "paper 2 was not complete and is not kept.\n");
    EXPECT_EQ(store_.voted(round).size(), 1u);
}

TEST_F(PaperTypingTest, FindsARoundThatIsLockedMeanwhile) {
    const int round = opened(false);
    PaperTyping typing(store_, round);
    typed(typing, {"481", "376"});
    store_.close_round(round);
    EXPECT_NE(message_of([&] { typing.take("912"); }).find("too late"), std::string::npos);
    EXPECT_NE(message_of([&] { PaperTyping(store_, 9); }).find("round 9"), std::string::npos);
}

TEST_F(PaperTypingTest, ManyBallotsAreOneTransaction) {
    const int round = opened(false);
    const NamedBallots bad = {{"paper 1", {0, 1}}, {"paper 2", {1, 2}}, {"paper 3", {1, 1}}};
    EXPECT_NE(message_of([&] { store_.vote(round, bad); }).find("paper 3"), std::string::npos);
    EXPECT_TRUE(store_.voted(round).empty());
    EXPECT_TRUE(store_.seats(1).empty());
    const auto cast = store_.vote(round, NamedBallots{bad[0], bad[1], {"paper 1", {2, 1}}});
    EXPECT_EQ(cast.size(), 3u);
    EXPECT_EQ(store_.voted(round).size(), 2u);
    EXPECT_EQ(cast[2].receipt.size(), 8u);
}

}  // namespace
}  // namespace livery
