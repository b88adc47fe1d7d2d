// `livery evaluate`: its commands, lists as they take them, and lines that are typed meanwhile.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "evaluation/ballot.h"

namespace livery {

Command evaluate_export_command();
Command evaluate_order_command();
Command evaluate_report_command();
Command evaluate_tally_command();
Command evaluate_vote_command();

/// "1,6,1,2". Throws std::invalid_argument that names the option, what was found and expected.
std::vector<int> parse_counts(const std::string& option, const std::string& text);

/// "red,silver": none empty, none twice. Throws std::invalid_argument.
std::vector<std::string> parse_names(const std::string& option, const std::string& text);

/// The names that --names gave, or "(a)", "(b)", ... where it was not given. Throws
/// std::invalid_argument for another number of them.
std::vector<std::string> names_or_letters(const std::string& text, int designs);

/// What --round says; nothing where it was not given. Throws std::invalid_argument below 0.
std::optional<int> round_option(int round);

/// check_counts() of what --best, --second and --least gave, by those names.
void check_typed_counts(const VoteCounts& counts);

/// Lines of the standard input.
class TypedLines {
  public:
    /// The next line, without its end; nothing when none came within half a second. After the end
    /// of the input what was left without a line break is a line too, then there are none.
    std::optional<std::string> next();
    /// Nothing is left, and nothing will come.
    bool at_end() const { return at_end_ && waiting_.empty(); }

  private:
    std::string waiting_;
    bool at_end_ = false;
};

}  // namespace livery
