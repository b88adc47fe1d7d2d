// What the server answers, without a network.
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ballot/ballot_service.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Json = nlohmann::json;

constexpr double kNow = 1'700'000'000.0;

class BallotServiceTest : public ::testing::Test {
  protected:
    BallotServiceTest()
        : file_(folder_ / "ballots.sqlite"),
          service_(file_, {{false, {"127.0.0.1:8470"}}, 3}),
          operators_(file_) {
        service_.keep_invitation(kNow);
    }

    static BallotRequest request(const std::string& method,
                                 const std::string& path,
                                 const std::string& secret = "",
                                 const std::string& body = "") {
        BallotRequest request;
        request.method = method;
        request.path = path;
        request.host = "127.0.0.1:8470";
        if (!secret.empty()) request.cookies = "livery-seat=" + secret;
        if (method == "PUT" || method == "POST") {
            request.origin = "http://127.0.0.1:8470";
            request.fetch_site = "same-origin";
            request.content_type = "application/json";
        }
        request.body = body;
        request.client = "phone";
        return request;
    }
    BallotResponse ask(const BallotRequest& request, double now = kNow) {
        return service_.answer(request, now);
    }
    Json state(const std::string& secret) {
        const auto answer = ask(request("GET", "/state", secret));
        EXPECT_EQ(answer.status, 200);
        return Json::parse(answer.body);
    }
    Invitation invitation() { return operators_.invitation(operators_.session().value()).value(); }
    /// The secret of a new seat, by the QR code.
    std::string join() {
        const auto answer = ask(request("GET", "/join/" + invitation().token));
        EXPECT_EQ(answer.status, 303);
        EXPECT_EQ(answer.location, "/");
        return answer.cookie ? seat_secret(*answer.cookie).value_or("") : "";
    }
    int open(bool presenting = false, bool least = false) {
        RoundSetup setup;
        setup.designs = {"a", "b", "c", "d"};
        setup.codes = {412, 907, 133, 560};
        setup.presenting = presenting;
        setup.asks_least = least;
        return operators_.open_round(setup);
    }
    BallotResponse vote(const std::string& secret, const std::string& body) {
        return ask(request("PUT", "/ballot", secret, body));
    }

    TemporaryFolder folder_;
    std::filesystem::path file_;
    BallotService service_;
    BallotStore operators_;  ///< the operator's program, on the same file
};

TEST_F(BallotServiceTest, GoesFromTheQrCodeToALockedVote) {
    EXPECT_EQ(state("")["state"], "join");
    const std::string secret = join();
    ASSERT_EQ(secret.size(), 32u);
    EXPECT_EQ(state(secret), (Json{{"state", "waiting"}, {"seat", 1}, {"round", 0}}));
    const int round = open(true);
    EXPECT_EQ(state(secret)["state"], "presenting");
    EXPECT_FALSE(state(secret).contains("codes")) << "before they have been shown";
    EXPECT_EQ(state("")["state"], "shut");
    const std::string body = R"({"round": 1, "best": 907, "second": 560})";
    EXPECT_EQ(vote(secret, body).status, 409) << "too early";
    operators_.start_voting(round);
    EXPECT_EQ(state(secret)["codes"], (Json{133, 412, 560, 907}));
    const auto answer = vote(secret, body);
    ASSERT_EQ(answer.status, 200) << answer.body;
    const Json told = Json::parse(answer.body);
    EXPECT_EQ(told["ballot"]["best"], 907);
    EXPECT_EQ(told["receipt"].get<std::string>().size(), 8u);
    EXPECT_EQ(told, state(secret)) << "a reload shows the same";
    EXPECT_EQ(vote(secret, body).body, answer.body) << "sent twice";
    EXPECT_EQ(operators_.open_round().value().ballots, 1);
    EXPECT_EQ(vote(secret, R"({"round": 1, "best": 133, "second": 560})").status, 200);
    operators_.close_round(round);
    EXPECT_EQ(vote(secret, body).status, 409);
    const Json locked = state(secret);
    EXPECT_EQ(locked["state"], "locked");
    EXPECT_EQ(locked["ballot"]["best"], 133);
    EXPECT_EQ(operators_.tally(round).best, (std::vector<int>{0, 0, 1, 0}));
}

