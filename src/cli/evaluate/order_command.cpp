// livery evaluate order

#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/evaluate/commands.h"
#include "evaluation/presentation_order.h"

namespace livery {

namespace {

struct OrderArguments {
    int designs = 0, evaluators = 0, wave = 3;
    std::string names;
};

Json figures_of(const PresentationOrder& order, const std::vector<std::string>& names, int seed) {
    Json waves = Json::array();
    for (const Wave& wave : order.waves) {
        waves.push_back({{"row", wave.row},
                         {"evaluators", wave.evaluators},
                         {"designs", wave.designs},
                         {"codes", wave.codes}});
    }
    return {{"designs", names},
            {"rows", order.rows},
            {"codes", order.codes},
            {"waves", waves},
            {"balanced", order.balanced},
            {"seed", seed}};
}

std::string text_of(const PresentationOrder& order, const std::vector<std::string>& names) {
    std::string text = "codes, for the operator alone:\n";
    for (std::size_t i = 0; i < names.size(); ++i) {
        text += fmt::format("  {}  {}\n", order.codes[i], names[i]);
    }
    text += fmt::format("{:>5} {:>4} {:>10}  shown in this order\n", "wave", "row", "evaluators");
    for (std::size_t w = 0; w < order.waves.size(); ++w) {
        const Wave& wave = order.waves[w];
        text += fmt::format("{:>5} {:>4} {:>10}  {}\n",
                            w + 1,
                            wave.row,
                            wave.evaluators > 0 ? std::to_string(wave.evaluators) : "-",
                            fmt::join(wave.codes, " "));
    }
    if (!order.balanced) {
        text += fmt::format(
            "{} waves do not use the {} rows evenly: places and neighbours are balanced in part\n",
            order.waves.size(),
            order.rows.size());
    }
    return text;
}

}  // namespace

Command evaluate_order_command() {
    const auto arguments = std::make_shared<OrderArguments>();
    Command command;
    command.name = "evaluate order";
    command.summary = "in which order looks are shown, and under which codes";
    command.example = "livery evaluate order --designs 4 --evaluators 10 --seed 7";
    command.options = {
        {"--designs", "K", "how many looks, 2 to 26", &arguments->designs, true},
        {"--evaluators",
         "N",
         "how many people will look (default: a wave for each row)",
         &arguments->evaluators},
        {"--wave", "N", "at most so many look together (default 3)", &arguments->wave},
        {"--names",
         "A,B,...",
         "what the looks are called (default (a), (b), ...)",
         &arguments->names},
    };
    command.run = [arguments](const CommonOptions& common, const Progress&) {
        const PresentationOrder order = presentation_order(arguments->designs,
                                                           arguments->evaluators,
                                                           arguments->wave,
                                                           static_cast<std::uint64_t>(common.seed));
        const auto names = names_or_letters(arguments->names, arguments->designs);
        Outcome outcome;
        outcome.figures = figures_of(order, names, common.seed);
        outcome.text = text_of(order, names);
        return outcome;
    };
    return command;
}

}  // namespace livery
