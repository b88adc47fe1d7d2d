#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ballot/ballot_messages_io.h"
#include "core/error.h"
#include "support/file_error.h"

namespace livery {
namespace {

TEST(BallotMessages, AVoteIsARoundAndCodes) {
    const VoteMessage vote = parse_vote(R"({"round": 3, "best": 412, "second": 907})");
    EXPECT_EQ(vote.round, 3);
    EXPECT_EQ(vote.best, 412);
    EXPECT_EQ(vote.second, 907);
    EXPECT_FALSE(vote.least);
    EXPECT_FALSE(parse_vote(R"({"round":3,"best":412,"second":907,"least":null})").least);
    EXPECT_EQ(parse_vote(R"({"round":3,"best":412,"second":907,"least":133})").least, 133);
}

TEST(BallotMessages, NameWhatIsWrong) {
    for (const auto& [body, part] : std::vector<std::pair<std::string, std::string>>{
             {"", "ballot"},
             {"best=412", "ballot"},
             {"[1, 2]", "object"},
             {R"({"round": 3, "best": 412})", "second"},
             {R"({"round": 3, "best": "412", "second": 907})", "best"},
             {R"({"round": 3, "best": 99, "second": 907})", "best"},
             {R"({"round": 3, "best": 1000, "second": 907})", "best"},
             {R"({"round": 3, "best": 412.5, "second": 907})", "best"},
             {R"({"round": 0, "best": 412, "second": 907})", "round"},
             {R"({"round": 1e300, "best": 412, "second": 907})", "round"},
             {R"({"round": 3, "best": 412, "second": 907, "seat": 7})", "seat"},
             {R"({"round": 3, "best": 412, "second": 907, "least": "' OR 1=1"})", "least"},
             {std::string(1000, '['), "ballot"},
             {"{\"round\": 3, \"best\": 412, \"second\": 907, \"\xff\": 1}", "ballot"}}) {
        EXPECT_TRUE(fails_with([&] { parse_vote(body); }, {part})) << body;
    }
    EXPECT_EQ(parse_join(R"({"code": "k7m 2pq"})"), "k7m 2pq");
    for (const char* body : {"{}", R"({"code": 7})", R"({"code": "K7M2PQ", "seat": 1})"}) {
        EXPECT_TRUE(fails_with([&] { parse_join(body); }, {"joining"})) << body;
    }
}

TEST(BallotMessages, TellTheStateAndNoMore) {
    PageState state;
    state.state = "join";
    EXPECT_EQ(text_of(state), R"({"state":"join","seat":0,"round":0})");
    state.state = "voting";
    state.seat = 5;
    state.round = 3;
    state.codes = {133, 412, 907};
    EXPECT_EQ(text_of(state),
              R"({"state":"voting","seat":5,"round":3,"codes":[133,412,907],"least":false})");
    state.ballot = VoteMessage{3, 412, 907};
    state.receipt = "3fa291c0";
    EXPECT_EQ(text_of(state),
              R"({"state":"voting","seat":5,"round":3,"codes":[133,412,907],"least":false,)"
              R"("ballot":{"round":3,"best":412,"second":907,"least":null},)"
              R"("receipt":"3fa291c0"})");
    // Whatever a problem quotes, it is a JSON text.
    const std::string quoted = problem_text("found \"</script>\xff\n");
    EXPECT_NO_THROW(EXPECT_TRUE(nlohmann::json::parse(quoted).contains("problem")));
}

}  // namespace
}  // namespace livery
