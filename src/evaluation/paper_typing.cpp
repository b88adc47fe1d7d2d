#include "evaluation/paper_typing.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/error.h"
#include "core/utf8.h"

namespace livery {

namespace {

constexpr std::array kPlaces = {"best", "second", "least"};

Round round_with(const BallotStore& store, int id) {
    for (Round& round : store.rounds()) {
        if (round.id == id) return std::move(round);
    }
    throw std::invalid_argument("found no round " + std::to_string(id) + " in " +
                                store.file().string());
}

std::optional<int> whole(const std::string& text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return {};
    return number;
}

}  // namespace

PaperTyping::PaperTyping(BallotStore& store, int round)
    : store_(store),
      round_(round_with(store, round)),
      paper_(next_paper(store.seats(round_.session))) {}

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
    const auto code = whole(text);
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
    PaperBallot ballot{paper_, {looks_[0], looks_[1]}};
    if (looks_.size() > 2) ballot.choices.least = looks_[2];
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
    const auto paper = whole(text);
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
    const Choices& choices = last_->choices;
    const CastBallot cast = store_.vote(
        round_.id, {paper_seat(last_->paper), choices.best, choices.second, choices.least});
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
