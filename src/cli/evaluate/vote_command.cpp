// livery evaluate vote

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/evaluate/commands.h"
#include "core/error.h"
#include "core/paths.h"
#include "evaluation/paper_ballots.h"
#include "evaluation/presentation_order.h"

namespace livery {

namespace {

struct VoteArguments {
    std::string ballots, designs, codes, in;
    int round = 0;
    bool least = false, lock = false;
};

class VoteSession {
  public:
    VoteSession(const VoteArguments& arguments, const CommonOptions& common)
        : arguments_(arguments),
          out_(common.json ? stderr : stdout),
          store_(arguments.ballots),
          round_(chosen_round(common.seed)) {}

    Outcome run(const Progress& progress) {
        arguments_.in.empty() && ::isatty(STDIN_FILENO) == 1 ? type(progress) : take_file(progress);
        return told();
    }

  private:
    void say(const std::string& text) const {
        std::fputs(text.c_str(), out_);
        std::fflush(out_);
    }

    Round round_with(int id) const {
        for (const Round& round : store_.rounds()) {
            if (round.id == id) return round;
        }
        throw std::invalid_argument(
            fmt::format("--round: found {}, expected one of the {} rounds in {}",
                        id,
                        store_.rounds().size(),
                        arguments_.ballots));
    }

    Round chosen_round(int seed) {
        if (!arguments_.designs.empty()) return planned_round(seed);
        Round round;
        if (const auto wanted = round_option(arguments_.round)) {
            round = round_with(*wanted);
        } else if (const auto open = store_.open_round()) {
            round = *open;
        } else {
            throw Refused("no round in " + arguments_.ballots + " is open",
                          "open one in the window, or here with --designs A,B,C");
        }
        if (round.closed()) {
            throw Refused(fmt::format("round {} is closed", round.id),
                          "open a new round and vote there");
        }
        if (!round.voting()) {
            throw Refused(fmt::format("round {} is still presented", round.id),
                          "type ballots in when all looks have been shown");
        }
        return round;
    }

    /// As it will be opened: a file of ballots that is no good shall open none.
    Round planned_round(int seed) const {
        Round round;
        round.designs = parse_names("--designs", arguments_.designs);
        const std::size_t designs = round.designs.size();
        check_argument(designs >= 2, "--designs: found 1 name, expected at least 2, with commas");
        const auto rounds = store_.rounds();
        const int next = rounds.empty() ? 1 : rounds.back().id + 1;
        round.seed = seed;
        round.asks_least = arguments_.least;
        round.codes =
            arguments_.codes.empty()
                ? draw_codes(static_cast<int>(designs), static_cast<std::uint64_t>(seed), next)
                : codes_for(designs);
        return round;
    }

    void open_planned() {
        if (arguments_.designs.empty()) return;
        RoundSetup setup;
        setup.designs = round_.designs;
        setup.codes = round_.codes;
        setup.seed = round_.seed;
        setup.asks_least = round_.asks_least;
        round_ = round_with(store_.open_round(setup));
        std::string text = fmt::format("round {}, seed {}\n", round_.id, round_.seed);
        for (std::size_t k = 0; k < round_.designs.size(); ++k) {
            text += fmt::format("{}  {}\n", round_.codes[k], round_.designs[k]);
        }
        say(text);
    }

    std::vector<int> codes_for(std::size_t designs) const {
        std::vector<int> codes;
        for (const double code : parse_numbers("--codes", arguments_.codes, designs)) {
            check_argument(
                code >= 100.0 && code <= 999.0 && code == static_cast<int>(code),
                fmt::format("--codes: found {:g}, expected numbers from 100 to 999", code));
            codes.push_back(static_cast<int>(code));
        }
        return codes;
    }

    void type(const Progress& progress) {
        open_planned();
        PaperTyping typing(store_, round_.id);
        say(fmt::format("Round {}.\n{}", round_.id, typing.help()) + typing.prompt());
        TypedLines lines;
        try {
            while (!typing.done() && !lines.at_end()) {
                progress.check_stop();
                const auto line = lines.next();
                if (!line) continue;
                say(typing.take(*line));
                if (!typing.done()) say(typing.prompt());
            }
        } catch (const Cancelled&) {
            // What was typed whole is a vote.
            say("\n" + typing.finish());
            throw;
        }
        if (!typing.done()) say("\n" + typing.finish());
        for (const PaperTyping::Kept& kept : typing.kept()) {
            add(kept.paper, kept.receipt, kept.replaced);
        }
    }

