#include "evaluation/paper_ballots.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <string_view>

#include "core/error.h"
#include "core/utf8.h"

namespace livery {

namespace {

constexpr std::string_view kPaperSeat = "paper ";
constexpr std::string_view kBlanks = " \t\r";

/// The number that the text is and nothing else; nothing for more than four digits.
std::optional<int> number_of(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || text.size() > 4) {
        return std::nullopt;
    }
    return number;
}

/// Cells between commas or semicolons may be empty, those between blanks cannot.
std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    const std::size_t mark = line.find_first_of(",;");
    if (mark != std::string_view::npos) {
        const char separator = line[mark];
        while (true) {
            const std::size_t end = line.find(separator);
            cells.push_back(trimmed(line.substr(0, end)));
            if (end == std::string_view::npos) return cells;
            line.remove_prefix(end + 1);
        }
    }
    for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
        const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
        cells.push_back(line.substr(0, end));
        line.remove_prefix(end);
    }
    return cells;
}

class PaperReader {
  public:
    PaperReader(const std::filesystem::path& name, const Round& round)
        : name_(name), round_(round) {
        columns_ = {"best", "second"};
        if (round.asks_least) columns_.emplace_back("least");
    }

    std::vector<PaperBallot> read(std::string_view text) {
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++line_;
            take(trimmed(text.substr(0, end)));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        if (ballots_.empty()) throw FileError(name_, "", "no ballot", "a line a ballot");
        return std::move(ballots_);
    }

  private:
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw FileError(name_, "line " + std::to_string(line_), found, expected);
    }

    static std::string quoted(std::string_view cell) { return "\"" + printable(cell, 40) + "\""; }

    void take(std::string_view line) {
        if (line_ == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
        if (line.empty() || line.front() == '#') return;
        const auto cells = cells_of(line);
        const char first = cells.front().empty() ? '0' : cells.front().front();
        const bool words = (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z');
        if (!begun_ && words) {
            begun_ = true;
            return take_names(cells);
        }
        begun_ = true;
        if (static_cast<int>(ballots_.size()) == kMostEvaluators) {
            fail("more ballots", "at most " + std::to_string(kMostEvaluators));
        }
        ballots_.push_back(ballot_of(cells));
    }

    void take_names(const std::vector<std::string_view>& cells) {
        columns_.clear();
        const auto has = [&](std::string_view column) {
            return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
        };
        for (std::string_view cell : cells) {
            const bool known = cell == "best" || cell == "second" || cell == "paper" ||
                               (cell == "least" && round_.asks_least);
            if (!known || has(cell)) {
                fail(quoted(cell),
                     std::string("the columns best, second") +
                         (round_.asks_least ? ", least" : "") + " and paper, each once");
            }
            columns_.emplace_back(cell);
        }
        if (!has("best") || !has("second")) fail(quoted(cells.front()), "best and second");
    }

    PaperBallot ballot_of(const std::vector<std::string_view>& cells) {
        // The least may be left out, and so may its comma.
        const bool may_lack = !columns_.empty() && columns_.back() == "least";
        const bool fits =
            cells.size() == columns_.size() || (may_lack && cells.size() + 1 == columns_.size());
        if (!fits) {
            std::string expected;
            for (const std::string& column : columns_)
                expected += (expected.empty() ? "" : ", ") + column;
            fail(std::to_string(cells.size()) + (cells.size() == 1 ? " cell" : " cells"), expected);
        }
        PaperBallot ballot;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const std::string& column = columns_[k];
            if (column == "paper") {
                ballot.paper = paper_of(cells[k]);
            } else if (column == "least") {
                if (!cells[k].empty()) ballot.ballot.least = look_of(cells[k]);
            } else {
                (column == "best" ? ballot.ballot.best : ballot.ballot.second) = look_of(cells[k]);
            }
        }
        const Ballot& looks = ballot.ballot;
        if (looks.best == looks.second || looks.least == looks.best ||
            looks.least == looks.second) {
            fail("one look twice", "a different look for each place");
        }
        return ballot;
    }

    int look_of(std::string_view cell) const {
        const auto code = number_of(cell);
        const auto look = code ? look_with_code(round_, *code) : std::nullopt;
        if (!look) fail(quoted(cell), "a code of the round: " + codes_in_words(round_));
        return *look;
    }

    int paper_of(std::string_view cell) {
        const auto paper = number_of(cell);
        if (!paper || *paper < 1) {
            fail(quoted(cell), "a paper's number, 1 to " + std::to_string(kMostPaper));
        }
        if (!papers_.insert(*paper).second) {
            fail("paper " + std::to_string(*paper) + " a second time", "each paper once");
        }
        return *paper;
    }

    std::filesystem::path name_;
    const Round& round_;
    std::vector<std::string> columns_;
    std::vector<PaperBallot> ballots_;
    std::set<int> papers_;
    int line_ = 0;
    bool begun_ = false;
};

