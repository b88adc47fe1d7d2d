#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "evaluation/report/round_report.h"
#include "evaluation/statistics/figures.h"

namespace livery {

namespace {

std::string share_text(int count, int of, const Interval& interval) {
    if (of == 0) return "none";
    return fmt::format("{} [{}, {}]",
                       percent_text(static_cast<double>(count) / of),
                       percent_text(interval.low),
                       percent_text(interval.high));
}

std::string recorded(const std::string& text) { return text.empty() ? kNotRecorded : text; }

std::string optional_text(const std::optional<double>& value, const char* format) {
    return value ? fmt::format(fmt::runtime(format), *value) : "none";
}

bool told_apart(const VoteStatistics& statistics, int a, int b) {
    return std::any_of(statistics.apart.begin(), statistics.apart.end(), [&](const auto& two) {
        return std::minmax(two.first, two.second) == std::minmax(a, b);
    });
}

}  // namespace

ReportTable votes_table(const VoteStatistics& statistics, const ChartRows& rows) {
    const VoteCounts& counts = statistics.counts;
    ReportTable table{"Votes, with 95% intervals of shares", {{"Design", false}}, {}};
    for (const char* title : {"Best", "Second"}) table.columns.push_back({title});
    if (counts.has_least()) table.columns.push_back({"Least"});
    for (const char* title : {"Rank sum", "Borda", "Share of best", "Best or second"}) {
        table.columns.push_back({title});
    }
    for (const int design : rows.order) {
        const auto k = static_cast<std::size_t>(design);
        std::vector<std::string> row = {
            rows.labels[k], std::to_string(counts.best[k]), std::to_string(counts.second[k])};
        if (counts.has_least()) row.push_back(std::to_string(counts.least[k]));
        row.push_back(fmt::format("{:.1f}", statistics.rank_sums[k]));
        row.push_back(std::to_string(statistics.borda[k]));
        row.push_back(share_text(counts.best[k], statistics.evaluators, statistics.share_best[k]));
        row.push_back(share_text(
            counts.best[k] + counts.second[k], statistics.evaluators, statistics.share_named[k]));
        table.rows.push_back(std::move(row));
    }
    table.note = "Borda: 2 for best, 1 for second best. Intervals of shares: Wilson.";
    return table;
}

ReportTable worths_table(const VoteStatistics& statistics, const ChartRows& rows) {
    ReportTable table{
        "Worths, and who would be first",
        {{"Design", false}, {"Worth"}, {"First among others"}, {"First at these worths"}},
        {}};
    if (statistics.resampled) table.columns.push_back({"First, ballots drawn again"});
    for (const int design : rows.order) {
        const auto k = static_cast<std::size_t>(design);
        std::vector<std::string> row = {rows.labels[k],
                                        fmt::format("{:.3f}", statistics.worths[k]),
                                        fmt::format("{:.3f}", statistics.predicted.first[k]),
                                        fmt::format("{:.3f}", statistics.wins.first[k])};
        if (statistics.resampled) {
            row.push_back(fmt::format("{:.3f}", statistics.resampled->first[k]));
        }
        table.rows.push_back(std::move(row));
    }
    table.note =
        "Worths are Plackett and Luce's and add up to 1: the chance of each to be named best.";
    if (statistics.ghost) {
        table.note +=
            " They are fitted with half a win and half a loss of each design against a "
            "ghost, since a design has no vote or one has all for best.";
        table.note += kGhostIntervals;
    }
    if (statistics.pairs_expected) {
        table.note +=
            " The counts do not tell which best went with which second best; the evenest "
            "way is taken.";
    }
    return table;
}

ReportTable tests_table(const VoteStatistics& statistics, const ChartRows& rows) {
    ReportTable table{"Tests and agreement",
                      {{"What", false}, {"Figure"}, {"p"}, {"p, asymptotic"}, {"How", false}},
                      {}};
    const auto add = [&](std::vector<std::string> row) { table.rows.push_back(std::move(row)); };
    const BestVotesTest& best = statistics.best_votes;
    add({"Votes for best against equal preference",
         fmt::format("chi-square {:.2f}", best.chi_square),
         p_text(best.p),
         p_text(best.asymptotic_p),
         method_text(best.method, best.cases)});
    add({"Any preference, by all votes",
         fmt::format("Friedman's Q {:.2f}", statistics.friedman_q),
         p_text(statistics.friedman_p),
         p_text(statistics.friedman_asymptotic_p),
         method_text(statistics.friedman_method, statistics.friedman_cases)});
    add({"Agreement",
         "Kendall's W " + optional_text(statistics.kendall_w, "{:.3f}"),
         "",
         "",
         "0 none, 1 all the same"});
    add({"Agreement beyond chance",
         "alpha " + optional_text(statistics.krippendorff_alpha, "{:.3f}"),
         "",
         "",
         "Krippendorff; below 0 is opposition"});
    add({"Rank sums tell two designs apart",
         statistics.range_threshold ? fmt::format("from {:.1f} on", *statistics.range_threshold)
                                    : "never",
         "",
         "",
         "5% over all pairs at once"});
    const Verdict& verdict = statistics.verdict;
    if (verdict.leader >= 0 && statistics.evaluators > 1) {
        const auto label = [&](int k) { return rows.labels[static_cast<std::size_t>(k)]; };
        // Where no preference is shown nobody is judged to lead.
        if (verdict.kind != VerdictKind::no_preference) {
            add({fmt::format(
                     "{} against {}, by its own law", label(verdict.leader), label(verdict.rival)),
                 "likelihood ratio",
                 verdict.rival_p >= 1.0 ? "not asked for" : p_text(verdict.rival_p),
                 "",
                 "drawn at equal worths; a clear winner needs .04"});
            add({"The leader is first in rounds of other evaluators",
                 percent_text(verdict.win_probability),
                 "",
                 "",
                 method_text(statistics.predicted.method, statistics.predicted.cases)});
        }
        add({fmt::format("{} and {} are the top two again",
                         label(statistics.top_a),
                         label(statistics.top_b)),
             percent_text(statistics.wins.top_two),
             "",
             "",
             method_text(statistics.wins.method, statistics.wins.cases)});
        if (statistics.resampled) {
            add({"The same, ballots drawn again",
                 percent_text(statistics.resampled->top_two),
                 "",
                 "",
                 method_text(statistics.resampled->method, statistics.resampled->cases)});
        }
    }
    return table;
}

ReportTable pairs_table(const VoteStatistics& statistics, const ChartRows& rows) {
    ReportTable table{"Pairs",
                      {{"Pair", false},
                       {"Odds"},
                       {"95% profile"},
                       {"p"},
                       {"95% Wald"},
                       {"Wald p"},
                       {"Rank sums differ"},
                       {"Told apart"}},
                      {}};
    for (const PairComparison& pair : statistics.pairs) {
        const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
        table.rows.push_back(
            {rows.labels[a] + " to " + rows.labels[b],
             odds_text(pair.odds),
             fmt::format("{} to {}", odds_text(pair.low), odds_text(pair.high)),
             p_text(pair.p),
             fmt::format("{} to {}", odds_text(pair.wald_low), odds_text(pair.wald_high)),
             p_text(pair.wald_p),
             fmt::format("{:.1f}", statistics.rank_sums[a] - statistics.rank_sums[b]),
             told_apart(statistics, pair.a, pair.b) ? "yes" : "no"});
    }
    table.note =
        "Odds: the first's worth over the second's; p by the likelihood ratio, each pair by "
        "itself: "
        "among six pairs one round in four has one below .05 by chance. Wald's, from the curvature "
        "at the maximum, stands for comparison. Told apart: by rank sums, at 5% over all pairs.";
    return table;
}

ReportTable power_table(const VoteStatistics& statistics,
                        const std::vector<VoteStatistics::Power>& curve) {
    ReportTable table{
        "Fresh rounds that would tell", {{"Evaluators", false}, {"Of rounds"}, {"Drawn"}}, {}};
    for (const auto& point : curve) {
        const bool stated =
            std::any_of(statistics.power.begin(), statistics.power.end(), [&](const auto& own) {
                return own.evaluators == point.evaluators;
            });
        table.rows.push_back({std::to_string(point.evaluators),
                              percent_text(point.power),
                              std::to_string(stated ? statistics.power_rounds : kCurveRounds)});
    }
    return table;
}

ReportTable designs_table(const RoundReportSource& source, const ChartRows& rows) {
    ReportTable table{
        "Designs",
        {{"Design", false}, {"Code"}, {"Within reach"}, {"CIEDE2000, median"}, {"95th percentile"}},
        {}};
    for (std::size_t k = 0; k < source.names.size(); ++k) {
        const int code = source.record && k < source.record->round.codes.size()
                             ? source.record->round.codes[k]
                             : 0;
        LookReachability reach;
        for (const LookDetails& look : source.details.looks) {
            if (code != 0 && look.code == code && look.reachability) reach = *look.reachability;
        }
        const auto number = [](const std::optional<double>& value) {
            return value ? fmt::format("{:.2f}", *value) : std::string(kNotRecorded);
        };
        table.rows.push_back(
            {rows.labels[k],
             code != 0 ? std::to_string(code) : kNotRecorded,
             reach.reachable_fraction ? percent_text(*reach.reachable_fraction) : kNotRecorded,
             number(reach.de00_median),
             number(reach.de00_p95)});
    }
    table.note =
        "Within reach: how much of the look the projector can show as it is wanted. CIEDE2000: "
        "what "
        "was shown against what was wanted; 1 is about what can be seen side by side.";
    return table;
}

ReportTable showings_table(const RoundReportSource& source) {
    ReportTable table{"Who saw which order, and when",
                      {{"When", false}, {"Seats", false}, {"Codes in the order shown", false}},
                      {}};
    const bool by_log = source.details.showings.empty() && source.record;
    for (const LookShowing& showing : by_log ? source.record->showings : source.details.showings) {
        table.rows.push_back({recorded(showing.at),
                              showing.seats.empty()
                                  ? kNotRecorded
                                  : fmt::format("{}", fmt::join(showing.seats, ", ")),
                              fmt::format("{}", fmt::join(showing.codes, ", "))});
    }
    return table;
}

ReportTable seats_table(const RoundReportSource& source, const ChartRows& rows) {
    ReportTable table{"What each seat missed",
                      {{"Seat", false},
                       {"Eye, mm", false},
                       {"Design", false},
                       {"Median"},
                       {"95% within"},
                       {"Over 3"}},
                      {}};
    for (const RoundSeat& seat : source.details.eye->seats) {
        const std::string name =
            fmt::format("{}{}", seat.seat, seat.counts ? "" : ", does not count");
        const glm::dvec3& eye_mm = seat.eye_mm;
        const std::string where =
            fmt::format("{:.0f}, {:.0f}, {:.0f}", eye_mm.x, eye_mm.y, eye_mm.z);
        if (seat.looks.empty()) {
            table.rows.push_back({name, where, kNotRecorded, "", "", ""});
            continue;
        }
        for (const int design : rows.order) {
            const auto k = static_cast<std::size_t>(design);
            const int code = source.record && k < source.record->round.codes.size()
                                 ? source.record->round.codes[k]
                                 : 0;
            const auto miss = std::find_if(seat.looks.begin(),
                                           seat.looks.end(),
                                           [&](const SeatMiss& one) { return one.code == code; });
            if (miss == seat.looks.end()) continue;
            table.rows.push_back({name,
                                  where,
                                  rows.labels[k],
                                  fmt::format("{:.1f}", miss->de00_median),
                                  fmt::format("{:.1f}", miss->de00_p95),
                                  percent_text(miss->share_over_3)});
        }
    }
    table.note =
        "CIEDE2000 of what was projected to what this seat should have seen, at design white; over "
        "3 differences become hard to overlook.";
    return table;
}

ReportTable scale_means_table(const ScaleStatistics& statistics, const ChartRows& rows) {
    ReportTable table{"Mean steps, with 95% intervals", {{"Design", false}}, {}};
    for (const ScaleFigures& figures : statistics.scales) {
        table.columns.push_back({in_words(figures.scale)});
    }
    for (const int design : rows.order) {
        const auto k = static_cast<std::size_t>(design);
        std::vector<std::string> row = {rows.labels[k]};
        for (const ScaleFigures& figures : statistics.scales) {
            const LookOnScale& look = figures.looks[k];
            row.push_back(look.answers == 0 ? "none"
                                            : fmt::format("{:.2f} [{:.2f}, {:.2f}] of {}",
                                                          look.mean,
                                                          look.interval.low,
                                                          look.interval.high,
                                                          look.answers));
        }
        table.rows.push_back(std::move(row));
    }
    table.note =
        "Intervals: expanded percentiles of means over evaluators drawn again; of fewer than eight "
        "they are all of 1 to 7. "
        "Each holds for one look on one scale, not for differences between looks.";
    return table;
}

ReportTable scale_tests_table(const ScaleStatistics& statistics) {
    ReportTable table{
        "Whether looks differ",
        {{"Scale", false}, {"Placed all looks"}, {"Friedman's Q"}, {"p"}, {"p, Holm"}},
        {}};
    for (const ScaleFigures& figures : statistics.scales) {
        const bool tested = figures.complete > 0;
        table.rows.push_back({in_words(figures.scale),
                              std::to_string(figures.complete),
                              tested ? fmt::format("{:.2f}", figures.friedman_q) : "none",
                              tested ? p_text(figures.friedman_p) : "none",
                              tested ? p_text(figures.holm_p) : "none"});
    }
    table.note = fmt::format(
        "Friedman's test over the evaluators who placed every look, with ties; p over {} drawn "
        "orders of each evaluator's steps, seed {}. Holm's correction is over the scales.",
        statistics.draws,
        statistics.seed);
    return table;
}

ReportTable duel_repeats_table(const DuelRecord& duel) {
    ReportTable table{"The repeats", {{"Repeat", false}, {"Round"}}, {}};
    for (const std::string& design : duel.series.designs) table.columns.push_back({design});
    for (std::size_t k = 0; k < duel.votes.size(); ++k) {
        table.rows.push_back({std::to_string(k + 1),
                              std::to_string(duel.series.rounds[k]),
                              std::to_string(duel.votes[k][0]),
                              std::to_string(duel.votes[k][1])});
    }
    table.note =
        "Repeats are not added up: answers of one person are no independent ones. Each evaluator "
        "counts once, by the majority of the repeats.";
    return table;
}

ReportTable duel_tests_table(const DuelRecord& duel) {
    const DuelStatistics& statistics = duel.statistics;
    const int counted = statistics.majorities[0] + statistics.majorities[1];
    const auto ahead = static_cast<std::size_t>(statistics.ahead);
    ReportTable table{
        "The duel", {{"What", false}, {"Count"}, {"Share, 95%"}, {"p"}, {"How", false}}, {}};
    table.rows.push_back({"Evaluators who chose " + duel.series.designs[ahead] + " most often",
                          fmt::format("{} of {}", statistics.majorities[ahead], counted),
                          share_text(statistics.majorities[ahead], counted, statistics.share),
                          p_text(statistics.sign_p),
                          "sign test, two-sided, exact"});
    table.rows.push_back(
        {"The same answer in every repeat",
         fmt::format("{} of {}", statistics.consistent, statistics.complete),
         share_text(statistics.consistent, statistics.complete, statistics.consistent_share),
         p_text(statistics.consistency_p),
         fmt::format("as many or more by guessing, which gives {}; exact",
                     percent_text(statistics.consistent_by_guessing))});
    table.rows.push_back(
        {"Did not answer every repeat",
         std::to_string(statistics.incomplete),
         "",
         "",
         fmt::format("{} of them with a majority all the same", statistics.incomplete_counted)});
    return table;
}

ReportTable record_table(const RoundReportSource& source) {
    ReportTable table{"What proves it", {{"What", false}, {"Record", false}}, {}};
    const auto add = [&](const std::string& what, const std::string& value) {
        table.rows.push_back({what, value});
    };
    if (source.record) {
        const ClosedRound& record = *source.record;
        add("File of ballots", record.file);
        add("Round", fmt::format("{}, of session {}", record.round.id, record.round.session));
        add("Opened", record.round.created);
        add("Votes from", recorded(record.round.voting_at));
        add("Locked", recorded(record.round.closed_at));
        add("Seats of the session", std::to_string(record.seats));
        add("Ballots", std::to_string(record.ballots.size()));
        add("Seed of the codes", std::to_string(record.round.seed));
        add("Hash of the log",
            record.round.lock.hash.empty()
                ? kNotRecorded
                : fmt::format("{}, of entry {}, which locked the round: over it and all before it",
                              record.round.lock.hash,
                              record.round.lock.entry));
    } else {
        add("Ballots", "counts that were typed in: no file, no log");
    }
    add("Seed of what is drawn", std::to_string(source.statistics.seed));
    add("Program", source.program);
    add("Made", source.made_at);
    return table;
}

}  // namespace livery
