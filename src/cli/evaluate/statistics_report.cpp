#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "cli/evaluate/commands.h"
#include "evaluation/statistics/figures.h"

namespace livery {

namespace {

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json json_of(const std::vector<Interval>& intervals, const std::vector<double>& shares) {
    Json json = Json::array();
    for (std::size_t i = 0; i < intervals.size(); ++i) {
        json.push_back(
            {{"share", shares[i]}, {"low", intervals[i].low}, {"high", intervals[i].high}});
    }
    return json;
}

Json shares_of(const VoteStatistics& statistics) {
    const double evaluators = std::max(1, statistics.evaluators);
    std::vector<double> best, named;
    for (std::size_t i = 0; i < statistics.counts.best.size(); ++i) {
        best.push_back(statistics.counts.best[i] / evaluators);
        named.push_back((statistics.counts.best[i] + statistics.counts.second[i]) / evaluators);
    }
    return {{"best", json_of(statistics.share_best, best)},
            {"best_or_second", json_of(statistics.share_named, named)}};
}

Json pairs_of(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    Json pairs = Json::array();
    for (const PairComparison& pair : statistics.pairs) {
        const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
        const bool apart =
            std::any_of(statistics.apart.begin(), statistics.apart.end(), [&](const auto& two) {
                return std::minmax(two.first, two.second) == std::minmax(pair.a, pair.b);
            });
        pairs.push_back({{"a", pair.a},
                         {"b", pair.b},
                         {"name_a", names[a]},
                         {"name_b", names[b]},
                         {"odds", pair.odds},
                         {"low", pair.low},
                         {"high", pair.high},
                         {"p", pair.p},
                         {"wald_low", pair.wald_low},
                         {"wald_high", pair.wald_high},
                         {"wald_p", pair.wald_p},
                         {"rank_sum_difference", statistics.rank_sums[a] - statistics.rank_sums[b]},
                         {"apart", apart}});
    }
    return pairs;
}

Json json_of(const WinProbabilities& wins) {
    return {{"p_first", wins.first},
            {"p_top_two", wins.top_two},
            {"method", to_string(wins.method)},
            {"cases", wins.cases}};
}

Json power_of(const VoteStatistics& statistics) {
    Json power = {{"a", statistics.verdict.leader},
                  {"b", statistics.verdict.rival},
                  {"rounds", Json::array()},
                  {"draws", statistics.power_rounds},
                  {"evaluators_for_80_percent",
                   statistics.evaluators_needed ? Json(*statistics.evaluators_needed) : Json()}};
    for (const auto& round : statistics.power) {
        power["rounds"].push_back({{"evaluators", round.evaluators}, {"power", round.power}});
    }
    return power;
}

Json verdict_of(const VoteStatistics& statistics) {
    const Verdict& verdict = statistics.verdict;
    const bool has_leader = verdict.leader >= 0;
    Json json = {{"kind", to_string(verdict.kind)},
                 {"leader", has_leader ? Json(verdict.leader) : Json()},
                 {"rival", has_leader ? Json(verdict.rival) : Json()},
                 {"not_separated", verdict.not_apart},
                 {"p_win", verdict.win_probability},
                 {"p_win_from", statistics.resampled ? "single ballots" : "fitted worths"},
                 {"calibrated_p", verdict.rival_p}};
    return json;
}

/// The order of the report; a terminal's tables have the designs' names alone.
ChartRows text_rows(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    ChartRows rows = chart_rows(statistics, names);
    rows.labels = names;
    return rows;
}

}  // namespace

Json figures_of(const ScaleStatistics& statistics) {
    Json scales = Json::array();
    for (const ScaleFigures& figures : statistics.scales) {
        Json looks = Json::array();
        for (const LookOnScale& look : figures.looks) {
            const bool any = look.answers > 0;
            looks.push_back({{"answers", look.answers},
                             {"mean", any ? Json(look.mean) : Json(nullptr)},
                             {"low", look.interval.low},
                             {"high", look.interval.high}});
        }
        scales.push_back({{"low_word", figures.scale.low},
                          {"high_word", figures.scale.high},
                          {"looks", looks},
                          {"complete", figures.complete},
                          {"friedman_q", figures.friedman_q},
                          {"friedman_p", figures.friedman_p},
                          {"holm_p", figures.holm_p},
                          {"draws", statistics.draws},
                          {"words", figures.words}});
    }
    return scales;
}

Json figures_of(const DuelRecord& duel) {
    const DuelStatistics& statistics = duel.statistics;
    const auto interval = [](const Interval& share) { return Json{share.low, share.high}; };
    return {{"rounds", duel.series.rounds},
            {"repeats", duel.series.repeats},
            {"follows", duel.series.follows},
            {"designs", duel.series.designs},
            {"votes", duel.votes},
            {"evaluators", statistics.evaluators},
            {"majorities", statistics.majorities},
            {"sign_p", statistics.sign_p},
            {"ahead", statistics.ahead},
            {"share_interval", interval(statistics.share)},
            {"complete", statistics.complete},
            {"consistent", statistics.consistent},
            {"consistency_p", statistics.consistency_p},
            {"consistent_interval", interval(statistics.consistent_share)},
            {"incomplete", statistics.incomplete},
            {"incomplete_counted", statistics.incomplete_counted},
            {"verdict_kind", to_string(statistics.kind)},
            {"verdict", duel.words}};
}

std::string text_of(const DuelRecord& duel) {
    return fmt::format("duel of {} and {}, {} of {} blind repeats\n\n{}\n{}\nduel: {}\n",
                       duel.series.designs[0],
                       duel.series.designs[1],
                       duel.votes.size(),
                       duel.series.repeats,
                       text_of(duel_repeats_table(duel)),
                       text_of(duel_tests_table(duel)),
                       duel.words);
}

Json figures_of(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    Json figures = {{"designs", names},
                    {"evaluators", statistics.evaluators},
                    {"best", statistics.counts.best},
                    {"second", statistics.counts.second}};
    if (statistics.counts.has_least()) figures["least"] = statistics.counts.least;
    figures["best_chi_square"] = statistics.best_votes.chi_square;
    figures["best_chi_square_p"] = statistics.best_votes.asymptotic_p;
    figures["best_exact_p"] = statistics.best_votes.p;
    figures["best_method"] = to_string(statistics.best_votes.method);
    figures["shares"] = shares_of(statistics);
    figures["friedman_q"] = statistics.friedman_q;
    figures["friedman_chi_square_p"] = statistics.friedman_asymptotic_p;
    figures["friedman_exact_p"] = statistics.friedman_p;
    figures["friedman_method"] = to_string(statistics.friedman_method);
    figures["friedman_cases"] = statistics.friedman_cases;
    figures["kendall_w"] = json_of(statistics.kendall_w);
    figures["krippendorff_alpha"] = json_of(statistics.krippendorff_alpha);
    figures["rank_sums"] = statistics.rank_sums;
    figures["rank_sum_threshold"] = json_of(statistics.range_threshold);
    figures["borda"] = statistics.borda;
    figures["plackett_luce"] = statistics.worths;
    figures["plackett_luce_ghost"] = statistics.ghost;
    if (statistics.counts.has_least()) {
        figures["plackett_luce_pairs"] = statistics.pairs_expected ? "expected" : "known";
    }
    figures["pairs"] = pairs_of(statistics, names);
    figures["p_first"] = statistics.wins.first;
    figures["p_top_two"] = statistics.wins.top_two;
    figures["top_two"] = {statistics.top_a, statistics.top_b};
    figures["p_method"] = to_string(statistics.wins.method);
    figures["p_cases"] = statistics.wins.cases;
    figures["p_first_predictive"] = statistics.predicted.first;
    figures["p_first_predictive_draws"] = statistics.predicted.cases;
    if (statistics.resampled) figures["resampled"] = json_of(*statistics.resampled);
    figures["power"] = power_of(statistics);
    figures["verdict"] = statistics.words;
    figures["verdict_details"] = verdict_of(statistics);
    figures["seed"] = statistics.seed;
    return figures;
}

std::string text_of(const RoundReportSource& source) {
    const VoteStatistics& statistics = source.statistics;
    const ChartRows rows = text_rows(statistics, source.names);
    std::vector<ReportTable> tables = {votes_table(statistics, rows),
                                       worths_table(statistics, rows),
                                       tests_table(statistics, rows),
                                       pairs_table(statistics, rows)};
    if (!statistics.power.empty()) tables.push_back(power_table(statistics, statistics.power));
    if (!source.scales.scales.empty()) {
        tables.push_back(scale_means_table(source.scales, rows));
        tables.push_back(scale_tests_table(source.scales));
    }
    std::string text;
    for (const ReportTable& table : tables) text += text_of(table) + "\n";
    for (const ScaleFigures& scale : source.scales.scales) text += scale.words + "\n";
    text += "verdict: " + statistics.words + "\n";
    if (!source.record || !source.record->duel) return text;
    return fmt::format("round {} by itself:\n\n{}\n{}",
                       source.record->round.id,
                       text,
                       text_of(*source.record->duel));
}

}  // namespace livery
