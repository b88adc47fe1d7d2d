// Whose eye a round was shaded for, beside its ballots and in its report.

#include "evaluation/report/round_eye.h"

#include <gtest/gtest.h>

#include "evaluation/report/html_report.h"
#include "evaluation/report/round_report.h"
#include "evaluation/report/sample_votes.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

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
