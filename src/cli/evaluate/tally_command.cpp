// livery evaluate tally

#include <memory>

#include "cli/evaluate/commands.h"

namespace livery {

Command evaluate_tally_command() {
    const auto arguments = std::make_shared<VoteSourceArguments>();
    Command command;
    command.name = "evaluate tally";
    command.summary = "what a round of votes says, and how surely";
    command.example = "livery evaluate tally --best 1,6,1,2 --second 0,3,2,5";
    command.options = vote_source_options(*arguments);
    command.run = [arguments](const CommonOptions& common, const Progress&) {
        const RoundReportSource source =
            read_vote_source(*arguments, static_cast<std::uint64_t>(common.seed)).round;
        Outcome outcome{figures_of(source.statistics, source.names), text_of(source)};
        if (source.record) {
            outcome.figures["round"] = source.record->round.id;
            outcome.figures["calibration_id"] = source.record->round.calibration_id;
            if (!source.scales.scales.empty())
                outcome.figures["scales"] = figures_of(source.scales);
            if (source.record->duel) outcome.figures["series"] = figures_of(*source.record->duel);
        }
        if (arguments->sample) {
            outcome.figures["sample"] = true;
            outcome.text = "A made-up sample: nobody voted.\n" + outcome.text;
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
