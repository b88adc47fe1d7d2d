// livery evaluate export

#include <memory>

#include <fmt/format.h>

#include "cli/evaluate/commands.h"
#include "core/error.h"
#include "core/paths.h"
#include "evaluation/closed_round.h"

namespace livery {

namespace {

struct ExportArguments {
    std::string ballots, out;
    int round = 0;
};

Json json_of(const ClosedRound& closed, int seed) {
    const Round& round = closed.round;
    Json ballots = Json::array();
    for (std::size_t k = 0; k < closed.ballots.size(); ++k) {
        const Ballot& ballot = closed.ballots[k];
        ballots.push_back({{"best", ballot.best}, {"second", ballot.second}});
        if (ballot.least >= 0) ballots.back()["least"] = ballot.least;
        if (round.scales.empty()) continue;
        Json& answers = ballots.back()["steps"] = Json::array();
        for (const auto& steps : closed.answers[k]) {
            Json& placed = answers.emplace_back(Json::array());
            for (const int step : steps) placed.push_back(step > 0 ? Json(step) : Json(nullptr));
        }
    }
    Json json = {{"format_version", 1},
                 {"kind", "ballots"},
                 {"round", round.id},
                 {"created", round.created},
                 {"calibration_id", round.calibration_id},
                 {"designs", round.designs},
                 {"seed", seed},
                 {"ballots", ballots}};
    if (!round.scales.empty()) {
        json["scales"] = Json::array();
        for (const SemanticScale& scale : round.scales) {
            json["scales"].push_back({scale.low, scale.high});
        }
    }
    return json;
}

}  // namespace

Command evaluate_export_command() {
    const auto arguments = std::make_shared<ExportArguments>();
    Command command;
    command.name = "evaluate export";
    command.summary = "a round's ballots without names, in an order of chance, as CSV or JSON";
    command.example = "livery evaluate export --ballots votes.livery-ballots --out round.csv";
    command.options = {
        {"--ballots", "FILE", "a file of ballots", &arguments->ballots, true},
        {"--round", "N", "which of its rounds (default: the last closed)", &arguments->round},
        {"--out", "FILE", "what to write, .csv or .json", &arguments->out, true},
    };
    command.run = [arguments](const CommonOptions& common, const Progress&) {
        const std::filesystem::path out = arguments->out;
        const bool csv = out.extension() == ".csv";
        check_argument(csv || out.extension() == ".json",
                       "--out: found \"" + arguments->out + "\", expected a name in .csv or .json");
        const auto seed = static_cast<std::uint64_t>(common.seed);
        const ClosedRound closed =
            read_closed_round(arguments->ballots, round_option(arguments->round), seed);
        if (csv) {
            write_text_file(out, ballots_csv(closed, seed));
        } else {
            write_json_file(out, json_of(closed, common.seed));
        }
        Outcome outcome;
        outcome.figures = {{"file", arguments->out},
                           {"round", closed.round.id},
                           {"ballots", closed.ballots.size()},
                           {"seed", common.seed}};
        outcome.text = fmt::format(
            "{}: {} ballots of round {}\n", arguments->out, closed.ballots.size(), closed.round.id);
        return outcome;
    };
    return command;
}

}  // namespace livery
