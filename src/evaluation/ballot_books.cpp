#include "evaluation/ballot_books.h"

#include <algorithm>

#include "core/error.h"
#include "evaluation/typed_words.h"

namespace livery {

namespace {

using RoundEntry = BallotBooks::RoundEntry;

constexpr std::size_t kReceiptDigits = 8;

void check_choices(const Ballot& ballot, const Round& round, const std::string& who) {
    const std::string of = "ballot of " + who + ": ";
    check_argument(ballot.best != ballot.second,
                   of + "found design " + std::to_string(ballot.best) +
                       " as best and as second best, expected two designs");
    check_argument(
        ballot.least == -1 || round.asks_least,
        of + "found a least one, expected none: " + round_name(round.id) + " does not ask for it");
    check_argument(
        ballot.least == -1 || (ballot.least != ballot.best && ballot.least != ballot.second),
        of + "found design " + std::to_string(ballot.least) +
            " as least and as one of the best, expected another");
    const int designs = static_cast<int>(round.designs.size());
    for (const int design :
         {ballot.best, ballot.second, ballot.least == -1 ? ballot.best : ballot.least}) {
        check_argument(design >= 0 && design < designs,
                       of + "found design " + std::to_string(design) + ", expected 0 to " +
                           std::to_string(designs - 1));
    }
}

/// Of the series that `first` began, but for a round that is being opened (0: none is).
Series series_from(const BallotBooks& books, int first, int opening) {
    const RoundEntry& begun = books.round(first);
    Series series{first, begun.round.session, begun.series->repeats, begun.series->follows};
    series.designs = begun.round.designs;
    // Another round, or another audience, has come since: nobody goes on with it.
    bool left = series.session != static_cast<int>(books.sessions.size());
    for (const RoundEntry& entry : books.rounds) {
        if (entry.round.id < first || entry.round.id == opening) continue;
        const bool own = entry.series && entry.series->series == first;
        left = left || !own;
        if (own && entry.round.voting() && entry.round.closed()) {
            series.rounds.push_back(entry.round.id);
        }
    }
    series.over = left || static_cast<int>(series.rounds.size()) >= series.repeats;
    return series;
}

/// What an entry does to the books. Each checks all before it changes anything.
class EntryTaker {
  public:
    EntryTaker(BallotBooks& books, const LogEntry& entry) : books_(books), entry_(entry) {}

    void operator()(const LogEntry::Session&) {
        check_number("session", entry_.session, books_.sessions.size() + 1);
        refuse_open_round("close it before the next audience comes in");
        books_.sessions.emplace_back();
    }

    void operator()(const LogEntry::Seat& seat) {
        const auto& seats = books_.seats(entry_.session);
        check_number("seat", seat.number, seats.size() + 1);
        const std::string key = seat.phone ? phone_seat_key(seat.who) : named_seat_key(seat.who);
        check_argument(books_.seat_with_key(entry_.session, key) == 0,
                       "found a second seat of one evaluator, expected one each");
        books_.sessions.at(static_cast<std::size_t>(entry_.session) - 1)
            .push_back({key, seat.phone ? std::string() : seat.who});
    }

    void operator()(const LogEntry::Open& open) {
        refuse_open_round("close it before opening the next");
        check_number("session", entry_.session, books_.sessions.size());
        check_number("round", entry_.round, books_.rounds.size() + 1);
        Round& round = books_.rounds.emplace_back().round;
        round.id = entry_.round;
        round.session = entry_.session;
        round.created = entry_.at;
        round.calibration_id = open.calibration_id;
        round.asks_least = open.asks_least;
        round.seed = open.seed;
    }

    void operator()(const LogEntry::Design& design) {
        Round& round = being_opened().round;
        check_number("design", design.index, round.designs.size());
        check_argument(!design.name.empty(), "open_round: found a design without a name");
        check_argument(std::find(round.designs.begin(), round.designs.end(), design.name) ==
                           round.designs.end(),
                       "open_round: found \"" + design.name + "\" twice, expected different names");
        check_argument(
            design.code >= 100 && design.code <= 999 &&
                std::find(round.codes.begin(), round.codes.end(), design.code) == round.codes.end(),
            "open_round: found code " + std::to_string(design.code) +
                ", expected different numbers from 100 to 999");
        round.designs.push_back(design.name);
        round.codes.push_back(design.code);
    }

    void operator()(const LogEntry::Scale& scale) {
        Round& round = being_opened().round;
        check_number("scale", scale.index, round.scales.size());
        std::vector<SemanticScale> scales = round.scales;
        scales.push_back(scale.scale);
        check_scales(scales);
        round.scales = std::move(scales);
    }

    void operator()(const LogEntry::Repeat& repeat) {
        RoundEntry& opened = being_opened();
        check_series(opened.round, repeat.place);
        opened.series = repeat.place;
    }

