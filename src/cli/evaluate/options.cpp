#include <charconv>
#include <set>
#include <sstream>
#include <utility>

#include <poll.h>
#include <unistd.h>

#include "cli/evaluate/commands.h"
#include "core/error.h"
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

}  // namespace livery
