// livery evaluate serve

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/evaluate/commands.h"
#include "core/error.h"
#include "evaluation/ballots.h"
#include "evaluation/duel.h"
#include "evaluation/phone_page.h"
#include "evaluation/presentation_order.h"

namespace livery {

namespace {

/// For a busy machine to start the server.
constexpr std::chrono::seconds kPatience{60};

struct ServeArguments {
    std::string ballots, interface = "lo", designs, certificate, key;
    std::vector<std::string> hosts, scales;
    int port = kBallotPort, seats = 40;
    bool least = false, duel = false, new_audience = false;
};

std::vector<SemanticScale> scales_of(const ServeArguments& arguments) {
    std::vector<SemanticScale> scales;
    for (const std::string& text : arguments.scales) {
        try {
            scales.push_back(parse_scale(text));
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(std::string("--scale: ") + error.what());
        }
    }
    check_scales(scales);
    return scales;
}

/// What people read goes to stdout, or beside the JSON document to stderr; at once.
class ServeSession {
  public:
    ServeSession(const ServeArguments& arguments, const CommonOptions& common)
        : arguments_(arguments),
          seed_(common.seed_given ? std::optional<int>(common.seed) : std::nullopt),
          out_(common.json ? stderr : stdout),
          store_(arguments.ballots) {
        // What cannot be begun is said before anybody joins.
        if (arguments.duel) next_repeat(store_, duelled_round(), seed());
        if (arguments.new_audience && store_.session()) store_.open_session();
        start();
        say(words_for(place()));
    }

    Outcome run(const Progress& progress) {
        TypedLines lines;
        say(next_step());
        for (bool over = false; !over;) {
            progress.check_stop();
            const auto line = lines.next();
            look();
            if (!line) continue;
            if (*line == "q") {
                over = true;
            } else if (line->empty()) {
                go_on();
            } else {
                say("Enter goes on, q and Enter ends.\n");
            }
        }
        return told();
    }

  private:
    /// start() has waited for it.
    const BallotServerPlace& place() const { return server_->place().value(); }

    void say(const std::string& text) {
        std::fputs(text.c_str(), out_);
        std::fflush(out_);
    }

    void start() {
        BallotProcessOptions options;
        options.ballots = arguments_.ballots;
        options.interface = arguments_.interface;
        // Started anew it is where it was: the QR code on the wall stays good.
        if (server_) arguments_.port = place().port;
        options.port = arguments_.port;
        options.hosts = arguments_.hosts;
        options.certificate = arguments_.certificate;
        options.key = arguments_.key;
        options.seats = arguments_.seats;
        server_.reset();
        server_ = std::make_unique<BallotProcess>(options);
        if (!server_->listens_within(kPatience)) {
            throw std::runtime_error("livery-ballots: found no answer within a minute");
        }
    }

    /// Says what has changed since the last look.
    void look() {
        if (!server_->running()) {
            say("The ballots' server has ended; it is started again. No vote is lost.\n");
            start();
        }
        const int session = store_.session().value();
        if (const auto invitation = store_.invitation(session);
            invitation && invitation->code != shown_code_ && !store_.open_round()) {
            if (shown_code_.empty() || session != shown_session_) show_qr_code(invitation->token);
            shown_code_ = invitation->code;
            shown_session_ = session;
            say(fmt::format("join code {} {}\n", shown_code_.substr(0, 4), shown_code_.substr(4)));
        }
        const std::size_t seats = store_.seats(session).size();
        const auto round = store_.open_round();
        const std::string words = round && round->voting()
                                      ? fmt::format("{} of {} have voted\n", round->ballots, seats)
                                      : fmt::format("{} have joined\n", seats);
        if (words != last_words_ && (seats > 0 || !last_words_.empty())) say(words);
        last_words_ = words;
    }

    void show_qr_code(const std::string& token) {
        const std::string url = join_url(place(), token);
        if (::isatty(::fileno(out_)) == 1) say(qr_text(qr_code(url)));
        say("join at " + url + "\n");
    }

    bool leads() const { return arguments_.duel || !arguments_.designs.empty(); }

    /// Whose leaders meet, or a repeat of a duel that is under way.
    int duelled_round() const {
        if (const auto series = store_.series_under_way()) return series->id;
        const auto rounds = store_.rounds();
        const auto found = std::find_if(rounds.rbegin(), rounds.rend(), [&](const Round& round) {
            return round.closed() && round.voting() && !store_.series_of(round.id);
        });
        if (found == rounds.rend()) {
            throw Refused("no round in " + store_.file().string() + " is locked, so no looks lead",
                          "vote on looks first, with --designs");
        }
        return found->id;
    }

    /// "repeat 2 of 3", of the round that is open or comes next.
    std::string repeat_in_words() const {
        const auto series = store_.series_under_way();
        return fmt::format("repeat {} of {}",
                           series ? series->rounds.size() + 1 : 1,
                           series ? series->repeats : kDuelRepeats);
    }

    std::string next_step() const {
        if (arguments_.duel && !store_.open_round()) {
            if (duel_told_) return "The duel is over. q and Enter ends.\n";
            return "Enter: present the two looks, " + repeat_in_words() + ".\n";
        }
        if (!leads()) {
            return "Rounds are opened, presented and locked in the window. q and Enter ends.\n";
        }
        const auto round = store_.open_round();
        if (!round) return "Enter: present the looks, and let nobody else in.\n";
        return round->voting() ? "Enter: lock the round and count.\n"
                               : "Enter: the looks have been shown, votes count.\n";
    }