TEST_F(BallotServiceTest, ALaterGroupWaitsForItsTurn) {
    const std::string first = join(), second = join();
    RoundSetup setup;
    setup.designs = {"a", "b", "c", "d"};
    setup.codes = {412, 907, 133, 560};
    setup.presenting = true;
    setup.plan = PresentationPlan{{{0, 1, 2, 3}, {3, 2, 1, 0}}, {1.0, 1.0, 1.0}, "", "f", {}};
    const int round = operators_.open_round(setup);
    using Phase = PresentationPhase;
    const auto show = [&](Phase phase, int sitting) {
        operators_.record_step(round, {phase, sitting}, PresentationEvent::next);
    };
    show(Phase::presenting, 0);
    EXPECT_EQ(state(first)["state"], "presenting");
    EXPECT_EQ(state(second),
              (Json{{"state", "waiting"}, {"seat", 2}, {"round", 1}, {"wave", 2}, {"waves", 2}}));
    show(Phase::voting, 0);
    const std::string body = R"({"round": 1, "best": 907, "second": 560})";
    EXPECT_EQ(state(first)["state"], "voting");
    EXPECT_EQ(vote(first, body).status, 200);
    EXPECT_EQ(state(second)["state"], "waiting");
    EXPECT_FALSE(state(second).contains("codes"));
    EXPECT_EQ(vote(second, body).status, 409);
    EXPECT_EQ(vote(second, R"({"round": 1, "best": 907, "second": 111})").status, 400);
    show(Phase::presenting, 1);
    EXPECT_EQ(state(second)["state"], "presenting");
    EXPECT_EQ(vote(second, body).status, 409);
    EXPECT_EQ(vote(first, R"({"round": 1, "best": 133, "second": 560})").status, 200)
        << "an earlier group may change its ballots";
    show(Phase::voting, 1);
    EXPECT_EQ(state(second)["state"], "voting");
    EXPECT_EQ(vote(second, body).status, 200);
    operators_.close_round(round);
    EXPECT_EQ(state(second)["state"], "locked");
    EXPECT_FALSE(state(second).contains("wave"));
    EXPECT_EQ(operators_.ballots(round).size(), 2u);
}

TEST_F(BallotServiceTest, LooksArePlacedOnScalesAfterTheBallot) {
    const std::string secret = join(), other = join();
    RoundSetup setup;
    setup.designs = {"a", "b"};
    setup.codes = {412, 133};
    setup.scales = {{"cheap", "precious"}, {"cold", "warm"}};
    const int round = operators_.open_round(setup);
    const auto rate = [&](const std::string& seat, const std::string& body) {
        return ask(request("PUT", "/scales", seat, body));
    };
    const std::string body = R"({"round": 1, "look": 412, "steps": [2, null]})";
    EXPECT_EQ(state(secret)["scales"],
              (Json::parse(R"([["cheap", "precious"], ["cold", "warm"]])")));
    EXPECT_EQ(rate(secret, body).status, 409) << "before the ballot";
    EXPECT_EQ(rate("", body).status, 401);
    ASSERT_EQ(vote(secret, R"({"round": 1, "best": 412, "second": 133})").status, 200);
    const Json receipt = state(secret)["receipt"];
    const auto answer = rate(secret, body);
    ASSERT_EQ(answer.status, 200) << answer.body;
    EXPECT_EQ(Json::parse(answer.body)["ratings"], (Json{{"412", {2, nullptr}}}));
    EXPECT_EQ(rate(secret, body).body, answer.body) << "sent twice";
    EXPECT_EQ(rate(secret, R"({"round": 1, "look": 133, "steps": [null, 6]})").status, 200);
    EXPECT_EQ(rate(secret, R"({"round": 1, "look": 412, "steps": [7, 1]})").status, 200);
    EXPECT_EQ(rate(secret, R"({"round": 1, "look": 133, "steps": [null, null]})").status, 200);
    EXPECT_EQ(state(secret)["ratings"], (Json{{"412", {7, 1}}}));
    EXPECT_EQ(state(secret)["receipt"], receipt) << "the ballot's";
    EXPECT_EQ(state(other)["ratings"], Json::object()) << "nobody sees another's";
    for (const auto& [bad, status] : std::vector<std::pair<std::string, int>>{
             {R"({"round": 1, "look": 412, "steps": [7]})", 400},
             {R"({"round": 1, "look": 412, "steps": [7, 8]})", 400},
             {R"({"round": 1, "look": 500, "steps": [7, 1]})", 400},
             {R"({"round": 2, "look": 412, "steps": [7, 1]})", 409}}) {
        EXPECT_EQ(rate(secret, bad).status, status) << bad;
    }
    auto foreign = request("PUT", "/scales", secret, body);
    foreign.origin = "http://evil.example";
    EXPECT_EQ(ask(foreign).status, 403);
    EXPECT_EQ(ask(request("GET", "/scales", secret)).status, 405);
    operators_.close_round(round);
    EXPECT_EQ(rate(secret, body).status, 409) << "too late";
    EXPECT_FALSE(state(secret).contains("scales"));
    const auto kept = operators_.ratings(round);
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(kept.begin()->second.at(0), (ScaleSteps{7, 1}));
    // A round that asks nothing of the kind
    open();
    ASSERT_EQ(vote(secret, R"({"round": 2, "best": 412, "second": 133})").status, 200);
    EXPECT_EQ(rate(secret, R"({"round": 2, "look": 412, "steps": [4]})").status, 400);
}