constexpr std::array kPlaces = {"best", "second", "least"};

}  // namespace

std::string paper_seat(int paper) { return std::string(kPaperSeat) + std::to_string(paper); }

int next_paper(const std::vector<Seat>& seats) {
    int highest = 0;
    for (const Seat& seat : seats) {
        if (!seat.name.starts_with(kPaperSeat)) continue;
        const auto paper = number_of(std::string_view(seat.name).substr(kPaperSeat.size()));
        highest = std::max(highest, paper.value_or(0));
    }
    return highest + 1;
}

std::optional<int> look_with_code(const Round& round, int code) {
    const auto found = std::find(round.codes.begin(), round.codes.end(), code);
    if (found == round.codes.end()) return std::nullopt;
    return static_cast<int>(found - round.codes.begin());
}

std::string codes_in_words(const Round& round) {
    std::vector<int> codes = round.codes;
    std::sort(codes.begin(), codes.end());
    std::string text;
    for (std::size_t k = 0; k < codes.size(); ++k) {
        if (k > 0) text += k + 1 == codes.size() ? " or " : ", ";
        text += std::to_string(codes[k]);
    }
    return text;
}

std::vector<PaperBallot> parse_paper_ballots(const std::string& text,
                                             const std::filesystem::path& name,
                                             const Round& round) {
    return PaperReader(name, round).read(text);
}

std::vector<PaperBallot> numbered(std::vector<PaperBallot> papers, int next) {
    std::set<int> taken;
    for (const PaperBallot& paper : papers) taken.insert(paper.paper);
    for (PaperBallot& paper : papers) {
        if (paper.paper == 0) {
            while (taken.contains(next)) ++next;
            paper.paper = next++;
        }
        check_argument(paper.paper <= kMostPaper,
                       "papers: found number " + std::to_string(paper.paper) +
                           ", expected at most " + std::to_string(kMostPaper));
    }
    return papers;
}

// --- typing ---

PaperTyping::PaperTyping(BallotStore& store, int round)
    : store_(store), round_(store.round(round)), paper_(next_paper(store.seats(round_.session))) {}

std::string PaperTyping::help() const {
    return std::string("Type the code of the best look, Enter, of the second best, Enter") +
           (round_.asks_least ? ", of the least, Enter (Enter alone: none)" : "") +
           ".\n- takes the last one back, .7 goes to paper 7, + sums up, * ends.\n";
}

std::string PaperTyping::prompt() const {
    return paper_seat(paper_) + ", " + kPlaces[looks_.size()] + ": ";
}

std::string PaperTyping::take(const std::string& typed) {
    std::string line = typed;
    std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
    if (line == "-") return take_back();
    if (line == "+") return summary();
    if (line == "*" || line == "q") {
        if (!looks_.empty()) {
            return paper_seat(paper_) +
                   " is begun: type the rest of it, or take it back with -, then end.\n";
        }
        done_ = true;
        return finish();
    }
    if (line.starts_with('.')) return go_to(line.substr(1));
    if (line.empty()) {
        if (looks_.size() == 2) return complete();
        return "Type the code of the " + std::string(kPlaces[looks_.size()]) +
               " look: " + codes_in_words(round_) + ".\n";
    }
    return take_code(line);
}