    void operator()(const LogEntry::Plan& plan) {
        RoundEntry& opened = being_opened();
        check_plan(plan.plan, static_cast<int>(opened.round.designs.size()));
        for (const auto& wave : plan.plan.seats) {
            for (const int seat : wave) check_seat(opened.round, seat, "a presentation: ");
        }
        opened.plan = plan.plan;
    }

    void operator()(const LogEntry::Voting&) {
        Round& round = entry_of_round().round;
        refuse_closed(round);
        if (round.voting()) throw Refused(round_name(round.id) + " takes votes already", "vote");
        round.voting_at = entry_.at;
    }

    void operator()(const LogEntry::Shown& shown) {
        RoundEntry& round = entry_of_round();
        if (!round.plan) {
            throw Refused(round_name(entry_.round) + " was opened without a presentation",
                          "lock it, and present its looks anew");
        }
        PresentationState state = shown.state;
        const auto& sittings = round.plan->sittings;
        const auto sitting = static_cast<std::size_t>(state.sitting);
        check_argument(state.sitting >= 0 && state.place >= 0 && sitting < sittings.size() &&
                           static_cast<std::size_t>(state.place) < sittings[sitting].size(),
                       "record_step: found " + text_of(state, shown.event) +
                           ", expected a sitting and a place of the plan");
        // Their clock is of who recorded it.
        state.left_s = state.at_s = 0.0;
        round.steps.push_back({entry_.at, shown.event, state});
    }

    void operator()(const LogEntry::Vote& vote) {
        RoundEntry& entry = entry_of_round();
        const Round& round = entry.round;
        const std::string who = name_of(vote.seat);
        check_choices(vote.ballot, round, who);
        check_seat(round, vote.seat, "ballot of " + who + ": ");
        if (round.closed()) {
            throw Refused(
                round_name(round.id) + " is closed, so the ballot of " + who + " is too late",
                "open a new round and vote there");
        }
        if (!round.voting()) {
            throw Refused(round_name(round.id) + " is still presented, so the ballot of " + who +
                              " is too early",
                          "vote when all looks have been shown");
        }
        if (const Turn turn = books_.turn_of(round.id, vote.seat); !turn.votes) {
            throw Refused("the ballot of " + who + " is too early: its turn comes with group " +
                              std::to_string(turn.wave + 1) + " of " + std::to_string(turn.waves),
                          "vote when that group has seen all looks");
        }
        entry.ballots[vote.seat] = {vote.seat, vote.ballot, entry_.hash.substr(0, kReceiptDigits)};
        entry.round.ballots = static_cast<int>(entry.ballots.size());
    }

    void operator()(const LogEntry::Rating& rating) {
        RoundEntry& entry = entry_of_round();
        const Round& round = entry.round;
        const auto within = [](const char* what, int found, int low, int high) {
            check_argument(found >= low && found <= high,
                           std::string("rate: found ") + what + " " + std::to_string(found) +
                               ", expected " + std::to_string(low) + " to " + std::to_string(high));
        };
        within("design", rating.design, 0, static_cast<int>(round.designs.size()) - 1);
        within("scale", rating.scale, 0, static_cast<int>(round.scales.size()) - 1);
        within("step", rating.step, 0, kScaleSteps);
        if (round.closed()) {
            throw Refused(round_name(round.id) + " is closed, so the answers are too late",
                          "open a new round and answer there");
        }
        if (!entry.ballots.contains(rating.seat)) {
            throw Refused(
                "seat " + std::to_string(rating.seat) + " has not voted in " + round_name(round.id),
                "name the best looks first");
        }
        ScaleAnswers& own =
            entry.ratings
                .try_emplace(rating.seat, round.designs.size(), ScaleSteps(round.scales.size(), 0))
                .first->second;
        own[static_cast<std::size_t>(rating.design)][static_cast<std::size_t>(rating.scale)] =
            rating.step;
        const bool any = std::any_of(own.begin(), own.end(), [](const ScaleSteps& steps) {
            return std::any_of(steps.begin(), steps.end(), [](int step) { return step != 0; });
        });
        if (!any) entry.ratings.erase(rating.seat);
    }

    void operator()(const LogEntry::Close&) {
        Round& round = entry_of_round().round;
        refuse_closed(round);
        round.closed_at = entry_.at;
        round.lock = {entry_.id, entry_.hash};
    }

