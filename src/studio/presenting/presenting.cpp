#include "studio/presenting/presenting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/log.h"
#include "evaluation/presentation_order.h"
#include "studio/presenting/surround.h"

namespace livery {

namespace {

/// A presentation does not wait for what only its report needs.
RoundDetails known_details(const std::filesystem::path& file,
                           int round,
                           const std::vector<int>& codes) {
    try {
        return read_round_details(file, round, codes);
    } catch (const std::exception& error) {
        log_line(LogLevel::warning, error.what());
        return {};
    }
}

using Phase = PresentationPhase;

constexpr double kBetweenReadings_s = 0.5;

/// ";cheap,precious;cold,warm;" as the settings keep it. What a hand has broken there is left out.
std::vector<SemanticScale> listed_scales(std::string_view list) {
    std::vector<SemanticScale> scales;
    while (!list.empty()) {
        const std::size_t end = std::min(list.find(';'), list.size());
        const std::string_view one = list.substr(0, end);
        list.remove_prefix(std::min(end + 1, list.size()));
        if (one.empty()) continue;
        try {
            auto more = scales;
            more.push_back(parse_scale(one));
            check_scales(more);
            scales = std::move(more);
        } catch (const std::invalid_argument& error) {
            log_line(LogLevel::warning, std::string("settings: ") + error.what());
        }
    }
    return scales;
}

std::filesystem::path folder_of(const Studio& studio, const PresentationPlan& plan) {
    return studio.ballots->file().parent_path() / plan.folder;
}

/// Which of a duel's blind repeats it is; empty: of none.
std::string repeat_in_words(const BallotStore& ballots, int round) {
    const auto series = ballots.series_of(round);
    if (!series) return "";
    const auto held = static_cast<std::size_t>(std::count_if(
        series->rounds.begin(), series->rounds.end(), [&](int other) { return other < round; }));
    return fmt::format(": repeat {} of {} of a duel", held + 1, series->repeats);
}

}  // namespace

PresentingState& presenting(Studio& studio) { return studio.panels.of<PresentingState>(); }
const PresentingState& presenting(const Studio& studio) {
    return studio.panels.of<PresentingState>();
}

std::string session_name(const Studio& studio) {
    const auto file = studio.session.file();
    if (!file) return "";
    std::error_code error;
    const auto whole = std::filesystem::weakly_canonical(*file, error);
    return (error ? *file : whole).string();
}

std::vector<std::vector<int>> sittings_of(const PresentingSettings& settings,
                                          int designs,
                                          int seed,
                                          int phones) {
    const auto number = static_cast<std::uint64_t>(seed);
    const int evaluators = phones > 0 ? phones : settings.evaluators;
    return settings.waves ? wave_sittings(designs, evaluators, settings.wave_size, number)
                          : pass_sitting(designs, settings.passes, number);
}

std::vector<SemanticScale> scales_asked(const PresentingSettings& settings) {
    return settings.asks_scales ? settings.scales : std::vector<SemanticScale>();
}

std::vector<int> phones_in(const std::vector<Seat>& seats) {
    std::vector<int> phones;
    for (const Seat& seat : seats) {
        if (seat.name.empty()) phones.push_back(seat.number);
    }
    return phones;
}

std::vector<std::string> waves_in_words(const std::vector<std::vector<int>>& seats) {
    std::vector<std::string> lines;
    for (std::size_t wave = 0; seats.size() > 1 && wave < seats.size(); ++wave) {
        const auto& numbers = seats[wave];
        lines.push_back(numbers.empty() ? fmt::format("Wave {}: no phones", wave + 1)
                                        : fmt::format("Wave {}: {} {}",
                                                      wave + 1,
                                                      numbers.size() == 1 ? "seat" : "seats",
                                                      fmt::join(numbers, ", ")));
    }
    return lines;
}

bool sits_later(const PresentingState& state, int seat) {
    if (!state.presented) return false;
    const auto& waves = state.presented->plan.seats;
    for (auto k = static_cast<std::size_t>(state.presented->state.sitting) + 1; k < waves.size();
         ++k) {
        if (std::find(waves[k].begin(), waves[k].end(), seat) != waves[k].end()) return true;
    }
    return false;
}

bool has_voted(const PresentingState& state, int seat) {
    return std::find(state.voted.begin(), state.voted.end(), seat) != state.voted.end();
}

VotesSoFar votes_so_far(const PresentingState& state) {
    VotesSoFar so_far;
    so_far.voted = state.voted.size();
    for (const Seat& seat : state.seats) {
        // Who was typed in for an earlier round need not be in this one.
        if (!seat.name.empty() && !has_voted(state, seat.number)) continue;
        ++(sits_later(state, seat.number) ? so_far.later : so_far.awaited);
    }
    return so_far;
}

std::string question_in_words(const PresentingState& state) {
    if (state.asking_to_abort) return "Abort it? Nobody votes on this round.";
    if (!state.asking_to_lock || !state.presented) return "";
    const VotesSoFar so_far = votes_so_far(state);
    const std::size_t open =
        so_far.awaited > so_far.voted ? so_far.awaited - so_far.voted : std::size_t{0};
    const auto waves = static_cast<int>(state.presented->plan.sittings.size());
    const int unseen = waves - 1 - state.presented->state.sitting;
    std::string words = "Lock it for good?";
    if (open > 0) {
        words += fmt::format(" {} {} not voted yet.", open, open == 1 ? "seat has" : "seats have");
    }
    if (unseen > 0) {
        words += fmt::format(
            " {} {} not seen the looks.", unseen, unseen == 1 ? "wave has" : "waves have");
    }
    return words;
}

PresentingSettings& presenting_settings(Studio& studio) {
    PresentingState& state = presenting(studio);
    PresentingSettings& settings = state.settings;
    if (std::exchange(state.settings_read, true)) return settings;
    const UserSettings& kept = studio.settings;
    restore(setting(kept, "presenting-adapt-s"), settings.times.adapt_s, 0.2, 3600.0);
    restore(setting(kept, "presenting-look-s"), settings.times.look_s, 0.2, 3600.0);
    restore(setting(kept, "presenting-grey-s"), settings.times.grey_s, 0.2, 3600.0);
    restore(setting(kept, "presenting-passes"), settings.passes, 0, 52);
    restore(setting(kept, "presenting-evaluators"), settings.evaluators, 1, 1000);
    restore(setting(kept, "presenting-wave-size"), settings.wave_size, 1, 1000);
    restore(setting(kept, "phones-port"), settings.port, 0, 65535);
    settings.waves = setting(kept, "presenting-waves") == "yes";
    settings.asks_least = setting(kept, "presenting-least") == "yes";
    settings.asks_scales = setting(kept, "presenting-asks-scales") == "yes";
    if (const std::string list = setting(kept, "presenting-scales"); !list.empty()) {
        settings.scales = listed_scales(list);
    }
    int seed = -1;
    restore(setting(kept, "presenting-seed"), seed, 0, 1 << 30);
    if (seed >= 0) settings.seed = seed;
    if (const std::string network = setting(kept, "phones-network"); !network.empty()) {
        settings.network = network;
    }
    return settings;
}

void keep_presenting_settings(Studio& studio) {
    const PresentingSettings& settings = presenting_settings(studio);
    const auto keep = [&](const char* name, const std::string& value) {
        if (setting(studio.settings, name) != value) keep_setting(studio.settings, name, value);
    };
    keep("presenting-adapt-s", fmt::format("{:g}", settings.times.adapt_s));
    keep("presenting-look-s", fmt::format("{:g}", settings.times.look_s));
    keep("presenting-grey-s", fmt::format("{:g}", settings.times.grey_s));
    keep("presenting-passes", fmt::format("{}", settings.passes));
    keep("presenting-evaluators", fmt::format("{}", settings.evaluators));
    keep("presenting-wave-size", fmt::format("{}", settings.wave_size));
    keep("presenting-waves", settings.waves ? "yes" : "no");
    keep("presenting-least", settings.asks_least ? "yes" : "no");
    keep("presenting-asks-scales", settings.asks_scales ? "yes" : "no");
    // A list without any is kept too.
    std::string scales = ";";
    for (const SemanticScale& scale : settings.scales) scales += text_of(scale) + ";";
    keep("presenting-scales", scales);
    keep("phones-network", settings.network);
}

bool is_presenting(const Studio& studio) {
    const PresentingState& state = presenting(studio);
    return state.freezing || state.presented;
}

std::optional<Notice> why_no_editing(const Studio& studio) {
    const PresentingState& state = presenting(studio);
    const auto refused = [&](std::string why, const char* fix) {
        return Notice{Notice::Level::warning,
                      "Nothing can be changed now.",
                      std::move(why),
                      fix,
                      studio.now_s + 8.0};
    };
    if (state.freezing) {
        return refused("The looks are being frozen for a vote.",
                       "Wait for them, or cancel it in the bar at the top.");
    }
    if (!state.presented) return std::nullopt;
    const Round& round = state.presented->round;
    if (state.presented->state.phase == Phase::locked) {
        return refused(fmt::format("Round {} is locked, and its result is on show.", round.id),
                       "Go back to editing in the bar at the top.");
    }
    return refused(
        fmt::format("Round {} is being presented and voted on: people judge frozen looks.",
                    round.id),
        round.voting() ? "Lock the round in the bar at the top."
                       : "Abort the round in the bar at the top.");
}

PresentationPhase phase_of(const Studio& studio) {
    const PresentingState& state = presenting(studio);
    return state.presented ? state.presented->state.phase : Phase::edit;
}

std::optional<int> code_on_show(const Studio& studio) {
    const PresentingState& state = presenting(studio);
    if (!state.presented) return {};
    const int design = design_of(state.presented->plan, state.presented->state);
    if (design < 0) return {};
    return state.presented->round.codes.at(static_cast<std::size_t>(design));
}

void send(Studio& studio, PresentationEvent event) {
    PresentingState& state = presenting(studio);
    if (!state.presented || !studio.ballots) return;
    PresentedRound& presented = *state.presented;
    // Without its frames nothing is shown, so no time goes by either.
    const bool needs_frames = event == PresentationEvent::pause && presented.state.paused;
    if (needs_frames && presented.frames.empty()) return;
    const PresentationState next = after(presented.plan, presented.state, event, studio.now_s);
    if (next == presented.state) return;
    try {
        studio.ballots->record_step(presented.round.id, next, event);
    } catch (const std::exception& error) {
        tell_error(studio,
                   "The presentation stands still.",
                   std::string(error.what()),
                   "Make it possible to write the ballots' file, then go on.");
        // Asked again by the operator, not sixty times a second.
        if (event == PresentationEvent::tick) presented.state.paused = true;
        return;
    }
    log_line(LogLevel::info, fmt::format("round {}: {}", presented.round.id, text_of(next, event)));
    // Time going by answers no question.
    const bool asks_still = event == PresentationEvent::tick && next.phase == presented.state.phase;
    if (!asks_still) state.asking_to_abort = state.asking_to_lock = false;
    presented.state = next;
    presented.round = studio.ballots->round(presented.round.id);
    read_seats(studio, true);
    if (next.phase == Phase::edit) state.presented.reset();
}

void take_round(Studio& studio, Round round, PresentationPlan plan, PresentationState state) {
    PresentingState& presenting_state = presenting(studio);
    presenting_state.problem.clear();
    PresentedRound& presented = presenting_state.presented.emplace();
    presented.round = std::move(round);
    if (studio.ballots) presented.repeat = repeat_in_words(*studio.ballots, presented.round.id);
    presented.plan = std::move(plan);
    presented.state = state;
    const int id = presented.round.id;
    read_seats(studio, true);
    if (!studio.background) return;
    studio.background->run(
        [&studio,
         id,
         folder = folder_of(studio, presented.plan),
         hashes = presented.plan.frames,
         codes = presented.round.codes,
         details_file =
             round_details_file(studio.ballots->file(), id)](const Progress&) -> Background::Then {
            const auto details = known_details(details_file, id, codes);
            auto frames = std::make_shared<VoteFrames>(read_vote_frames(folder, hashes));
            auto lit = std::make_shared<Image8>();
            for (const auto& [name, frame] : *frames) add_lit_pixels(*frame, *lit);
            return [&studio, id, frames, lit, details] {
                auto& shown = presenting(studio).presented;
                if (!shown || shown->round.id != id) return;
                shown->details = details;
                shown->frames = std::move(*frames);
                shown->lit = std::move(*lit);
                shown->place = free_place(shown->lit, kNumberPlaceAspect);
                // Its time begins now that it can be seen.
                shown->state.at_s = studio.now_s;
            };
        },
        [&studio](std::exception_ptr why) {
            presenting(studio).problem = in_words(why);
            notify_failure(studio, "The frozen frames cannot be shown.", why);
        });
}

void find_presented_round(Studio& studio) {
    if (!studio.ballots) return;
    try {
        auto found = studio.ballots->presented();
        if (!found || found->plan.session != session_name(studio)) return;
        const PresentationState state =
            after(found->plan, found->step.state, PresentationEvent::resume, studio.now_s);
        const int id = found->round.id;
        studio.ballots->record_step(id, state, PresentationEvent::resume);
        log_line(LogLevel::info, fmt::format("round {} goes on: {}", id, to_string(state.phase)));
        take_round(studio, std::move(found->round), std::move(found->plan), state);
        const std::size_t phones = phones_in(presenting(studio).seats).size();
        tell_info(
            studio,
            fmt::format("Round {} goes on where it was.", id),
            state.paused ? "It is paused: Go on, or the space bar, goes on." : "",
            phones == 0 || state.phase == Phase::locked
                ? std::string()
                : fmt::format("{} that had joined cannot vote until you press Let phones vote.",
                              phones == 1 ? "A phone" : fmt::format("{} phones", phones)),
            studio.now_s + 20.0);
    } catch (const std::exception&) {
        notify_failure(
            studio, "The round that was under way cannot go on.", std::current_exception());
    }
}

void read_seats(Studio& studio, bool now) {
    PresentingState& state = presenting(studio);
    const bool due =
        now || state.seats_read_s < 0.0 || studio.now_s - state.seats_read_s >= kBetweenReadings_s;
    if (!studio.ballots || !due) return;
    state.seats_read_s = studio.now_s;
    try {
        const auto session = studio.ballots->session();
        state.seats = session ? studio.ballots->seats(*session) : std::vector<Seat>();
        state.invitation = session ? studio.ballots->invitation(*session) : std::nullopt;
        state.voted =
            state.presented ? studio.ballots->voted(state.presented->round.id) : std::vector<int>();
        if (!state.presented || state.presented->state.phase != Phase::voting) return;
        // Another program may have locked it.
        if (!studio.ballots->open_round()) {
            state.presented->state.phase = Phase::locked;
            state.presented->round = studio.ballots->round(state.presented->round.id);
        }
    } catch (const std::exception& error) {
        state.problem = error.what();
    }
}

void serve_phones(Studio& studio, bool on) {
    PresentingState& state = presenting(studio);
    state.phones_problem.clear();
    state.phones.reset();
    if (!on) {
        state.phones_place.reset();
        state.qr_projected = false;
        log_line(LogLevel::info, "phones: off");
        return;
    }
    try {
        BallotProcessOptions options;
        options.ballots = studio.ballots->file();
        options.interface = presenting_settings(studio).network;
        // Started anew it is where it was: the QR code on the wall stays good.
        options.port =
            state.phones_place ? state.phones_place->port : presenting_settings(studio).port;
        state.phones = std::make_unique<BallotProcess>(options);
    } catch (const std::exception& error) {
        state.phones_problem = error.what();
        state.qr_projected = false;
    }
}

void watch_phones(Studio& studio) {
    PresentingState& state = presenting(studio);
    if (!state.phones) return;
    try {
        if (state.phones->place()) {
            if (!state.phones->running()) serve_phones(studio, true);
            return;
        }
        if (!state.phones->listens_within(std::chrono::milliseconds(0))) return;
    } catch (const std::exception& error) {
        state.phones.reset();
        state.phones_place.reset();
        state.phones_problem = error.what();
        state.qr_projected = false;
        return;
    }
    const bool anew = std::exchange(state.phones_place, state.phones->place()).has_value();
    log_line(LogLevel::info, "phones: " + url_of(*state.phones_place));
    keep_presenting_settings(studio);
    read_seats(studio, true);
    if (!anew) return;
    tell_warning(studio,
                 "The phones' server had ended; it was started again.",
                 "No vote is lost.",
                 "",
                 studio.now_s + 15.0);
}

std::string time_in_words(double seconds) {
    const int whole = static_cast<int>(std::ceil(seconds - 1e-6));
    return whole < 60 ? fmt::format("{} s", whole)
                      : fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace livery
