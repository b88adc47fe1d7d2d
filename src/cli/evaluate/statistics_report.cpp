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

std::string design_table(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    std::size_t width = 6;
    for (const std::string& name : names) width = std::max(width, name.size());
    const bool least = statistics.counts.has_least();
    std::string text = fmt::format("{:<{}} {:>5} {:>6}{} {:>8} {:>5} {:>6} {:>8}  share of best\n",
                                   "design",
                                   width,
                                   "best",
                                   "second",
                                   least ? "  least" : "",
                                   "rank sum",
                                   "Borda",
                                   "worth",
                                   "P(first)");
    for (std::size_t i = 0; i < names.size(); ++i) {
        text +=
            fmt::format("{:<{}} {:>5} {:>6}{} {:>8.1f} {:>5} {:>6.3f} {:>8.3f}  {:.2f} to {:.2f}\n",
                        names[i],
                        width,
                        statistics.counts.best[i],
                        statistics.counts.second[i],
                        least ? fmt::format(" {:>6}", statistics.counts.least[i]) : "",
                        statistics.rank_sums[i],
                        statistics.borda[i],
                        statistics.worths[i],
                        statistics.predicted.first[i],
                        statistics.share_best[i].low,
                        statistics.share_best[i].high);
    }
    return text;
}

std::string test_lines(const VoteStatistics& statistics) {
    std::string text = fmt::format(
        "best against equal preference: chi-square {:.2f}, p = {:.3f} ({}; {:.3f} asymptotic)\n",
        statistics.best_votes.chi_square,
        statistics.best_votes.p,
        method_text(statistics.best_votes.method, statistics.best_votes.cases),
        statistics.best_votes.asymptotic_p);
    text += fmt::format("Friedman, all votes: Q {:.2f}, p = {:.4f} ({})\n",
                        statistics.friedman_q,
                        statistics.friedman_p,
                        method_text(statistics.friedman_method, statistics.friedman_cases));
    if (statistics.kendall_w) {
        text += fmt::format("agreement: Kendall's W {:.3f}", *statistics.kendall_w);
        if (statistics.krippendorff_alpha) {
            text += fmt::format(", Krippendorff's alpha {:.3f}", *statistics.krippendorff_alpha);
        }
        text += "\n";
    }
    if (statistics.range_threshold) {
        text += fmt::format(
            "rank sums tell two designs apart from a difference of {:.1f} on (5% over all pairs)\n",
            *statistics.range_threshold);
    }
    return text;
}

std::string pair_lines(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    std::string text;
    constexpr std::size_t most = 28;
    for (std::size_t k = 0; k < std::min(most, statistics.pairs.size()); ++k) {
        const PairComparison& pair = statistics.pairs[k];
        text += fmt::format("{} to {}: odds {} [{}, {}], p = {:.3f}\n",
                            names[static_cast<std::size_t>(pair.a)],
                            names[static_cast<std::size_t>(pair.b)],
                            odds_text(pair.odds),
                            odds_text(pair.low),
                            odds_text(pair.high),
                            pair.p);
    }
    if (statistics.pairs.size() > most) {
        text += fmt::format("{} more pairs: --json\n", statistics.pairs.size() - most);
    }
    if (statistics.ghost) {
        text +=
            "worths: with half a win and half a loss of each design against a ghost, since a "
            "design "
            "has no vote or one has all for best; were all liked alike, 95% intervals would hold "
            "in "
            "about 60% of such rounds\n";
    }
    if (statistics.pairs_expected) {
        text +=
            "worths: the counts do not tell which best went with which second best; the evenest "
            "way is taken\n";
    }
    return text;
}

std::string power_lines(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    if (statistics.power.empty()) return "";
    std::string text = fmt::format("a fresh round at these worths would tell {} from {}:",
                                   names[static_cast<std::size_t>(statistics.verdict.leader)],
                                   names[static_cast<std::size_t>(statistics.verdict.rival)]);
    for (std::size_t k = 0; k < statistics.power.size(); ++k) {
        text += fmt::format("{} with {} evaluators in {:.0f}%",
                            k == 0 ? "" : ",",
                            statistics.power[k].evaluators,
                            100.0 * statistics.power[k].power);
    }
    return text + " of cases\n";
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

std::string text_of(const ScaleStatistics& statistics, const std::vector<std::string>& names) {
    if (statistics.scales.empty()) return "";
    std::string text = fmt::format(
        "\nscales from 1 (the first word) to 7, {} evaluators answered; 95% by evaluators drawn "
        "again\n",
        statistics.evaluators);
    for (const ScaleFigures& figures : statistics.scales) {
        text += in_words(figures.scale) + "\n";
        for (std::size_t k = 0; k < names.size(); ++k) {
            const LookOnScale& look = figures.looks[k];
            text += look.answers == 0 ? fmt::format("  {}: no answers\n", names[k])
                                      : fmt::format("  {}: {:.2f} [{:.2f}, {:.2f}], {} answers\n",
                                                    names[k],
                                                    look.mean,
                                                    look.interval.low,
                                                    look.interval.high,
                                                    look.answers);
        }
    }
    for (const ScaleFigures& figures : statistics.scales) text += figures.words + "\n";
    return text;
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
    std::string text = fmt::format("\nduel of {} and {}, {} of {} blind repeats\n",
                                   duel.series.designs[0],
                                   duel.series.designs[1],
                                   duel.votes.size(),
                                   duel.series.repeats);
    for (std::size_t k = 0; k < duel.votes.size(); ++k) {
        text += fmt::format("repeat {}, round {}: {} to {}\n",
                            k + 1,
                            duel.series.rounds[k],
                            duel.votes[k][0],
                            duel.votes[k][1]);
    }
    text += fmt::format("evaluators by their majorities: {} to {}\n",
                        duel.statistics.majorities[0],
                        duel.statistics.majorities[1]);
    return text + "duel: " + duel.words + "\n";
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

std::string text_of(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    std::string text = design_table(statistics, names) + test_lines(statistics) +
                       pair_lines(statistics, names) + power_lines(statistics, names);
    if (statistics.evaluators > 1) {
        text += fmt::format("{} and {} would be the top two again in {:.0f}% of such rounds ({})\n",
                            names[static_cast<std::size_t>(statistics.top_a)],
                            names[static_cast<std::size_t>(statistics.top_b)],
                            100.0 * statistics.wins.top_two,
                            method_text(statistics.wins.method, statistics.wins.cases));
    }
    return text + "verdict: " + statistics.words + "\n";
}

}  // namespace livery
