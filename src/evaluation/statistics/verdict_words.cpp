#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "evaluation/statistics/vote_statistics.h"

namespace livery {

namespace {

std::string number_word(int number) {
    static constexpr std::array words = {"no",
                                         "one",
                                         "two",
                                         "three",
                                         "four",
                                         "five",
                                         "six",
                                         "seven",
                                         "eight",
                                         "nine",
                                         "ten",
                                         "eleven",
                                         "twelve"};
    return number >= 0 && number < static_cast<int>(words.size())
               ? words[static_cast<std::size_t>(number)]
               : std::to_string(number);
}

/// "about 38 more evaluators, in a fresh round, would tell"
std::string what_would_tell(const std::optional<int>& needed) {
    constexpr int beyond = 1000;
    if (!needed || *needed > beyond) {
        return fmt::format(
            "more than {} more evaluators, in a fresh round, would be needed to tell", beyond);
    }
    // Two figures: it is itself an estimate.
    int unit = 1;
    while (*needed / unit >= 100) unit *= 10;
    const int about = (*needed + unit - 1) / unit * unit;
    return fmt::format("about {} more evaluators, in a fresh round, would tell", about);
}

class VerdictWords {
  public:
    VerdictWords(const VoteStatistics& statistics, const std::vector<std::string>& names)
        : statistics_(statistics), verdict_(statistics.verdict), names_(names) {}

    std::string text() const {
        switch (verdict_.kind) {
            case VerdictKind::nobody:
                return "nobody has voted";
            case VerdictKind::one_evaluator:
                return fmt::format(
                    "one evaluator prefers {} to {}: one ballot tells nothing of others",
                    name(verdict_.leader),
                    name(verdict_.rival));
            case VerdictKind::no_preference:
                return no_preference();
            case VerdictKind::cannot_tell:
                return cannot_tell();
            case VerdictKind::leading:
                return fmt::format(
                    "{} leads, not separated from {}, and may be no better; if it is, {}",
                    name(verdict_.leader),
                    listed(names_of(verdict_.not_apart)),
                    what_would_tell(statistics_.evaluators_needed));
            case VerdictKind::clear_winner:
                return fmt::format("{} is the clear winner", name(verdict_.leader));
        }
        return "";
    }

  private:
    std::string name(int design) const { return names_[static_cast<std::size_t>(design)]; }
    std::vector<std::string> names_of(const std::vector<int>& designs) const {
        std::vector<std::string> names;
        for (const int design : designs) names.push_back(name(design));
        return names;
    }
    std::string these() const {
        return (statistics_.evaluators == 2 ? "the " : "these ") +
               number_word(statistics_.evaluators);
    }

    std::string no_preference() const {
        if (verdict_.too_few) {
            return fmt::format("{} evaluators are too few to show a preference among {} designs",
                               number_word(statistics_.evaluators),
                               number_word(statistics_.counts.designs()));
        }
        const double percent = 100.0 * verdict_.friedman_p;
        return fmt::format(
            "{} show no preference: ballots as far from even come about in {} of rounds without "
            "any",
            these(),
            percent >= 99.5 ? std::string("all")
                            : fmt::format("{:.{}f}%", percent, percent < 10 ? 1 : 0));
    }

    std::string cannot_tell() const {
        std::vector<std::string> others = names_of(verdict_.not_apart);
        const bool tie = statistics_.counts.best[static_cast<std::size_t>(verdict_.leader)] ==
                             statistics_.counts.best[static_cast<std::size_t>(verdict_.rival)] &&
                         statistics_.counts.second[static_cast<std::size_t>(verdict_.leader)] ==
                             statistics_.counts.second[static_cast<std::size_t>(verdict_.rival)];
        return fmt::format("{} cannot tell {} from {}{}{}",
                           these(),
                           name(verdict_.leader),
                           listed(others),
                           tie ? ", which have the same votes" : "",
                           tie ? "" : "; " + what_would_tell(statistics_.evaluators_needed));
    }

    const VoteStatistics& statistics_;
    const Verdict& verdict_;
    const std::vector<std::string>& names_;
};

}  // namespace

std::string listed(const std::vector<std::string>& items) {
    std::string text;
    for (std::size_t k = 0; k < items.size(); ++k) {
        if (k > 0) text += k + 1 == items.size() ? " and " : ", ";
        text += items[k];
    }
    return text;
}

std::string words_of(const VoteStatistics& statistics, const std::vector<std::string>& names) {
    return VerdictWords(statistics, names).text();
}

std::vector<std::string> default_names(int designs) {
    std::vector<std::string> names;
    for (int i = 0; i < designs; ++i)
        names.push_back(std::string("(") + static_cast<char>('a' + i) + ")");
    return names;
}

}  // namespace livery
