// What the commands of `livery evaluate` take.
#include <charconv>
#include <cstdlib>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

#include <poll.h>
#include <unistd.h>

#include "cli/evaluate/commands.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/utf8.h"
#include "evaluation/statistics/vote_statistics.h"

namespace livery {

namespace {

[[noreturn]] void fail(const std::string& option, const std::string& found, const char* expected) {
    throw std::invalid_argument(option + ": found \"" + found + "\", expected " + expected);
}

}  // namespace

std::vector<int> parse_counts(const std::string& option, const std::string& text) {
    constexpr const char* expected = "whole numbers of votes, a design each, with commas between";
    std::vector<int> counts;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        int count = 0;
        const auto [stop, error] = std::from_chars(at, end, count);
        if (error != std::errc()) fail(option, text, expected);
        counts.push_back(count);
        if (stop == end) return counts;
        if (*stop != ',') fail(option, text, expected);
        at = stop + 1;
    }
}

std::vector<std::string> parse_names(const std::string& option, const std::string& text) {
    std::vector<std::string> names;
    std::set<std::string> seen;
    std::istringstream stream(text + ",");
    for (std::string name; std::getline(stream, name, ',');) {
        if (name.empty()) fail(option, text, "names with commas between, none empty");
        if (name != printable(name, name.size())) fail(option, text, "names of printable text");
        if (!seen.insert(name).second) fail(option, text, "different names");
        names.push_back(name);
    }
    return names;
}

std::vector<std::string> names_or_letters(const std::string& text, int designs) {
    if (text.empty()) return default_names(designs);
    std::vector<std::string> names = parse_names("--names", text);
    check_argument(static_cast<int>(names.size()) == designs,
                   "--names: found " + std::to_string(names.size()) + " names, expected " +
                       std::to_string(designs) + ", one a design");
    return names;
}

std::optional<int> round_option(int round) {
    check_argument(round >= 0,
                   "--round: found " + std::to_string(round) + ", expected a round's number");
    return round == 0 ? std::nullopt : std::optional<int>(round);
}

void check_typed_counts(const VoteCounts& counts) {
    try {
        check_counts(counts);
    } catch (const std::invalid_argument& error) {
        const std::string what = error.what();
        for (const char* list : {"best:", "second:", "least:"}) {
            if (what.starts_with(list)) throw std::invalid_argument("--" + what);
        }
        throw;
    }
}

std::optional<std::string> TypedLines::next() {
    constexpr int wait_ms = 500;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (waiting_.find('\n') == std::string::npos) {
        const int ready = ::poll(&input, at_end_ ? 0 : 1, wait_ms);
        char bytes[256];
        if (ready > 0) {
            const ssize_t got = ::read(STDIN_FILENO, bytes, sizeof bytes);
            if (got > 0) {
                waiting_.append(bytes, static_cast<std::size_t>(got));
            } else {
                at_end_ = true;
            }
        }
    }
    const std::size_t end = waiting_.find('\n');
    if (end == std::string::npos) {
        if (!at_end_ || waiting_.empty()) return std::nullopt;
        return std::exchange(waiting_, {});
    }
    std::string line = waiting_.substr(0, end);
    waiting_.erase(0, end + 1);
    return line;
}

// --- where a round of votes comes from ---

namespace {

constexpr const char* kSample = "assets/sample-round/ballots.sqlite";

/// A copy of the sample, gone with the object: whoever opens a file of ballots must be able to
/// write beside it, and what is shipped may lie where nobody can.
class SampleCopy {
  public:
    SampleCopy() {
        std::string name = (std::filesystem::temp_directory_path() / "livery-XXXXXX").string();
        if (!::mkdtemp(name.data())) {
            throw FileError(name, "", "a folder that cannot be made", "a writable place");
        }
        folder_ = name;
        const auto shipped = shipped_path(kSample);
        file_ = folder_ / shipped.filename();
        std::error_code error;
        std::filesystem::copy_file(shipped, file_, error);
        if (error) throw FileError(file_, "", error.message(), "a writable place");
        std::filesystem::permissions(
            file_, std::filesystem::perms::owner_write, std::filesystem::perm_options::add, error);
    }
    ~SampleCopy() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    SampleCopy(const SampleCopy&) = delete;
    SampleCopy& operator=(const SampleCopy&) = delete;
    const std::filesystem::path& file() const { return file_; }

  private:
    std::filesystem::path folder_, file_;
};

void check_one_source(const VoteSourceArguments& arguments) {
    const bool typed = !arguments.best.empty() || !arguments.second.empty() ||
                       !arguments.least.empty() || !arguments.names.empty();
    check_argument(!arguments.sample || (!typed && arguments.ballots.empty()),
                   "--sample: found it with counts, names or a file, expected it alone");
    check_argument(arguments.ballots.empty() || !typed,
                   "--ballots: found it with counts or names, expected either a file or counts");
    check_argument(!arguments.ballots.empty() || arguments.round == 0,
                   "--round: found it without --ballots, expected a file of ballots");
    if (!arguments.ballots.empty() || arguments.sample) return;
    check_argument(!arguments.best.empty(),
                   "--best: found no counts, expected them, or a file with --ballots");
    check_argument(!arguments.second.empty(), "--second: found no counts, expected them");
}

}  // namespace

std::vector<Option> vote_source_options(VoteSourceArguments& arguments) {
    return {
        {"--best", "N,N,...", "how often each design was named best", &arguments.best, false, {}},
        {"--second", "N,N,...", "how often second best", &arguments.second, false, {}},
        {"--least",
         "N,N,...",
         "how often least, where every ballot named one",
         &arguments.least,
         false,
         {}},
        {"--names",
         "A,B,...",
         "what the designs are called (default (a), (b), ...)",
         &arguments.names,
         false,
         {}},
        {"--ballots", "FILE", "a file of ballots, instead", &arguments.ballots, false, {}},
        {"--round",
         "N",
         "which of its rounds (default: the last closed)",
         &arguments.round,
         false,
         {}},
        {"--sample",
         "",
         "the made-up round that comes with Livery, instead",
         &arguments.sample,
         false,
         {}},
    };
}

VoteSource read_vote_source(const VoteSourceArguments& arguments, std::uint64_t seed) {
    check_one_source(arguments);
    if (arguments.sample) {
        const SampleCopy copy;
        VoteSource source{report_source(read_closed_round(copy.file(), {}, seed), seed), {}};
        source.details = round_details_file(shipped_path(kSample), source.round.record->round.id);
        return source;
    }
    if (!arguments.ballots.empty()) {
        VoteSource source{
            report_source(read_closed_round(arguments.ballots, round_option(arguments.round), seed),
                          seed),
            {}};
        source.details = round_details_file(arguments.ballots, source.round.record->round.id);
        return source;
    }
    VoteCounts counts{parse_counts("--best", arguments.best),
                      parse_counts("--second", arguments.second)};
    if (!arguments.least.empty()) counts.least = parse_counts("--least", arguments.least);
    check_typed_counts(counts);
    VoteSource source;
    source.round.names = names_or_letters(arguments.names, counts.designs());
    source.round.statistics = vote_statistics(counts, source.round.names, seed);
    return source;
}

}  // namespace livery
