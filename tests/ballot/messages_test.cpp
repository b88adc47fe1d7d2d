#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ballot/ballot_service.h"
#include "core/error.h"
#include "support/file_error.h"

namespace livery {
namespace {

std::optional<Round> round_three() {
    Round round;
    round.id = 3;
    round.codes = {412, 133, 907};
    round.designs = {"a", "b", "c"};
    return round;
}

TEST(BallotMessages, AVoteIsARoundAndCodes) {
    const auto parsed = [](const char* body) { return parse_vote(body, round_three()); };
    EXPECT_EQ(parsed(R"({"round": 3, "best": 412, "second": 907})"), (Ballot{0, 2}));
    EXPECT_EQ(parsed(R"({"round":3,"best":412,"second":907,"least":null})"), (Ballot{0, 2}));
    EXPECT_EQ(parsed(R"({"round":3,"best":412,"second":907,"least":133})"), (Ballot{0, 2, 1}));
    EXPECT_THROW(parsed(R"({"round": 4, "best": 412, "second": 907})"), Refused);
    EXPECT_THROW(parse_vote(R"({"round": 3, "best": 412, "second": 907})", {}), Refused);
}

TEST(BallotMessages, NameWhatIsWrong) {
    for (const auto& [body, part] : std::vector<std::pair<std::string, std::string>>{
             {"", "ballot"},
             {"best=412", "ballot"},
             {"[1, 2]", "object"},
             {R"({"round": 3, "best": 412})", "second"},
             {R"({"round": 3, "best": "412", "second": 907})", "best"},
             {R"({"round": 3, "best": 99, "second": 907})", "best"},
             {R"({"round": 3, "best": 413, "second": 907})", "best"},
             {R"({"round": 3, "best": 1000, "second": 907})", "best"},
             {R"({"round": 3, "best": 412.5, "second": 907})", "best"},
             {R"({"round": 0, "best": 412, "second": 907})", "round"},
             {R"({"round": 1e300, "best": 412, "second": 907})", "round"},
             {R"({"round": 3, "best": 412, "second": 907, "seat": 7})", "seat"},
             {R"({"round": 3, "best": 412, "second": 907, "least": "' OR 1=1"})", "least"},
             {std::string(1000, '['), "ballot"},
             {"{\"round\": 3, \"best\": 412, \"second\": 907, \"\xff\": 1}", "ballot"}}) {
        EXPECT_TRUE(fails_with([&] { parse_vote(body, round_three()); }, {part})) << body;
    }
    EXPECT_EQ(parse_join(R"({"code": "k7m 2pq"})"), "k7m 2pq");
    for (const char* body : {"{}", R"({"code": 7})", R"({"code": "K7M2PQ", "seat": 1})"}) {
        EXPECT_TRUE(fails_with([&] { parse_join(body); }, {"joining"})) << body;
    }
}

TEST(BallotMessages, ALookIsPlacedOnScales) {
    const RatingMessage rating =
        parse_rating(R"({"round": 3, "look": 133, "steps": [4, null, 7]})", round_three());
    EXPECT_EQ(rating.design, 1);
    EXPECT_EQ(rating.steps, (ScaleSteps{4, 0, 7}));
    // The longest there is stays far below a kilobyte.
    EXPECT_LT(
        std::string(R"({"round": 1000000, "look": 412, "steps": [null, null, null, null, null]})")
            .size(),
        200u);
    for (const auto& [body, part] : std::vector<std::pair<std::string, std::string>>{
             {"", "answers"},
             {R"({"round": 3, "look": 412})", "steps"},
             {R"({"round": 3, "look": 412, "steps": []})", "steps"},
             {R"({"round": 3, "look": 412, "steps": [1, 2, 3, 4, 5, 6]})", "steps"},
             {R"({"round": 3, "look": 412, "steps": [0]})", "steps[0]"},
             {R"({"round": 3, "look": 412, "steps": [4, 8]})", "steps[1]"},
             {R"({"round": 3, "look": 412, "steps": ["4"]})", "steps[0]"},
             {R"({"round": 3, "look": 412, "steps": [4.5]})", "steps[0]"},
             {R"({"round": 3, "look": 412, "steps": {"0": 4}})", "steps"},
             {R"({"round": 3, "look": 42, "steps": [4]})", "look"},
             {R"({"round": 3, "look": 412, "steps": [4], "seat": 2})", "seat"}}) {
        EXPECT_TRUE(fails_with([&] { parse_rating(body, round_three()); }, {part})) << body;
    }
}

TEST(BallotMessages, WordsAreTextWhateverTheySay) {
    PageState state{"voting", 1, 0, 0, round_three(), true, {{0, 7}, {0, 0}, {0, 0}}};
    state.round->scales = {{"</script><b>", "\"};alert(1)//"}, {"cheap", "precious"}};
    const auto told = nlohmann::json::parse(text_of(state));
    EXPECT_EQ(told["scales"][0][0], "</script><b>");
    EXPECT_EQ(told["scales"][0][1], "\"};alert(1)//");
    EXPECT_EQ(told["ratings"], (nlohmann::json{{"412", {nullptr, 7}}}));
}

TEST(BallotMessages, TellTheStateAndNoMore) {
    PageState state;
    state.state = "join";
    EXPECT_EQ(text_of(state), R"({"state":"join","seat":0,"round":0})");
    state = {"voting", 5, 0, 0, round_three(), true};
    EXPECT_EQ(text_of(state),
              R"({"state":"voting","seat":5,"round":3,"codes":[133,412,907],"least":false})");
    state.ballot = CastBallot{5, {0, 2}, "3fa291c0"};
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
