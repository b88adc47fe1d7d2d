#include "evaluation/ballot.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/error.h"

namespace livery {

namespace {

[[noreturn]] void fail(const std::string& what,
                       const std::string& found,
                       const std::string& expected) {
    throw std::invalid_argument(what + ": found " + found + ", expected " + expected);
}

long long sum_of(const std::vector<int>& counts) {
    return std::accumulate(counts.begin(), counts.end(), 0LL);
}

void check_list(const std::string& name, const std::vector<int>& counts, std::size_t designs) {
    if (counts.size() != designs) {
        fail(name,
             std::to_string(counts.size()) + " counts",
             std::to_string(designs) + ", as many as for best");
    }
    for (const int count : counts) {
        if (count < 0) fail(name, std::to_string(count), "counts of 0 or more");
    }
}

}  // namespace

int VoteCounts::evaluators() const { return static_cast<int>(sum_of(best)); }

void check_counts(const VoteCounts& counts) {
    const std::size_t designs = counts.best.size();
    if (designs < 2 || designs > kMostDesigns) {
        fail("best",
             std::to_string(designs) + (designs == 1 ? " design" : " designs"),
             "2 to " + std::to_string(kMostDesigns) + " to choose between");
    }
    check_list("best", counts.best, designs);
    check_list("second", counts.second, designs);
    if (counts.has_least()) {
        check_list("least", counts.least, designs);
        if (designs < 3) {
            fail("least", "2 designs", "3 or more: of two, the second best is the least");
        }
    }
    const long long evaluators = sum_of(counts.best);
    if (evaluators > kMostEvaluators) {
        fail("best",
             std::to_string(evaluators) + " evaluators",
             "at most " + std::to_string(kMostEvaluators));
    }
    const auto check_sum = [&](const char* name, const std::vector<int>& list) {
        if (sum_of(list) == evaluators) return;
        fail(name,
             std::to_string(sum_of(list)) + " votes",
             std::to_string(evaluators) + ", as many as for best: each ballot names one of each");
    };
    check_sum("second", counts.second);
    if (counts.has_least()) check_sum("least", counts.least);
    for (std::size_t i = 0; i < designs; ++i) {
        const int named =
            counts.best[i] + counts.second[i] + (counts.has_least() ? counts.least[i] : 0);
        if (named <= evaluators) continue;
        fail("design " + std::to_string(i + 1),
             std::to_string(named) + " votes",
             "at most " + std::to_string(evaluators) +
                 ": a ballot names a design once, and there are no more ballots");
    }
}

VoteCounts count_ballots(const std::vector<Ballot>& ballots, int designs, bool has_least) {
    const std::vector<int> none(static_cast<std::size_t>(designs), 0);
    VoteCounts counts{none, none, has_least ? none : std::vector<int>{}};
    for (const Ballot& ballot : ballots) {
        ++counts.best[static_cast<std::size_t>(ballot.best)];
        ++counts.second[static_cast<std::size_t>(ballot.second)];
        if (has_least && ballot.least >= 0) ++counts.least[static_cast<std::size_t>(ballot.least)];
    }
    return counts;
}

VoteCounts counts_of(const std::vector<Ballot>& ballots, int designs, bool has_least) {
    const auto check_place = [&](int design) {
        check_argument(design >= 0 && design < designs,
                       "counts_of: found design " + std::to_string(design) + ", expected 0 to " +
                           std::to_string(designs - 1));
    };
    for (const Ballot& ballot : ballots) {
        check_place(ballot.best);
        check_place(ballot.second);
        bool twice = ballot.best == ballot.second;
        if (has_least) {
            check_place(ballot.least);
            twice = twice || ballot.least == ballot.best || ballot.least == ballot.second;
        }
        check_argument(!twice, "counts_of: found a ballot that names a design twice");
    }
    VoteCounts counts = count_ballots(ballots, designs, has_least);
    check_counts(counts);
    return counts;
}

std::vector<double> expected_pairs(const VoteCounts& counts) {
    const auto designs = counts.best.size();
    std::vector<double> pairs(designs * designs, 1.0);
    for (std::size_t i = 0; i < designs; ++i) pairs[i * designs + i] = 0.0;
    // Where the table has to have zeros to have the counts, it is reached slowly.
    constexpr int most_rounds = 2000;
    constexpr double near_enough = 1e-9;
    for (int round = 0; round < most_rounds; ++round) {
        double furthest = 0.0;
        const auto scale = [&](std::size_t first, std::size_t step, int wanted) {
            double sum = 0.0;
            for (std::size_t k = 0; k < designs; ++k) sum += pairs[first + k * step];
            furthest = std::max(furthest, std::abs(sum - wanted));
            const double factor = sum > 0.0 ? wanted / sum : 0.0;
            for (std::size_t k = 0; k < designs; ++k) pairs[first + k * step] *= factor;
        };
        for (std::size_t i = 0; i < designs; ++i) scale(i * designs, 1, counts.best[i]);
        for (std::size_t j = 0; j < designs; ++j) scale(j, designs, counts.second[j]);
        if (round > 0 && furthest < near_enough) break;
    }
    return pairs;
}

std::string tally_csv(const std::vector<std::string>& designs, const VoteCounts& counts) {
    const bool least = counts.has_least();
    check_argument(counts.best.size() == designs.size() && counts.second.size() == designs.size() &&
                       (!least || counts.least.size() == designs.size()),
                   "tally_csv: " + std::to_string(designs.size()) + " designs, " +
                       std::to_string(counts.best.size()) + " and " +
                       std::to_string(counts.second.size()) + " counts");
    std::string text = least ? "design,best,second,least\r\n" : "design,best,second\r\n";
    for (std::size_t k = 0; k < designs.size(); ++k) {
        text += csv_field(designs[k]) + ',' + std::to_string(counts.best[k]) + ',' +
                std::to_string(counts.second[k]) +
                (least ? ',' + std::to_string(counts.least[k]) : std::string()) + "\r\n";
    }
    return text;
}

std::string csv_field(const std::string& text) {
    const bool formula =
        !text.empty() && std::string_view("=+-@\t").find(text.front()) != std::string_view::npos;
    const std::string cell = (formula ? "'" : "") + text;
    if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
    std::string quoted = "\"";
    for (const char c : cell) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

}  // namespace livery