    void go_on() {
        const auto round = store_.open_round();
        if (!leads() || (!round && duel_told_)) return say(next_step());
        if (!round) {
            store_.open_round(next_setup());
            const Round opened = store_.open_round().value();
            say(fmt::format("round {}, seed {}\n", opened.id, opened.seed));
            for (std::size_t k = 0; k < opened.designs.size(); ++k) {
                say(fmt::format("{}  {}\n", opened.codes[k], opened.designs[k]));
            }
        } else if (!round->voting()) {
            store_.start_voting(round->id);
        } else {
            store_.close_round(round->id);
            locked_.insert(round->id);
            say(fmt::format("round {} is locked: {} ballots\n", round->id, round->ballots));
            tell(round->id);
        }
        say(next_step());
    }

    int seed() const { return seed_ ? *seed_ : random_seed(); }

    RoundSetup next_setup() const {
        if (arguments_.duel) return next_repeat(store_, duelled_round(), seed());
        RoundSetup setup;
        setup.designs = parse_names("--designs", arguments_.designs);
        setup.seed = seed();
        setup.asks_least = arguments_.least;
        setup.scales = scales_of(arguments_);
        setup.presenting = true;
        return setup;
    }

    /// Of repeats nothing is told before the last one.
    void tell(int round) {
        const auto series = store_.series_of(round);
        if (!series) return say(tally_csv(store_.round(round).designs, store_.tally(round)));
        if (!series->over) return say("Its counts are told with those of the last repeat.\n");
        duel_told_ = duel_of(store_, round);
        say(text_of(*duel_told_));
    }

    Outcome told() {
        Outcome outcome;
        const int session = store_.session().value();
        outcome.figures = {{"ballots", arguments_.ballots},
                           {"url", url_of(place())},
                           {"interface", place().interface},
                           {"tls", place().tls},
                           {"session", session},
                           {"seats", store_.seats(session).size()},
                           {"rounds", Json::array()}};
        for (const Round& round : store_.rounds()) {
            if (!locked_.contains(round.id)) continue;
            if (const auto series = store_.series_of(round.id); series && !series->over) continue;
            const VoteCounts tally = store_.tally(round.id);
            Json json = {{"id", round.id},
                         {"seed", round.seed},
                         {"designs", round.designs},
                         {"codes", round.codes},
                         {"ballots", round.ballots},
                         {"best", tally.best},
                         {"second", tally.second}};
            if (round.asks_least) json["least"] = tally.least;
            outcome.figures["rounds"].push_back(json);
        }
        if (duel_told_) outcome.figures["series"] = figures_of(*duel_told_);
        if (const auto open = store_.open_round()) {
            outcome.text = fmt::format("Round {} stays open.\n", open->id);
        }
        return outcome;
    }

    ServeArguments arguments_;
    std::optional<int> seed_;  ///< nothing: each round draws its own
    std::FILE* out_;
    BallotStore store_;
    std::unique_ptr<BallotProcess> server_;
    std::string shown_code_, last_words_;
    int shown_session_ = 0;
    std::set<int> locked_;
    std::optional<DuelRecord> duel_told_;
};

}  // namespace

Command evaluate_serve_command() {
    const auto arguments = std::make_shared<ServeArguments>();
    Command command;
    command.name = "evaluate serve";
    command.summary = "people vote with their phones, by QR code";
    command.example =
        "livery evaluate serve --ballots ballots.sqlite --designs red,silver,ivory --interface "
        "wlan0";
    command.options = {
        {"--ballots",
         "FILE",
         "where votes are kept, made when it is not there",
         &arguments->ballots,
         true},
        {"--designs",
         "A,B,C",
         "looks under vote: Enter presents them, lets people vote, locks (default: the window "
         "does); their codes are drawn anew each time, but for --seed",
         &arguments->designs},
        {"--least", "", "ask for the least liked look too", &arguments->least},
        {"--scale",
         "LOW,HIGH",
         "after the ballot phones ask where each look lies between two words, as cheap,precious; "
         "up to five times",
         &arguments->scales},
        {"--duel",
         "",
         "instead of --designs: three blind repeats of the first two looks of the last locked "
         "round",
         &arguments->duel},
        {"--new-audience",
         "",
         "let phones join anew (default: who was in is in)",
         &arguments->new_audience},
        {"--interface",
         "NAME",
         "network to listen on (default lo: this machine alone)",
         &arguments->interface},
        {"--port", "N", "default 8470; 0: any that is free", &arguments->port},
        {"--host",
         "NAME",
         "a further name of this machine, which the QR code then holds",
         &arguments->hosts},
        {"--certificate", "FILE", "with --key: PEM, for HTTPS", &arguments->certificate},
        {"--key", "FILE", "the certificate's private key", &arguments->key},
        {"--seats",
         "N",
         "phones, 1 to 400 (default 40), apart from the first one at an address",
         &arguments->seats},
    };
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        check_argument(scales_of(*arguments).empty() || !arguments->designs.empty(),
                       "--scale: found it without --designs, expected the looks that are placed");
        check_argument(!arguments->duel || (arguments->designs.empty() && !arguments->least &&
                                            !arguments->new_audience),
                       "--duel: found it with --designs, --least or --new-audience, expected it "
                       "without: it is of two looks that this audience has voted on");
        if (!arguments->designs.empty() &&
            parse_names("--designs", arguments->designs).size() < 2) {
            throw std::invalid_argument(
                "--designs: found 1 name, expected at least 2, with commas");
        }
        return ServeSession(*arguments, common).run(progress);
    };
    return command;
}

}  // namespace livery