TEST_F(BallotServiceTest, ASeatIsKeptByItsCookieAlone) {
    const std::string secret = join();
    // The same phone scans once more.
    const auto again = ask(request("GET", "/join/" + invitation().token, secret));
    EXPECT_EQ(again.status, 303);
    EXPECT_FALSE(again.cookie);
    EXPECT_NE(join(), secret);
    EXPECT_NE(join(), "");
    EXPECT_EQ(operators_.seats(1).size(), 3u);
    // All seats are taken: back to the page, without one.
    EXPECT_EQ(join(), "");
    EXPECT_EQ(operators_.seats(1).size(), 3u);
    // Somebody else's cookie, a guess, an injection.
    for (const std::string& guess : {std::string(32, '0'),
                                     secret.substr(1) + "0",
                                     std::string("' OR key LIKE 'phone:%' --"),
                                     std::string("%")}) {
        EXPECT_EQ(state(guess)["seat"], 0) << guess;
        open();
        EXPECT_EQ(vote(guess, R"({"round": 1, "best": 907, "second": 560})").status, 401);
        operators_.close_round(operators_.open_round().value().id);
    }
    // The next audience: the old cookie is none.
    operators_.open_session();
    EXPECT_EQ(state(secret)["seat"], 0);
}

TEST_F(BallotServiceTest, ARestartKeepsSeatsTheQrCodeAndVotes) {
    const std::string secret = join();
    open();
    ASSERT_EQ(vote(secret, R"({"round": 1, "best": 907, "second": 560})").status, 200);
    const Json before = state(secret);
    const Invitation invited = invitation();
    BallotService other(file_, {{false, {"127.0.0.1:8470"}}, 3});
    other.keep_invitation(kNow + 1.0);
    EXPECT_EQ(Json::parse(other.answer(request("GET", "/state", secret), kNow).body), before);
    EXPECT_EQ(invitation().token, invited.token);
    EXPECT_EQ(invitation().code, invited.code);
}