    /// All or nothing.
    void take_file(const Progress& progress) {
        std::string text, name = arguments_.in;
        if (name.empty() || name == "-") {
            name = "stdin";
            TypedLines lines;
            constexpr std::size_t most = 1u << 20u;
            while (!lines.at_end()) {
                progress.check_stop();
                if (const auto line = lines.next()) text += *line + "\n";
                if (text.size() > most) {
                    throw FileError(name, "", "more than a megabyte", "a line a ballot");
                }
            }
        } else {
            text = read_text_file(name);
        }
        const auto read = parse_paper_ballots(text, name, round_);
        open_planned();
        const auto seats = store_.seats(round_.session);
        const auto papers = numbered(read, next_paper(seats));
        NamedBallots ballots;
        std::vector<bool> replaced;
        for (const PaperBallot& paper : papers) {
            ballots.emplace_back(paper_seat(paper.paper), paper.ballot);
            replaced.push_back(has_voted(seats, ballots.back().first));
        }
        const auto cast = store_.vote(round_.id, ballots);
        for (std::size_t k = 0; k < cast.size(); ++k) {
            add(papers[k].paper, cast[k].receipt, replaced[k]);
        }
    }

    bool has_voted(const std::vector<Seat>& seats, const std::string& name) const {
        for (const Seat& seat : seats) {
            if (seat.name == name) return store_.ballot_of(round_.id, seat.number).has_value();
        }
        return false;
    }

    void add(int paper, const std::string& receipt, bool replaced) {
        papers_.push_back({{"paper", paper}, {"receipt", receipt}, {"replaced", replaced}});
        ++(replaced ? replaced_ : added_);
    }

    Outcome told() {
        Outcome outcome;
        const auto in_all = store_.voted(round_.id).size();
        if (arguments_.lock) store_.close_round(round_.id);
        outcome.figures = {{"ballots", arguments_.ballots},
                           {"round", round_.id},
                           {"added", added_},
                           {"replaced", replaced_},
                           {"ballots_in_round", in_all},
                           {"locked", arguments_.lock},
                           {"papers", papers_}};
        outcome.text = fmt::format("{} added, {} replaced; round {} holds {} ballots{}\n",
                                   added_,
                                   replaced_,
                                   round_.id,
                                   in_all,
                                   arguments_.lock ? " and is locked" : "");
        return outcome;
    }

    VoteArguments arguments_;
    std::FILE* out_;
    BallotStore store_;
    Round round_;
    Json papers_ = Json::array();
    int added_ = 0, replaced_ = 0;
};

void check_vote_options(const VoteArguments& arguments) {
    std::error_code error;
    const bool opens = !arguments.designs.empty();
    check_argument(opens || (arguments.codes.empty() && !arguments.least),
                   "--codes, --least: found without --designs, expected a round to open");
    check_argument(!opens || arguments.round == 0,
                   "--round: found it with --designs, which open a round of their own");
    if (!opens && !std::filesystem::exists(arguments.ballots, error)) {
        throw FileError(arguments.ballots, "", "no such file", "ballots that Livery keeps");
    }
}

}  // namespace

Command evaluate_vote_command() {
    const auto arguments = std::make_shared<VoteArguments>();
    Command command;
    command.name = "evaluate vote";
    command.summary = "types in ballots cast on paper, without a network (phones: evaluate serve)";
    command.example = "livery evaluate vote --ballots votes.livery-ballots";
    command.options = {
        {"--ballots", "FILE", "a file of ballots, whose round is open", &arguments->ballots, true},
        {"--round", "N", "which of its rounds (default: the open one)", &arguments->round},
        {"--in",
         "FILE",
         "take ballots from it, a line each, all or none (default: type them, or the standard "
         "input where that is no terminal)",
         &arguments->in},
        {"--designs",
         "A,B,C",
         "open a round on these looks first; the file is made when it is not there",
         &arguments->designs},
        {"--codes",
         "N,N,...",
         "with --designs: their codes (default: drawn from --seed)",
         &arguments->codes},
        {"--least", "", "with --designs: ask for the least liked look too", &arguments->least},
        {"--lock", "", "lock the round afterwards: no ballot more", &arguments->lock},
    };
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        check_vote_options(*arguments);
        return VoteSession(*arguments, common).run(progress);
    };
    return command;
}

}  // namespace livery
