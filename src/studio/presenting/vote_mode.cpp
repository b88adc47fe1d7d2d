// A vote in the running window: freezing looks, and what the projector shows of them.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "core/error.h"
#include "core/log.h"
#include "core/paths.h"
#include "core/time.h"
#include "evaluation/duel.h"
#include "evaluation/phone_page.h"
#include "evaluation/presentation_order.h"
#include "live/frame_pictures.h"
#include "live/vote_frames.h"
#include "projection/projector_screen.h"
#include "studio/drawing.h"
#include "studio/looks/look_thumbnails.h"
#include "studio/presenting/ballot_panel.h"
#include "studio/presenting/presenting.h"
#include "studio/presenting/round_files.h"
#include "studio/presenting/surround.h"
#include "studio/studio.h"

namespace livery {

namespace {

using Phase = PresentationPhase;
using Event = PresentationEvent;

constexpr double kBarStep_s = 0.25, kLook_s = 0.5;
constexpr int kBarSteps = 40;

void show_what_is_due(Studio& studio);

// --- freezing ---

/// For those who are in now.
std::vector<std::vector<int>> sittings_now(Studio& studio, const RoundSetup& setup) {
    return sittings_of(presenting_settings(studio),
                       static_cast<int>(setup.designs.size()),
                       setup.seed,
                       static_cast<int>(phones_in(presenting(studio).seats).size()));
}

void check_nothing_open(const Studio& studio) {
    const auto open = studio.ballots->open_round();
    if (!open) return;
    throw Refused(fmt::format("round {} is still open", open->id),
                  "close it before the next one is presented");
}

/// With its looks and what the round asks; the order follows from who is in.
void begin_freezing(Studio& studio, Freezing freezing) {
    PresentingState& state = presenting(studio);
    const PresentingSettings& settings = presenting_settings(studio);
    if (!studio.setup)
        throw Refused("there is no projector to draw for", "wait for it, or pick one");
    RoundSetup& setup = freezing.setup;
    setup.calibration_id = studio.setup->calibration ? studio.setup->calibration->id : "";
    PresentationPlan& plan = setup.plan.emplace();
    read_seats(studio, true);
    plan.sittings = sittings_now(studio, setup);
    plan.times = settings.times;
    plan.session = session_name(studio);
    check_plan(plan, static_cast<int>(setup.designs.size()));
    freezing.projector = studio.setup;
    freezing.kept_frozen = studio.frozen;
    keep_presenting_settings(studio);

    // The audience sees nothing of it.
    show_signal_test(studio, false);
    stop_trying(studio);
    studio.wiping = studio.showing_b = false;
    studio.glowing_part.reset();
    set_frozen(studio, true);
    state.qr_projected = false;
    state.problem.clear();
    state.freezing = std::move(freezing);
    log_line(LogLevel::info, fmt::format("freezing {} looks", state.freezing->looks.size()));
}

void begin_presentation(Studio& studio) {
    PresentingState& state = presenting(studio);
    const PresentingSettings& settings = presenting_settings(studio);
    if (!studio.ballots || is_presenting(studio)) return;
    check_nothing_open(studio);
    Freezing freezing;
    freezing.looks = state.wanted_looks;
    RoundSetup& setup = freezing.setup;
    for (const int id : freezing.looks) {
        const SessionLook* look = find_look(studio.session.document(), id);
        if (look) setup.designs.push_back(look->look.name);
    }
    setup.presenting = true;
    setup.asks_least = settings.asks_least && setup.designs.size() > 2;
    setup.scales = scales_asked(settings);
    setup.seed = settings.seed.value_or(random_seed());
    begin_freezing(studio, std::move(freezing));
}

/// The two looks that lead a locked round, or the next repeat of their duel.
void begin_duel(Studio& studio, int round) {
    if (!studio.ballots) return;
    const int seed = presenting_settings(studio).seed.value_or(random_seed());
    Freezing freezing;
    freezing.setup = next_repeat(*studio.ballots, round, seed);
    for (const std::string& name : freezing.setup.designs) {
        const SessionLook* look = look_named(studio.session.document(), name);
        if (!look) {
            throw Refused("the session has no look \"" + name + "\" any more",
                          "give the look its name back");
        }
        freezing.looks.push_back(look->id);
    }
    check_nothing_open(studio);
    if (phase_of(studio) == Phase::locked) send(studio, Event::done);
    if (!is_presenting(studio)) begin_freezing(studio, std::move(freezing));
}

void end_freezing(Studio& studio) {
    PresentingState& state = presenting(studio);
    if (!state.freezing) return;
    set_frozen(studio, state.freezing->kept_frozen);
    state.freezing.reset();
    studio.asked_frame.reset();
}

void give_up_freezing(Studio& studio, std::exception_ptr why) {
    end_freezing(studio);
    notify_failure(studio, "The looks could not be frozen; nothing is presented.", why);
}

/// White, the grey of all looks, and one for each two that follow one another: each as bright as
/// the mean of what its looks want.
VoteFrames with_greys(const Freezing& freezing) {
    VoteFrames frames = freezing.frames;
    const auto neutral = [&](double luminance) {
        return std::make_shared<const Image8>(
            neutral_drive(*freezing.frozen.back().wanted_working, luminance, *freezing.projector));
    };
    const auto& luminances = freezing.luminances;
    const double sum = std::accumulate(luminances.begin(), luminances.end(), 0.0);
    frames[kWhiteFrame] = neutral(1.0);
    frames[kRestFrame] = neutral(sum / static_cast<double>(luminances.size()));
    for (const auto& sitting : freezing.setup.plan->sittings) {
        for (std::size_t k = 1; k < sitting.size(); ++k) {
            const std::string name = frame_of_grey(sitting[k - 1], sitting[k]);
            if (frames.contains(name)) continue;
            frames[name] = neutral(0.5 * (luminances[static_cast<std::size_t>(sitting[k - 1])] +
                                          luminances[static_cast<std::size_t>(sitting[k])]));
        }
    }
    return frames;
}

std::string folder_name(const RoundSetup& setup) {
    std::string name = utc_now_ms();
    std::replace(name.begin(), name.end(), ':', '-');
    return fmt::format("frames/{}-{:08x}", name, static_cast<unsigned>(setup.seed));
}

/// For its report; and what cannot be shown fairly is named before anybody judges it.
void keep_frozen_looks(Studio& studio, const Freezing& freezing, int id) {
    const Round round = studio.ballots->open_round().value();
    in_background(
        studio,
        "Pictures for the round's report were not kept.",
        [&studio,
         id,
         round,
         ballots = studio.ballots->file(),
         looks = freezing.frozen,
         setup = freezing.projector,
         eye = eye_of_round(studio.session.document())](const Progress&) -> Background::Then {
            const RoundDetails details = write_frozen_looks(ballots, round, looks, *setup, eye);
            return [&studio, id, details] {
                auto& presented = presenting(studio).presented;
                if (!presented || presented->round.id != id) return;
                presented->details = details;
                const std::vector<int> unfair = unfair_looks(details);
                if (unfair.empty()) return;
                tell_warning(studio,
                             fmt::format("This projector cannot show {} as wanted.",
                                         fmt::join(unfair, ", ")),
                             "Whoever judges it judges something else; the panel says how far off.",
                             "Abort the round and lower the exposure, or darken the room.");
            };
        });
}

/// Everything is rendered: to the disk, and then the round begins.
void write_and_begin(Studio& studio) {
    const auto freezing = std::make_shared<Freezing>(*presenting(studio).freezing);
    presenting(studio).freezing->writing = true;
    // Who joined while the looks were rendered sits down too.
    read_seats(studio, true);
    freezing->setup.plan->sittings = sittings_now(studio, freezing->setup);
    freezing->setup.plan->folder = folder_name(freezing->setup);
    const auto folder = studio.ballots->file().parent_path() / freezing->setup.plan->folder;
    studio.background->run(
        [&studio, freezing, folder](const Progress&) -> Background::Then {
            const VoteFrames frames = with_greys(*freezing);
            write_vote_frames(folder, frames);
            for (const auto& [name, frame] : frames) {
                freezing->setup.plan->frames[name] = hash_of(*frame);
            }
            return [&studio, freezing] {
                Studio& there = studio;
                if (!presenting(there).freezing) return;  // broken off meanwhile
                try {
                    const RoundSetup& setup = freezing->setup;
                    const int id = there.ballots->open_round(setup);
                    const auto state = after(*setup.plan, {}, Event::present, there.now_s);
                    there.ballots->record_step(id, state, Event::present);
                    presenting(there).freezing.reset();
                    keep_frozen_looks(there, *freezing, id);
                    // With the seats that were dealt
                    take_round(there,
                               there.ballots->open_round().value(),
                               there.ballots->plan_of(id).value(),
                               state);
                    // Dark until its frames are there; the newest look is nobody's business.
                    show_what_is_due(studio);
                    set_frozen(studio, false);
                    if (studio.black) set_black(studio, false);
                } catch (const std::exception&) {
                    give_up_freezing(studio, std::current_exception());
                }
            };
        },
        [&studio](std::exception_ptr why) { give_up_freezing(studio, why); });
}

void go_on_freezing(Studio& studio) {
    Freezing& freezing = *presenting(studio).freezing;
    if (freezing.writing) return;
    const std::size_t done = freezing.frames.size();
    if (freezing.asked == 0) {
        // Files of its paints may have to be read first.
        freezing.asked = ask_for_look(studio, freezing.looks[done]).value_or(0);
        return;
    }
    if (const auto newest = studio.results->newest_frame();
        newest && newest->number == freezing.asked && !newest->problem.empty()) {
        throw std::runtime_error(newest->problem);
    }
    const auto& frame = studio.frame;
    const bool all_there =
        frame && frame->number == freezing.asked && frame->unfinished.empty() && frame->pictures;
    if (!all_there) return;
    auto wanted = radiance_of(*frame->pictures);
    freezing.luminances.push_back(mean_luminance(*wanted));
    const auto drive = drive_of(*frame->pictures);
    freezing.frames[frame_of_look(static_cast<int>(done))] = drive;
    freezing.frozen.push_back({std::move(wanted), drive});
    freezing.asked = 0;
    if (done + 1 == freezing.looks.size()) write_and_begin(studio);
}

// --- what is to be seen ---

Image8 with_surround(const PresentedRound& presented, Image8 frame, double now_s) {
    const PresentationState& state = presented.state;
    if (!presented.place || state.blank) return frame;
    std::optional<int> number;
    std::optional<double> fraction;
    const double step = step_s(presented.plan, state);
    const double left = left_s(state, now_s);
    if (const int design = design_of(presented.plan, state); design >= 0) {
        number = presented.round.codes.at(static_cast<std::size_t>(design));
    } else if (state.phase == Phase::adapting) {
        number = static_cast<int>(std::ceil(left - 1e-6));
    }
    if (step < kWaits && step > 0.0) fraction = std::round(kBarSteps * left / step) / kBarSteps;
    draw_surround(frame, *presented.place, number, fraction);
    return frame;
}

/// All that a picture depends on.
std::string key_of(const PresentedRound& presented, const std::string& frame, double now_s) {
    const PresentationState& state = presented.state;
    const double step = step_s(presented.plan, state), left = left_s(state, now_s);
    const double bar = step < kWaits && step > 0.0 ? std::round(kBarSteps * left / step) : -1.0;
    const double seconds = state.phase == Phase::adapting ? std::ceil(left - 1e-6) : 0.0;
    return fmt::format("{} {} {} {} {} {}",
                       presented.round.id,
                       frame,
                       design_of(presented.plan, state),
                       state.blank,
                       bar,
                       seconds);
}

/// Dark until the frames are loaded: never a look that was not frozen.
Image8 nothing(const Studio& studio) {
    const auto& setup = studio.setup;
    return setup ? Image8(setup->view.width, setup->view.height, 3) : Image8(1280, 800, 3);
}

void show(Studio& studio, const std::string& key, const Image8& picture) {
    PresentingState& state = presenting(studio);
    const std::uint64_t number = next_picture_number();
    state.picture = projector_picture(picture, number);
    state.picture_key = key;
    studio.trace->write("vote-picture", number, key);
    ProjectorWords words;
    if (state.freezing) words = {"keeps its picture while looks are frozen"};
    if (state.presented)
        words = {"showing the frozen frames of the vote", ProjectorWords::Mood::good};
    show_instead(studio, {state.picture, "", words});
}

void show_frames_again(Studio& studio) {
    PresentingState& state = presenting(studio);
    if (state.picture_key.empty()) return;
    state.picture_key.clear();
    state.picture.reset();
    show_instead(studio, {});
    studio.asked_frame.reset();
}

/// The mock-up in neutral grey, as bright as the mean of what it shows now; nothing before it shows
/// anything.
std::optional<Image8> grey_mockup(const Studio& studio) {
    if (!studio.frame || !studio.frame->pictures || !studio.setup) return std::nullopt;
    const auto wanted = radiance_of(*studio.frame->pictures);
    return neutral_drive(*wanted, mean_luminance(*wanted), *studio.setup);
}

/// While looks are frozen the audience sees none of them. What was there first stays: frames change
/// from look to look meanwhile.
void show_grey(Studio& studio) {
    const std::string key = "grey";
    if (presenting(studio).picture_key == key) return;
    show(studio, key, grey_mockup(studio).value_or(nothing(studio)));
}

/// For people to join, before a round: neutral grey on the mock-up, the code beside it.
void show_qr_code(Studio& studio) {
    PresentingState& state = presenting(studio);
    const auto& phones = state.phones->place();
    if (!state.invitation || !phones) return;
    const std::string key = "qr " + state.invitation->token;
    if (state.picture_key == key) return;
    std::optional<Image8> grey = grey_mockup(studio);
    if (!grey) return;
    Image8 picture = std::move(*grey);
    Image8 lit;
    add_lit_pixels(picture, lit);
    const auto place = free_place(lit, 1.0);
    try {
        if (!place) throw Refused("there is no room for it beside the mock-up", "");
        draw_qr_code(picture, *place, qr_code(join_url(*phones, state.invitation->token)));
        show(studio, key, picture);
    } catch (const std::exception& error) {
        state.qr_projected = false;
        tell_warning(studio,
                     "The QR code is not projected.",
                     error.what(),
                     "It is in the panel; show it on another screen.");
    }
}

void show_what_is_due(Studio& studio) {
    PresentingState& state = presenting(studio);
    if (!state.presented) {
        if (state.freezing) return show_grey(studio);
        if (state.qr_projected && state.phones) return show_qr_code(studio);
        return show_frames_again(studio);
    }
    const PresentedRound& presented = *state.presented;
    const std::string frame = frame_of(presented.plan, presented.state);
    const auto found = presented.frames.find(frame);
    const std::string key = found == presented.frames.end()
                                ? std::string("dark")
                                : key_of(presented, frame, studio.now_s);
    if (state.picture_key == key) return;
    show(studio,
         key,
         found == presented.frames.end() ? nothing(studio)
                                         : with_surround(presented, *found->second, studio.now_s));
}

/// No look's time goes by while nobody can see it.
void pause_unseen(Studio& studio) {
    const PresentingState& state = presenting(studio);
    if (!studio.projector || !state.presented || !is_running(state.presented->state)) return;
    const bool gone = studio.projector->state() == ProjectorScreen::State::waiting_for_monitor;
    if (!gone && !studio.black) return;
    send(studio, Event::pause);
    tell_warning(studio,
                 gone ? "The presentation is paused: the projector is gone."
                      : "The presentation is paused: the projector is black.",
                 gone ? studio.projector->why_waiting() : "",
                 gone ? "Plug it in; Repeat shows this look anew."
                      : "Ctrl+B gives light again; Repeat shows this look anew.",
                 gone ? 0.0 : studio.now_s + 15.0);
}

}  // namespace

void step_vote_mode(Studio& studio) {
    PresentingState& state = presenting(studio);
    if (is_presenting(studio)) show_ballots(studio, true);
    try {
        if (std::exchange(state.begin_wanted, false)) begin_presentation(studio);
        if (const auto round = std::exchange(state.duel_wanted, {})) begin_duel(studio, *round);
    } catch (const std::exception&) {
        notify_failure(studio, "The round does not begin.", std::current_exception());
    }
    try {
        if (std::exchange(state.give_up_wanted, false)) end_freezing(studio);
        if (state.freezing) go_on_freezing(studio);
    } catch (const std::exception&) {
        give_up_freezing(studio, std::current_exception());
    }
    watch_phones(studio);
    if (state.phones || state.presented) read_seats(studio);
    pause_unseen(studio);
    if (state.presented) {
        PresentationState& clock = state.presented->state;
        // Until it can be seen no time goes by.
        if (state.presented->frames.empty()) clock.at_s = studio.now_s;
        send(studio, Event::tick);
    }
    show_what_is_due(studio);
}

bool vote_mode_key(Studio& studio, const KeyChord& chord, bool repeated) {
    static constexpr std::pair<int, Event> keys[] = {{GLFW_KEY_RIGHT, Event::next},
                                                     {GLFW_KEY_DOWN, Event::next},
                                                     {GLFW_KEY_PAGE_DOWN, Event::next},
                                                     {GLFW_KEY_LEFT, Event::back},
                                                     {GLFW_KEY_UP, Event::back},
                                                     {GLFW_KEY_PAGE_UP, Event::back},
                                                     {GLFW_KEY_SPACE, Event::pause},
                                                     {GLFW_KEY_R, Event::repeat},
                                                     {GLFW_KEY_B, Event::blank},
                                                     {GLFW_KEY_PERIOD, Event::blank}};
    PresentingState& state = presenting(studio);
    if (state.asking_to_abort || state.asking_to_lock) {
        // The question is answered first.
        const bool keeps = chord.key == GLFW_KEY_ESCAPE && !chord.ctrl && !chord.shift;
        if (keeps) state.asking_to_abort = state.asking_to_lock = false;
        const bool means = std::any_of(std::begin(keys), std::end(keys), [&](const auto& one) {
            return one.first == chord.key && !chord.ctrl && !chord.shift;
        });
        return keeps || means;
    }
    const Phase phase = phase_of(studio);
    const bool shows = phase == Phase::adapting || phase == Phase::presenting;
    if (chord.ctrl || chord.shift || !shows) return false;
    for (const auto& [key, event] : keys) {
        if (key != chord.key) continue;
        if (!repeated) send(studio, event);
        return true;
    }
    return false;
}

bool may_quit(Studio& studio) {
    PresentingState& state = presenting(studio);
    if (!state.presented || phase_of(studio) == Phase::locked) return true;
    if (studio.now_s < state.quits_until_s) return true;
    constexpr double kToAskAgain_s = 8.0;
    state.quits_until_s = studio.now_s + kToAskAgain_s;
    tell_warning(
        studio,
        fmt::format("Round {} is under way.", state.presented->round.id),
        "Without the program the mock-up goes dark and phones cannot vote. Nothing is lost: the "
        "round goes on here when the program is started again.",
        "To end the program, quit once more now.",
        state.quits_until_s);
    return false;
}

double next_vote_change_s(const Studio& studio) {
    const PresentingState& state = presenting(studio);
    const double now_s = studio.now_s;
    // Its bar: the window's frames are not to take the looks' time. What is finished wakes it.
    if (state.freezing) return now_s + kBarStep_s;
    if (state.presented && is_running(state.presented->state)) {
        const PresentationState& step = state.presented->state;
        return std::min(step.at_s + step.left_s + 0.001, now_s + kBarStep_s);
    }
    return state.presented || state.phones ? now_s + kLook_s : 0.0;
}

namespace {

void open_ballots(Studio& studio) {
    try {
        const auto folder = user_folder();
        make_output_folder(folder);
        studio.ballots = std::make_unique<BallotStore>(folder / "ballots.sqlite");
    } catch (const std::exception& error) {
        tell_warning(studio, "Ballots cannot be kept.", error.what());
    }
}

void describe_vote(const Studio& studio, MapState& state) {
    const PresentingState& vote = presenting(studio);
    state["vote"] = map_text(vote.freezing ? "freezing" : to_string(phase_of(studio)));
    state["vote_code"] = map_text(code_on_show(studio));
    if (vote.presented) {
        const PresentedRound& presented = *vote.presented;
        state["vote_frame"] = map_text(frame_of(presented.plan, presented.state));
        state["vote_paused"] = map_text(presented.state.paused);
        state["vote_blank"] = map_text(presented.state.blank);
        state["vote_place"] = std::to_string(presented.state.place);
        state["vote_round"] = std::to_string(presented.round.id);
        state["vote_loaded"] = map_text(!presented.frames.empty());
    }
    state["phones"] =
        map_text(vote.phones && vote.phones->place() ? url_of(*vote.phones->place()) : "");
}

}  // namespace

Panel presenting_panel() {
    return {.name = "presenting",
            .draw_stage = draw_vote_stage,
            .start =
                [](Studio& s) {
                    open_ballots(s);
                    find_presented_round(s);
                    step_vote_mode(s);
                },
            .step = step_vote_mode,
            .stop = [](Studio& s) { presenting(s).picture.reset(); },
            .press =
                [](Studio& s, const KeyChord& chord, bool repeated) {
                    return vote_mode_key(s, chord, repeated) ? EventUse::command
                                                             : EventUse::passed_on;
                },
            .next_change_s = next_vote_change_s,
            .locks_editing = why_no_editing,
            .describe = describe_vote};
}

}  // namespace livery