TEST_F(BallotServiceTest, ARightCodeIsNeverRefusedAndExpires) {
    const auto join_with = [&](const std::string& code, double now, const std::string& client) {
        BallotRequest asked = request("POST", "/join", "", Json{{"code", code}}.dump());
        asked.client = client;
        return ask(asked, now);
    };
    const std::string code = invitation().code;
    const auto answer = join_with(code, kNow, "a");
    EXPECT_EQ(answer.status, 200);
    EXPECT_TRUE(answer.cookie);
    for (int client = 0; client < 100; ++client) {
        EXPECT_EQ(join_with("22222222", kNow, std::to_string(client)).status, 403);
        EXPECT_EQ(join_with("22222222", kNow, "b").status, 403);
    }
    EXPECT_EQ(join_with(code.substr(0, 4) + "-" + code.substr(4), kNow, "b").status, 200);
    EXPECT_EQ(join_with("", kNow, "g").status, 403);
    // Ten minutes later it is another one; whoever is typing has a minute more.
    EXPECT_EQ(join_with(code, kNow + 601.0, "c").status, 403);
    const std::string token = invitation().token;
    service_.keep_invitation(kNow + 601.0);
    EXPECT_NE(invitation().code, code);
    EXPECT_EQ(invitation().token, token) << "the QR code on the wall stays";
    EXPECT_EQ(join_with(invitation().code, kNow + 602.0, "d").status, 200);
    EXPECT_EQ(join_with(code, kNow + 659.0, "e").status, 200);
    EXPECT_EQ(join_with(code, kNow + 660.0, "f").status, 403);
    EXPECT_EQ(operators_.seats(1).size(), 4u);
    // The next audience has a code of its own at once.
    const std::string of_the_first = invitation().code;
    operators_.open_session();
    service_.keep_invitation(kNow + 661.0);
    EXPECT_EQ(join_with(of_the_first, kNow + 662.0, "e").status, 403);
}

TEST_F(BallotServiceTest, OnePhoneTakesNotAllSeats) {
    const auto join_from = [&](const std::string& client) {
        BallotRequest asked = request("GET", "/join/" + invitation().token);
        asked.client = client;
        return ask(asked).cookie.has_value();
    };
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(join_from("greedy"));
    for (int k = 0; k < 100; ++k) EXPECT_FALSE(join_from("greedy"));
    EXPECT_TRUE(join_from("honest"));
    EXPECT_TRUE(join_from("late"));
    EXPECT_FALSE(join_from("late")) << "a second phone there needs a free seat";
    EXPECT_EQ(operators_.seats(1).size(), 5u);
}

TEST_F(BallotServiceTest, ASeatChangesItsBallotAsOftenAsPeopleDo) {
    const std::string one = join(), other = join();
    open();
    int taken = 0, refused = 0;
    for (int k = 0; k < 1000; ++k) {
        const std::string best = k % 2 == 0 ? "907" : "412";
        const int status =
            vote(one, R"({"round": 1, "best": )" + best + R"(, "second": 560})").status;
        (status == 200 ? taken : refused) += 1;
        if (status != 200) {
            EXPECT_EQ(status, 429);
        }
    }
    EXPECT_EQ(taken, 60);
    EXPECT_EQ(refused, 940);
    EXPECT_EQ(vote(other, R"({"round": 1, "best": 907, "second": 560})").status, 200);
    const auto later =
        request("PUT", "/ballot", one, R"({"round": 1, "best": 133, "second": 560})");
    EXPECT_EQ(ask(later, kNow + 10.0).status, 200);
}

TEST_F(BallotServiceTest, JoiningClosesWhenARoundBegins) {
    open(true);
    EXPECT_EQ(join(), "");
    EXPECT_EQ(ask(request("POST", "/join", "", Json{{"code", invitation().code}}.dump())).status,
              409);
    EXPECT_TRUE(operators_.seats(1).empty());
    // Nor does a wrong token, nor a browser that looks ahead.
    operators_.close_round(1);
    EXPECT_EQ(ask(request("GET", "/join/" + std::string(32, '0'))).status, 403);
    EXPECT_EQ(ask(request("GET", "/join/")).status, 403);
    BallotRequest ahead = request("GET", "/join/" + invitation().token);
    ahead.purpose = "prefetch;prerender";
    EXPECT_EQ(ask(ahead).status, 403);
    EXPECT_EQ(ask(request("HEAD", "/join/" + invitation().token)).status, 405);
    EXPECT_TRUE(operators_.seats(1).empty());
}

