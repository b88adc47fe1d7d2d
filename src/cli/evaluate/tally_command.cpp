// livery evaluate tally

#include <memory>

#include "cli/evaluate/commands.h"
#include "cli/evaluate/statistics_report.h"
#include "core/error.h"
#include "evaluation/closed_round.h"

namespace livery {

namespace {

struct TallyArguments {
    std::string best, second, least, names, ballots;
    int round = 0;
};

VoteCounts typed_counts(const TallyArguments& arguments) {
    VoteCounts counts{parse_counts("--best", arguments.best),
                      parse_counts("--second", arguments.second)};
    if (!arguments.least.empty()) counts.least = parse_counts("--least", arguments.least);
    check_typed_counts(counts);
    return counts;
}

Outcome told(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    return {figures_of(statistics, names), text_of(statistics, names)};
}

Outcome tally_of_round(const TallyArguments& arguments, std::uint64_t seed) {
    const ClosedRound round =
        read_closed_round(arguments.ballots, round_option(arguments.round), seed);
    const auto designs = static_cast<int>(round.designs.size());
    const VoteStatistics statistics =
        vote_statistics(counts_of(round.ballots, designs, round.all_name_least),
                        round.designs,
                        seed,
                        &round.ballots);
    Outcome outcome = told(statistics, round.designs);
    outcome.figures["round"] = round.id;
    outcome.figures["calibration_id"] = round.calibration_id;
    return outcome;
}

void check_one_source(const TallyArguments& arguments) {
    const bool typed = !arguments.best.empty() || !arguments.second.empty() ||
                       !arguments.least.empty() || !arguments.names.empty();
    check_argument(arguments.ballots.empty() || !typed,
                   "--ballots: found it with counts or names, expected either a file or counts");
    check_argument(!arguments.ballots.empty() || arguments.round == 0,
                   "--round: found it without --ballots, expected a file of ballots");
    if (!arguments.ballots.empty()) return;
    check_argument(!arguments.best.empty(),
                   "--best: found no counts, expected them, or a file with --ballots");
    check_argument(!arguments.second.empty(), "--second: found no counts, expected them");
}

}  // namespace

Command evaluate_tally_command() {
    const auto arguments = std::make_shared<TallyArguments>();
    Command command;
    command.name = "evaluate tally";
    command.summary = "what a round of votes says, and how surely";
    command.example = "livery evaluate tally --best 1,6,1,2 --second 0,3,2,5";
    command.options = {
        {"--best", "N,N,...", "how often each design was named best", &arguments->best, false, {}},
        {"--second", "N,N,...", "how often second best", &arguments->second, false, {}},
        {"--least",
         "N,N,...",
         "how often least, where every ballot named one",
         &arguments->least,
         false,
         {}},
        {"--names",
         "A,B,...",
         "what the designs are called (default (a), (b), ...)",
         &arguments->names,
         false,
         {}},
        {"--ballots", "FILE", "a file of ballots, instead", &arguments->ballots, false, {}},
        {"--round",
         "N",
         "which of its rounds (default: the last closed)",
         &arguments->round,
         false,
         {}},
    };
    command.run = [arguments](const CommonOptions& common, const Progress&) {
        check_one_source(*arguments);
        const auto seed = static_cast<std::uint64_t>(common.seed);
        if (!arguments->ballots.empty()) return tally_of_round(*arguments, seed);
        const VoteCounts counts = typed_counts(*arguments);
        const auto names = names_or_letters(arguments->names, counts.designs());
        return told(vote_statistics(counts, names, seed), names);
    };
    return command;
}

}  // namespace livery