std::string PaperTyping::take_code(const std::string& text) {
    const auto code = number_of(text);
    const auto look = code ? look_with_code(round_, *code) : std::nullopt;
    if (!look) {
        return "\"" + printable(text, 20) +
               "\" is no code of this round: " + codes_in_words(round_) + ".\n";
    }
    const auto before = std::find(looks_.begin(), looks_.end(), *look);
    if (before != looks_.end()) {
        return text + " is the " + kPlaces[static_cast<std::size_t>(before - looks_.begin())] +
               " of this paper already: the " + kPlaces[looks_.size()] + " is another look.\n";
    }
    if (looks_.empty()) keep();
    looks_.push_back(*look);
    return looks_.size() == places() ? complete() : "";
}

std::string PaperTyping::complete() {
    const PaperBallot ballot{paper_, {looks_[0], looks_[1], looks_.size() > 2 ? looks_[2] : -1}};
    const std::string text = paper_seat(paper_) + ": " + words_of(looks_) +
                             (looks_.size() < places() ? ", no least" : "") + ".\n";
    last_ = ballot;
    looks_.clear();
    paper_ = std::max(next_paper(store_.seats(round_.session)), paper_ + 1);
    return text;
}

std::string PaperTyping::take_back() {
    if (!looks_.empty()) {
        const std::string place = kPlaces[looks_.size() - 1];
        const int code = round_.codes[static_cast<std::size_t>(looks_.back())];
        looks_.pop_back();
        return place + " " + std::to_string(code) + " is taken back.\n";
    }
    if (last_) {
        paper_ = last_->paper;
        last_.reset();
        return paper_seat(paper_) + " is taken back: type it again, or end.\n";
    }
    return "Nothing can be taken back: ballots before are kept. .7 types paper 7 again, which "
           "replaces it.\n";
}

std::string PaperTyping::go_to(const std::string& text) {
    const auto paper = number_of(text);
    if (!paper || *paper < 1 || *paper > kMostPaper) {
        return "Type a point and a paper's number, 1 to " + std::to_string(kMostPaper) + ".\n";
    }
    if (!looks_.empty()) {
        return paper_seat(paper_) + " is begun: type the rest of it, or take it back with -.\n";
    }
    keep();
    paper_ = *paper;
    return was_typed(paper_)
               ? paper_seat(paper_) + " was typed before: what comes now replaces it.\n"
               : "";
}

std::string PaperTyping::summary() const {
    const auto typed = static_cast<int>(kept_.size()) + (last_ ? 1 : 0);
    const auto in_all = static_cast<int>(store_.voted(round_.id).size());
    std::string text = std::to_string(typed) + (typed == 1 ? " ballot" : " ballots") +
                       " typed here; round " + std::to_string(round_.id) + " holds " +
                       std::to_string(in_all);
    if (last_) text += ", and " + paper_seat(last_->paper) + " as soon as the next is begun";
    return text + ". What they say is told when the round is locked.\n";
}

std::string PaperTyping::finish() {
    keep();
    if (looks_.empty()) return "";
    looks_.clear();
    return paper_seat(paper_) + " was not complete and is not kept.\n";
}

void PaperTyping::keep() {
    if (!last_) return;
    const bool replaced = was_typed(last_->paper);
    const CastBallot cast = store_.vote(round_.id, paper_seat(last_->paper), last_->ballot);
    kept_.push_back({last_->paper, cast.receipt, replaced});
    last_.reset();
}

std::string PaperTyping::words_of(const std::vector<int>& looks) const {
    std::string text;
    for (std::size_t k = 0; k < looks.size(); ++k) {
        text += (k == 0 ? "" : ", ") + std::string(kPlaces[k]) + " " +
                std::to_string(round_.codes[static_cast<std::size_t>(looks[k])]);
    }
    return text;
}

bool PaperTyping::was_typed(int paper) const {
    for (const Seat& seat : store_.seats(round_.session)) {
        if (seat.name == paper_seat(paper))
            return store_.ballot_of(round_.id, seat.number).has_value();
    }
    return false;
}

}  // namespace livery
