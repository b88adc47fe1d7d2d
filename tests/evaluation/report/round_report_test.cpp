// What is read of a round, from its ballots and from what stands beside it, and its report.
#include "evaluation/report/round_report.h"

#include <string>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "evaluation/ballots.h"
#include "evaluation/closed_round.h"
#include "evaluation/report/report_document.h"
#include "evaluation/report/round_details.h"
#include "evaluation/report/sample_votes.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

std::filesystem::path recorded_round(const TemporaryFolder& folder) {
    const auto file = folder / "votes.sqlite";
    BallotStore store(file);
    RoundSetup setup{{"red", "silver", "sand"}, "1234abcd", kCodes, 7};
    const int round = store.open_round(setup);
    for (int k = 0; k < 6; ++k) store.vote(round, "paper " + std::to_string(k + 1), {k % 2, 2});
    store.close_round(round);
    return file;
}

TEST(ClosedRound, HasWhatProvesARound) {
    const TemporaryFolder folder;
    const auto file = recorded_round(folder);
    const ClosedRound record = read_closed_round(file, {}, 1);
    EXPECT_EQ(record.file, "votes.sqlite");
    EXPECT_EQ(record.round.codes, kCodes);
    EXPECT_EQ(record.round.seed, 7);
    EXPECT_EQ(record.seats, 6);
    EXPECT_EQ(record.ballots.size(), 6u);
    EXPECT_EQ(record.round.voting_at.size(), 20u);
    EXPECT_EQ(record.round.closed_at.size(), 20u);
    const auto log = BallotStore(file).log();
    EXPECT_EQ(record.round.lock.hash, log.back().hash);
    EXPECT_EQ(record.round.lock.entry, log.back().id);
    // What comes later changes nothing of it.
    { BallotStore(file).open_round({"x", "y"}, ""); }
    EXPECT_EQ(read_closed_round(file, {}, 1).round.lock.hash, record.round.lock.hash);
}

RoundDetails parsed(const std::string& text) {
    return parse_round_details(text, "/somewhere/round.json", 1, kCodes);
}

TEST(RoundDetails, AreReadAndAbsentOnesAreNotInvented) {
    const RoundDetails details =
        parsed(R"({"format_version": 1, "kind": "round-details", "round": 1,
        "title": "Spring", "question": "Which would you buy?",
        "looks": [{"code": 376, "picture": "376.png",
                   "reachability": {"reachable_fraction": 0.93, "de00_median": 0.4}}],
        "showings": [{"at": "2026-11-24T10:00:00Z", "seats": [1, 2], "codes": [912, 376, 481]},
                     {"codes": [481, 912, 376]}]})");
    EXPECT_EQ(details.title, "Spring");
    ASSERT_EQ(details.looks.size(), 1u);
    EXPECT_EQ(details.looks[0].reachability->reachable_fraction, 0.93);
    EXPECT_FALSE(details.looks[0].reachability->de00_p95.has_value());
    ASSERT_EQ(details.showings.size(), 2u);
    EXPECT_EQ(details.showings[0].codes, (std::vector<int>{912, 376, 481}));
    EXPECT_TRUE(details.showings[1].seats.empty());
    EXPECT_EQ(details.folder, "/somewhere");
    const TemporaryFolder folder;
    EXPECT_TRUE(read_round_details(folder / "none.json", 1, kCodes).looks.empty());
    EXPECT_EQ(round_details_file("/a/votes.sqlite", 3), "/a/votes-round-3/round.json");
}

TEST(RoundDetails, BadOnesAreRefusedByField) {
    const auto refused = [](const std::string& members, const std::string& part) {
        const std::string text =
            R"({"format_version": 1, "kind": "round-details", "round": 1)" + members + "}";
        const std::string message = message_of([&] { parsed(text); });
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_NE(message.find("/somewhere/round.json"), std::string::npos) << message;
    };
    refused(R"(, "looks": [{"code": 111}])", "looks[0].code");
    refused(R"(, "looks": [{"code": 481}, {"code": 481}])", "looks[1].code");
    refused(R"(, "looks": [{"code": 481, "picture": "../481.png"}])", "looks[0].picture");
    refused(R"(, "looks": [{"code": 481, "picture": "/etc/passwd"}])", "looks[0].picture");
    refused(R"(, "looks": [{"code": 481, "reachability": {"reachable_fraction": 1.5}}])",
            "looks[0].reachability.reachable_fraction");
    refused(R"(, "looks": [{"code": 481, "reachability": {"reach": 1}}])", "reach");
    refused(R"(, "showings": [{"codes": [481, 500]}])", "showings[0].codes[1]");
    refused(R"(, "showings": [{"seats": [0], "codes": [481]}])", "showings[0].seats[0]");
    refused(R"(, "titel": "x")", "titel");
    refused(R"(, "title": "a\nb")", "title");
    EXPECT_NE(message_of([] { parsed("{}"); }).find("format_version"), std::string::npos);
    EXPECT_NE(message_of([] {
                  parse_round_details(
                      R"({"format_version": 1, "kind": "round-details", "round": 2})",
                      "r.json",
                      1,
                      kCodes);
              }).find("round 1"),
              std::string::npos);
}

