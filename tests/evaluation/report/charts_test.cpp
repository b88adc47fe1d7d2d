// The charts: their words are whole, and what they show is what the figures say.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/report/round_report.h"
#include "evaluation/report/sample_votes.h"

namespace livery {
namespace {

std::vector<ReportChart> charts_of(const VoteStatistics& statistics, const ChartRows& rows) {
    std::vector<ReportChart> charts = {votes_chart(statistics, rows),
                                       rank_sum_chart(statistics, rows),
                                       worths_chart(statistics, rows),
                                       pairs_chart(statistics, rows),
                                       first_chart(statistics, rows)};
    if (!statistics.power.empty())
        charts.push_back(power_chart(statistics, statistics.power, rows));
    return charts;
}

/// Marks outside the drawing: text by its widest estimate.
std::vector<std::string> outside(const ReportChart& chart) {
    std::vector<std::string> found;
    const auto check = [&](double x, double y, const std::string& what) {
        const bool within = std::isfinite(x) && std::isfinite(y) && x >= -0.6 &&
                            x <= chart.drawing.width + 0.6 && y >= -0.6 &&
                            y <= chart.drawing.height + 0.6;
        if (!within) found.push_back(chart.title + ": " + what);
    };
    for (const auto& mark : chart.drawing.marks) {
        if (const auto* text = std::get_if<DrawnText>(&mark)) {
            const double width = estimated_width(text->text, text->size, text->bold);
            const double left = text->anchor == TextAnchor::start    ? text->at.x
                                : text->anchor == TextAnchor::middle ? text->at.x - 0.5 * width
                                                                     : text->at.x - width;
            check(left, text->at.y - text->size, text->text);
            check(left + width, text->at.y + 0.25 * text->size, text->text);
        } else if (const auto* line = std::get_if<DrawnLine>(&mark)) {
            check(line->from.x, line->from.y, "a line");
            check(line->to.x, line->to.y, "a line");
        } else if (const auto* shape = std::get_if<DrawnShape>(&mark)) {
            for (const DrawingPoint& point : shape->points) check(point.x, point.y, "a shape");
        } else if (const auto* dot = std::get_if<DrawnDot>(&mark)) {
            check(dot->centre.x, dot->centre.y, "a dot");
        }
    }
    return found;
}

TEST(Charts, CutNothingWhateverIsVotedOn) {
    for (const int designs : {2, 3, 4, 9, 26}) {
        for (const int evaluators : {1, 2, 10, 300}) {
            for (const bool least : {false, true}) {
                if (least && designs < 3) continue;
                // Drawing so many takes seconds, and only the numbers' width changes.
                if (evaluators > 10 && designs > 4) continue;
                const VoteCounts counts = round_robin(designs, evaluators, least);
                std::vector<std::string> names = default_names(designs);
                names[0] = "A name of many words, such as marketing gives to a paint";
                names[1] = std::string(120, 'M');
                const VoteStatistics statistics = vote_statistics(counts, names, 1, nullptr, 4);
                for (const ReportChart& chart :
                     charts_of(statistics, chart_rows(statistics, names))) {
                    EXPECT_TRUE(outside(chart).empty())
                        << outside(chart).front() << " of " << designs << " designs, " << evaluators
                        << " evaluators";
                    EXPECT_FALSE(chart.alternative.empty());
                    EXPECT_FALSE(chart.note.empty());
                }
            }
        }
    }
}

TEST(Charts, HaveOneOrderAndLettersOfTheRound) {
    const std::vector<std::string> names = {"red", "silver", "sand", "blue"};
    const VoteStatistics statistics = vote_statistics(table3(), names, 1, nullptr, 4);
    const ChartRows rows = chart_rows(statistics, names);
    EXPECT_EQ(rows.order, (std::vector<int>{1, 3, 2, 0}));
    EXPECT_EQ(rows.labels[1], "B silver");
    EXPECT_EQ(rows.keys[3], "D");
    const ChartRows letters = chart_rows(statistics, default_names(4));
    EXPECT_EQ(letters.labels[1], "(b)");
}

TEST(Charts, SayTheFiguresForWhoDoesNotSeeThem) {
    const std::vector<std::string> names = {"red", "silver", "sand", "blue"};
    const VoteStatistics statistics = vote_statistics(table3(), names, 1, nullptr, 4);
    const ChartRows rows = chart_rows(statistics, names);
    const auto has = [](const ReportChart& chart, const std::string& part) {
        EXPECT_NE(chart.alternative.find(part), std::string::npos) << chart.alternative;
    };
    has(votes_chart(statistics, rows), "B silver: best 6, second best 3;");
    has(rank_sum_chart(statistics, rows), "B silver: 15.5; D blue: 22.5;");
    // Odds of b over d are 2.37 [0.736, 8.69]: the other way round their inverses.
    has(worths_chart(statistics, rows), "D blue: 0.42 [0.12, 1.36]");
    has(worths_chart(statistics, rows), "B silver: leader: 1");
    has(first_chart(statistics, rows), "B silver: 80%");
}

TEST(Charts, NothingIsToldApartWithoutAPreference) {
    const VoteStatistics even =
        vote_statistics({{2, 2, 1}, {1, 2, 2}}, default_names(3), 1, nullptr, 4);
    const std::string note = rank_sum_chart(even, chart_rows(even, default_names(3))).note;
    EXPECT_NE(note.find("no preference"), std::string::npos) << note;
    EXPECT_EQ(note.find("Hollow"), std::string::npos) << note;
}

TEST(Charts, MarkWhatTheVerdictTellsApartAndNothingElse) {
    const auto hollow = [](const ReportChart& chart) {
        return std::count_if(
            chart.drawing.marks.begin(), chart.drawing.marks.end(), [](const auto& item) {
                const auto* dot = std::get_if<DrawnDot>(&item);
                return dot && dot->stroke.has_value();
            });
    };
    struct Round {
        VoteCounts counts;
        VerdictKind kind;
        int apart;
    };
    for (const Round& round : {Round{table3(), VerdictKind::leading, 2},
                               Round{{{16, 4, 0, 0}, {4, 15, 1, 0}}, VerdictKind::clear_winner, 3},
                               Round{{{2, 2, 1}, {1, 2, 2}}, VerdictKind::no_preference, 0}}) {
        const auto names = default_names(round.counts.designs());
        const VoteStatistics statistics = vote_statistics(round.counts, names, 1, nullptr, 4);
        const ChartRows rows = chart_rows(statistics, names);
        EXPECT_EQ(statistics.verdict.kind, round.kind) << statistics.words;
        EXPECT_EQ(hollow(rank_sum_chart(statistics, rows)), round.apart) << statistics.words;
        EXPECT_EQ(hollow(worths_chart(statistics, rows)), round.apart) << statistics.words;
    }
}

TEST(PowerCurve, RisesThroughThisRoundAndItsMultiples) {
    const VoteStatistics statistics = vote_statistics(table3(), default_names(4), 1, nullptr, 400);
    const auto curve = power_curve(statistics, 300);
    ASSERT_GE(curve.size(), 6u);
    for (std::size_t k = 1; k < curve.size(); ++k) {
        EXPECT_GT(curve[k].evaluators, curve[k - 1].evaluators);
        // Drawn: a little less may come of more.
        EXPECT_GT(curve[k].power, curve[k - 1].power - 0.06);
    }
    for (const auto& own : statistics.power) {
        EXPECT_TRUE(std::any_of(curve.begin(), curve.end(), [&](const auto& point) {
            return point.evaluators == own.evaluators && point.power == own.power;
        })) << own.evaluators;
    }
    EXPECT_GE(curve.back().evaluators, statistics.evaluators_needed.value());
    const VoteStatistics one = vote_statistics({{0, 1, 0}, {1, 0, 0}}, default_names(3), 1);
    EXPECT_TRUE(power_curve(one).empty());
}

TEST(Wrapping, KeepsWordsWholeAndSaysWhereItStops) {
    EXPECT_EQ(wrapped("red", 9.0, 100.0, 2), (std::vector<std::string>{"red"}));
    const auto two = wrapped("metallic silver grey", 9.0, 70.0, 3);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0] + " " + two[1], "metallic silver grey");
    const auto cut = wrapped(std::string(300, 'x'), 9.0, 70.0, 2);
    ASSERT_EQ(cut.size(), 2u);
    EXPECT_TRUE(cut[1].ends_with("…")) << cut[1];
    for (const std::string& line : cut) EXPECT_LE(estimated_width(line, 9.0), 70.0) << line;
    EXPECT_TRUE(wrapped("", 9.0, 70.0, 2).empty());
    // No width at all holds a letter; it is set all the same.
    EXPECT_EQ(wrapped("ab", 9.0, 0.0, 5).size(), 2u);
}

TEST(Hatch, StaysWithinItsBox) {
    for (const auto& [width, height] : {std::pair{3.0, 20.0}, {120.0, 9.0}, {0.5, 0.5}}) {
        VectorDrawing drawing;
        hatch(drawing, 10.0, 20.0, width, height, kWarmColour);
        for (const auto& mark : drawing.marks) {
            const auto& line = std::get<DrawnLine>(mark);
            for (const DrawingPoint& point : {line.from, line.to}) {
                EXPECT_GE(point.x, 10.0 - 1e-9);
                EXPECT_LE(point.x, 10.0 + width + 1e-9);
                EXPECT_GE(point.y, 20.0 - 1e-9);
                EXPECT_LE(point.y, 20.0 + height + 1e-9);
            }
        }
    }
}

}  // namespace
}  // namespace livery