TEST_F(BallotServiceTest, RefusesForgedRequestsAndStoresNothing) {
    const std::string secret = join();
    open();
    const std::string body = R"({"round": 1, "best": 907, "second": 560})";
    const auto status = [&](auto change) {
        BallotRequest forged = request("PUT", "/ballot", secret, body);
        change(forged);
        return ask(forged).status;
    };
    EXPECT_EQ(status([](BallotRequest& r) { r.host = "evil.example"; }), 421);
    EXPECT_EQ(status([](BallotRequest& r) { r.host = ""; }), 421);
    EXPECT_EQ(status([](BallotRequest& r) { r.origin = "http://evil.example"; }), 403);
    EXPECT_EQ(status([](BallotRequest& r) { r.origin = ""; }), 403);
    EXPECT_EQ(status([](BallotRequest& r) { r.origin = "null"; }), 403);
    EXPECT_EQ(status([](BallotRequest& r) { r.fetch_site = "cross-site"; }), 403);
    EXPECT_EQ(status([](BallotRequest& r) { r.content_type = "text/plain"; }), 415);
    EXPECT_EQ(status([](BallotRequest& r) { r.method = "POST"; }), 405);
    EXPECT_EQ(status([](BallotRequest& r) { r.cookies = ""; }), 401);
    EXPECT_EQ(status([](BallotRequest& r) { r.path = "/ballot/"; }), 404);
    EXPECT_EQ(status([](BallotRequest& r) { r.path = "/../ballots.sqlite"; }), 404);
    for (const char* wrong : {R"({"round": 1, "best": 907, "second": 907})",
                              R"({"round": 1, "best": 907, "second": 999})",
                              R"({"round": 1, "best": 907, "second": 560, "least": 133})",
                              R"({"round": 1, "best": "907'; DROP TABLE ballots", "second": 560})",
                              R"({"round": 1, "best": "<script>alert(1)</script>"})",
                              R"({"round": 1})",
                              ""}) {
        EXPECT_EQ(vote(secret, wrong).status, 400) << wrong;
    }
    EXPECT_EQ(vote(secret, R"({"round": 2, "best": 907, "second": 560})").status, 409);
    EXPECT_EQ(operators_.open_round().value().ballots, 0);
    EXPECT_EQ(operators_.seats(1).size(), 1u);
    EXPECT_NO_THROW(BallotStore{file_});
    // And the honest one is taken.
    EXPECT_EQ(vote(secret, body).status, 200);
}

TEST_F(BallotServiceTest, ServesThePageAndNothingElse) {
    EXPECT_NE(ask(request("GET", "/")).body.find("<!doctype html>"), std::string::npos);
    EXPECT_EQ(ask(request("GET", "/page.js")).content_type, "text/javascript; charset=utf-8");
    EXPECT_EQ(ask(request("GET", "/page.css")).content_type, "text/css; charset=utf-8");
    EXPECT_EQ(ask(request("POST", "/")).allow, "GET, HEAD");
    for (const char* path : {"", "/favicon.ico", "/page", "/page.js/", "//", "/state/", "/joint"}) {
        EXPECT_EQ(ask(request("GET", path)).status, 404) << path;
    }
}

TEST_F(BallotServiceTest, SaysWhenAVoteCouldNotBeKept) {
    const std::string secret = join();
    open();
    {
        Database other(file_, Database::Mode::existing, 0x4c765642, 5, ballots_schema());
        other.run(
            "CREATE TRIGGER ballot_lost BEFORE INSERT ON log "
            "BEGIN SELECT RAISE(ABORT, 'disk on fire'); END");
    }
    const auto answer = vote(secret, R"({"round": 1, "best": 907, "second": 560})");
    EXPECT_EQ(answer.status, 503);
    EXPECT_EQ(answer.body.find("fire"), std::string::npos) << "that is the operator's business";
    EXPECT_EQ(state(secret).count("ballot"), 0u);
}

TEST_F(BallotServiceTest, AsksForTheLeastWhereTheRoundDoes) {
    const std::string secret = join();
    open(false, true);
    EXPECT_EQ(state(secret)["least"], true);
    EXPECT_EQ(vote(secret, R"({"round": 1, "best": 907, "second": 560, "least": 907})").status,
              400);
    EXPECT_EQ(vote(secret, R"({"round": 1, "best": 907, "second": 560, "least": 133})").status,
              200);
    EXPECT_EQ(state(secret)["ballot"]["least"], 133);
}

}  // namespace
}  // namespace livery