  private:
    static void check_number(const char* what, int found, std::size_t expected) {
        check_argument(found == static_cast<int>(expected),
                       std::string("found ") + what + " " + std::to_string(found) + ", expected " +
                           std::to_string(expected));
    }
    void refuse_open_round(const char* fix) const {
        if (const Round* open = books_.open_round()) {
            throw Refused(round_name(open->id) + " is still open", fix);
        }
    }
    static void refuse_closed(const Round& round) {
        if (!round.closed()) return;
        throw Refused(round_name(round.id) + " is closed already",
                      "open a new round to vote again");
    }
    RoundEntry& entry_of_round() {
        books_.round(entry_.round);
        return books_.rounds[static_cast<std::size_t>(entry_.round) - 1];
    }
    /// What makes a round comes before anybody votes on it.
    RoundEntry& being_opened() {
        RoundEntry& entry = entry_of_round();
        check_argument(entry.ballots.empty(), "found a round under vote, expected a new one");
        return entry;
    }
    std::string name_of(int seat) const {
        const auto& seats = books_.seats(entry_.session);
        const auto at = static_cast<std::size_t>(seat) - 1;
        return at < seats.size() && !seats[at].is_phone() ? seats[at].name
                                                          : "seat " + std::to_string(seat);
    }
    void check_seat(const Round& round, int seat, const std::string& of) const {
        check_argument(entry_.session == round.session && seat > 0 &&
                           seat <= static_cast<int>(books_.seats(round.session).size()),
                       of + "found no seat " + std::to_string(seat) + " in the session");
    }
    void check_series(const Round& round, const SeriesPlace& place) const {
        check_argument(round.designs.size() == 2,
                       "open_round: found " + std::to_string(round.designs.size()) +
                           " designs in a series of repeats, expected 2");
        check_argument(place.repeats >= 2 && place.repeats <= 99,
                       "open_round: found a series of " + std::to_string(place.repeats) +
                           " repeats, expected 2 to 99");
        if (place.follows != 0 && !books_.round(place.follows).round.closed()) {
            throw Refused(round_name(place.follows) + " is still open", "lock it before its duel");
        }
        if (place.series == round.id) return;
        const auto& first = books_.round(place.series).series;
        check_argument(first && first->series == place.series,
                       "open_round: found " + round_name(place.series) +
                           ", expected the first round of a series");
        const Series series = series_from(books_, place.series, round.id);
        check_argument(series.designs == round.designs && series.repeats == place.repeats &&
                           series.follows == place.follows,
                       "open_round: found another question than that of the series, expected the "
                       "same looks in the same order");
        if (series.over || series.session != round.session) {
            throw Refused("the series that " + round_name(series.id) + " began is over",
                          "begin a new one");
        }
    }

    BallotBooks& books_;
    const LogEntry& entry_;
};

}  // namespace

std::string named_seat_key(const std::string& name) { return "name:" + name_key(name); }
std::string phone_seat_key(const std::string& secret_hash) { return "phone:" + secret_hash; }
std::string round_name(int round) { return "round " + std::to_string(round); }

const RoundEntry& BallotBooks::round(int id) const {
    check_argument(id >= 1 && id <= static_cast<int>(rounds.size()),
                   "found " + round_name(id) + ", expected one of the " +
                       std::to_string(rounds.size()) + " rounds");
    return rounds[static_cast<std::size_t>(id) - 1];
}

const std::vector<BallotBooks::SeatEntry>& BallotBooks::seats(int session) const {
    check_argument(session >= 1 && session <= static_cast<int>(sessions.size()),
                   "found session " + std::to_string(session) + ", expected one of " +
                       std::to_string(sessions.size()));
    return sessions[static_cast<std::size_t>(session) - 1];
}

int BallotBooks::seat_with_key(int session, const std::string& key) const {
    const auto& all = seats(session);
    const auto found = std::find_if(
        all.begin(), all.end(), [&](const SeatEntry& seat) { return seat.key == key; });
    return found == all.end() ? 0 : static_cast<int>(found - all.begin()) + 1;
}

const Round* BallotBooks::open_round() const {
    // Nobody opens one while another is open.
    return rounds.empty() || rounds.back().round.closed() ? nullptr : &rounds.back().round;
}

Turn BallotBooks::turn_of(int id, int seat) const {
    const RoundEntry& entry = round(id);
    if (!entry.plan) return {};
    const auto& waves = entry.plan->seats;
    const auto own = std::find_if(waves.begin(), waves.end(), [&](const std::vector<int>& wave) {
        return std::find(wave.begin(), wave.end(), seat) != wave.end();
    });
    if (own == waves.end()) return {};
    Turn turn{static_cast<int>(own - waves.begin()), static_cast<int>(waves.size()), false, false};
    for (const PresentationStep& step : entry.steps) {
        const bool votes = step.state.phase == PresentationPhase::voting;
        turn.votes = turn.votes || (votes && step.state.sitting == turn.wave);
        turn.sits = turn.sits || turn.votes || step.state.sitting >= turn.wave;
    }
    // The first wave sits down as soon as the round is opened.
    turn.sits = turn.sits || turn.wave == 0;
    return turn;
}

std::optional<Series> BallotBooks::series_of(int id) const {
    const auto& place = round(id).series;
    if (!place) return std::nullopt;
    return series_from(*this, place->series, 0);
}

void apply(BallotBooks& books, const LogEntry& entry) {
    std::visit(EntryTaker(books, entry), entry.what);
}

}  // namespace livery