TEST(RoundReport, TellsWhatItHasAndSaysWhatItHasNot) {
    const TemporaryFolder folder;
    const auto file = recorded_round(folder);
    write_png(folder / "a.png", Image8(900, 40, 3, std::uint8_t{90}));
    RoundReportSource source;
    source.record = read_closed_round(file, {}, 1);
    source.names = source.record->round.designs;
    source.statistics = vote_statistics(
        counts_of(source.record->ballots, 3, false), source.names, 1, &source.record->ballots, 20);
    source.details.folder = folder.path();
    source.details.note = "A note.";
    LookReachability reach;
    reach.reachable_fraction = 0.93;
    source.details.looks = {{376, "a.png", reach}};
    source.details.showings = {{"2026-11-24T10:00:00Z", {1, 2}, {912, 376, 481}}};
    const std::string html = html_of(round_report(source));
    for (const std::string& part : std::vector<std::string>{source.record->round.lock.hash,
                                                            "1234abcd",
                                                            "912, 376, 481",
                                                            "93%",
                                                            "not recorded",
                                                            "B silver, shown as 376",
                                                            "A note.",
                                                            "width=\"600\" height=\"27\""}) {
        EXPECT_NE(html.find(part), std::string::npos) << part;
    }
    EXPECT_EQ(html.find("paper 1"), std::string::npos) << "nobody is named";
    source.details.looks[0].picture = "none.png";
    EXPECT_NE(message_of([&] { round_report(source); }).find("none.png"), std::string::npos);
    write_exr(folder / "a.exr", ImageF(4, 4, 3));
    EXPECT_NE(message_of([&] { read_report_picture(folder / "a.exr"); }).find("floating-point"),
              std::string::npos);
}

RoundDetails some_details() {
    RoundDetails details;
    details.eye = RoundEye{
        "in the mean of 1 seat",
        {-400.0, 480.0, 1.0 / 3.0},
        {{1, {-400.0, 480.0, 1.0 / 3.0}, true, {{376, 0.25, 1.5, 0.01}, {912, 0.5, 11.2, 0.24}}},
         {4, {400.0, 480.0, 900.0}, false, {}}}};
    return details;
}

TEST(RoundEye, IsReadAsWritten) {
    const TemporaryFolder folder;
    const auto file = folder / "round.json";
    const RoundDetails details = some_details();
    write_round_details(file, 1, details);
    EXPECT_EQ(read_round_details(file, 1, kCodes).eye, details.eye);
    // Without one the file is as it was before there was any.
    write_round_details(file, 1, {});
    EXPECT_FALSE(read_round_details(file, 1, kCodes).eye);
}

TEST(RoundEye, BadOnesAreRefusedByField) {
    const auto refused = [](const std::string& seats, const std::string& field) {
        const std::string text =
            R"({"format_version": 2, "kind": "round-details", "round": 1, "eye": )"
            R"({"of": "set by hand", "eye_mm": [1, 2, 3], "seats": )" +
            seats + "}}";
        const std::string message =
            message_of([&] { parse_round_details(text, "r.json", 1, kCodes); });
        EXPECT_NE(message.find(field), std::string::npos) << message;
    };
    const std::string place = R"("eye_mm": [1, 2, 3])";
    refused(R"([{"seat": 0, )" + place + "}]", "eye.seats[0].seat");
    refused(R"([{"seat": 1, "eye_mm": [1, 2]}])", "eye.seats[0].eye_mm");
    refused(R"([{"seat": 1, )" + place + R"(}, {"seat": 1, )" + place + "}]", "eye.seats[1].seat");
    const auto with_look = [&](const std::string& look) {
        return R"([{"seat": 1, )" + place + R"(, "looks": [)" + look + "]}]";
    };
    const std::string figures = R"("de00_median": 1, "de00_p95": 2, "share_over_3": 0.5})";
    refused(with_look(R"({"code": 500, )" + figures), "looks[0].code");
    refused(with_look(R"({"code": 481, )" + figures + R"(, {"code": 481, )" + figures),
            "looks[1].code");
    refused(with_look(R"({"code": 481, "de00_median": 1, "de00_p95": 2, "share_over_3": 1.5})"),
            "share_over_3");
    refused(with_look(R"({"code": 481, "de00_median": -1, "de00_p95": 2, "share_over_3": 0})"),
            "de00_median");
    refused(R"({"seat": 1})", "eye.seats");
}

TEST(RoundEye, IsInTheReportWithWhatEachSeatMissed) {
    RoundReportSource source = source_of(table3(), {"red", "silver", "sand", "blue"}, 50);
    EXPECT_NE(
        html_of(round_report(source)).find("Whose eye highlights were drawn for: not recorded"),
        std::string::npos);
    source.record.emplace();
    source.record->round.codes = {481, 376, 912, 555};
    source.details.eye = some_details().eye;
    const std::string html = html_of(round_report(source));
    for (const char* part : {"in the mean of 1 seat, at x -400, y 480, z 0 mm",
                             "What each seat missed",
                             ">11.2<",
                             ">24%<",
                             "4, does not count",
                             "400, 480, 900"}) {
        EXPECT_NE(html.find(part), std::string::npos) << part;
    }
}

}  // namespace
}  // namespace livery
