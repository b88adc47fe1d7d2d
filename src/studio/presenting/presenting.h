// A vote as the operator runs it: looks are frozen, shown by the presentation's state machine,
// voted on and locked. What is remembered between frames, and what needs no projector.
#pragma once

#include "evaluation/phone_page.h"
#include "live/projector_setup.h"
#include "studio/presenting/round_files.h"
#include "studio/studio.h"

namespace livery {

/// How the next round is presented; kept with the user's settings.
struct PresentingSettings {
    PresentationTimes times;
    bool waves = false;       ///< else successive passes
    int passes = 0;           ///< rows of the Williams square; 0: all
    int evaluators = 10;      ///< in waves, where no phone has joined
    int wave_size = 3;        ///< the most at once
    bool asks_least = false;  ///< each evaluator may name the least liked look too
    bool asks_scales = false;
    /// Between which words looks may be placed, where that is asked; at most five.
    std::vector<SemanticScale> scales = {suggested_scales().begin(),
                                         suggested_scales().begin() + 3};
    std::optional<int> seed;  ///< none: drawn anew for each round
    std::string network = "lo";
    int port = kBallotPort;  ///< 0: any that is free
    bool operator==(const PresentingSettings&) const = default;
};

/// What a round asks: none where it is not ticked.
std::vector<SemanticScale> scales_asked(const PresentingSettings& settings);
/// The order in which the looks of a round would be shown. In waves it is the `phones` that have
/// joined that sit down or, where none has, as many evaluators as the settings say.
std::vector<std::vector<int>> sittings_of(const PresentingSettings& settings,
                                          int designs,
                                          int seed,
                                          int phones = 0);
/// The numbers of the seats that are phones.
std::vector<int> phones_in(const std::vector<Seat>& seats);
/// "Wave 1: seats 1, 2, 3", a line a wave; nothing where there is one alone, or nobody is dealt.
std::vector<std::string> waves_in_words(const std::vector<std::vector<int>>& seats);

/// Looks that are being rendered for a round, one after the other.
struct Freezing {
    std::vector<int> looks;
    RoundSetup setup;
    std::shared_ptr<const ProjectorSetup> projector;
    std::uint64_t asked = 0;  ///< the frame of the look under way; 0: not asked for yet
    VoteFrames frames;
    std::vector<double> luminances;  ///< of the looks, as wanted
    std::vector<FrozenLook> frozen;
    bool kept_frozen = false;  ///< the projector was frozen before
    bool writing = false;
};

/// The round that is presented, voted on or locked.
struct PresentedRound {
    Round round;
    std::string repeat;  ///< which of a duel's blind repeats it is; empty: of none
    PresentationPlan plan;
    PresentationState state;
    VoteFrames frames;                    ///< empty: still being loaded, or not what was frozen
    RoundDetails details;                 ///< how much of each look can be shown; empty: not known
    Image8 lit;                           ///< pixels that any of them lights
    std::optional<PixelRectangle> place;  ///< for code and time; none: no room
};

struct PresentingState {
    bool settings_read = false;
    PresentingSettings settings;
    bool begin_wanted = false;  ///< the panel's button was pressed
    std::vector<int> wanted_looks;
    std::optional<int> duel_wanted;  ///< of the leaders of this round, or the next of its repeats
    bool give_up_wanted = false;     ///< freezing
    std::optional<Freezing> freezing;
    std::optional<PresentedRound> presented;
    std::string problem;  ///< why what should be seen is not
    bool asking_to_abort = false, asking_to_lock = false;
    double quits_until_s = 0.0;                        ///< until then quitting is meant
    std::string scale_low, scale_high, scale_problem;  ///< words that are being typed

    // Who has joined and voted, never for what.
    std::vector<Seat> seats;
    std::vector<int> voted;
    std::optional<Invitation> invitation;
    double seats_read_s = -1.0;

    // The phones' server.
    std::unique_ptr<BallotProcess> phones;          ///< without a place: still starting
    std::optional<BallotServerPlace> phones_place;  ///< where it listens, or did when it ended
    std::string phones_problem;
    bool qr_projected = false;
    bool phones_sought = false;  ///< what came of starting may be out of sight

    // On the projector and on the stage.
    std::shared_ptr<const ProjectorPicture> picture;
    std::string picture_key;  ///< what it shows; empty: frames as usual

    // What a locked round says, by the statistics.
    int verdict_round = 0;
    std::string verdict;
    std::vector<std::string> scale_verdicts;
};

/// Its wave comes after the one that looks or votes now.
bool sits_later(const PresentingState& state, int seat);
bool has_voted(const PresentingState& state, int seat);
/// How many have voted of those whose turn has come, and whose turn is still to come. People whose
/// ballots are typed in are waited for by nobody.
struct VotesSoFar {
    std::size_t voted = 0, awaited = 0, later = 0;
    bool operator==(const VotesSoFar&) const = default;
};
VotesSoFar votes_so_far(const PresentingState& state);
/// What is asked before a round is locked or aborted, with what would be cut off; empty: nothing.
std::string question_in_words(const PresentingState& state);

PresentingState& presenting(Studio& studio);
const PresentingState& presenting(const Studio& studio);

/// Read once from the user's settings.
PresentingSettings& presenting_settings(Studio& studio);
void keep_presenting_settings(Studio& studio);

/// Which session a round's looks are of; empty: one that is not saved.
std::string session_name(const Studio& studio);

/// A round is frozen, presented, voted on or locked.
bool is_presenting(const Studio& studio);
/// Why nothing may be edited now; none: it may.
std::optional<Notice> why_no_editing(const Studio& studio);

/// The phase of the bar.
PresentationPhase phase_of(const Studio& studio);
/// Nothing while no look is shown under its code.
std::optional<int> code_on_show(const Studio& studio);

/// Sends an event to the state machine: what changes is in the ballots' log before it is to be
/// seen. What the store refuses is told, and nothing changes then.
void send(Studio& studio, PresentationEvent event);

/// After the program has come back: a round of this session that was under way goes on, paused.
void find_presented_round(Studio& studio);
/// Takes a round over: its frames are read and checked on the background thread.
void take_round(Studio& studio, Round round, PresentationPlan plan, PresentationState state);

/// What phones and other programs did meanwhile; reads at most twice a second.
void read_seats(Studio& studio, bool now = false);

/// Starts the phones' server without waiting for it, or ends it; told in `phones_problem`.
void serve_phones(Studio& studio, bool on);
/// Notes that it listens, and restarts one that has ended by itself.
void watch_phones(Studio& studio);

/// "2:05", "9 s".
std::string time_in_words(double seconds);

// Drawing; only with a window.
void draw_presentation_setup(Studio& studio, const std::vector<int>& looks);
void draw_scales_setup(Studio& studio);
void draw_presented_round(Studio& studio);
void draw_phones(Studio& studio);
void draw_seats(Studio& studio);
void draw_verdict(Studio& studio, const Round& round);
/// "Duel of the first two", or the next repeat of one; false: the round's counts are not told yet.
bool draw_duel(Studio& studio, const Round& round);

// --- in the running window: freezing looks, and what the projector shows of them ---

/// Once a frame of the window, before it is drawn: takes over what the panel asked for, goes on
/// freezing, lets time go by and puts on the projector what is to be seen.
void step_vote_mode(Studio& studio);

/// What a key means while looks are presented, presenters' remote controls among them; false: it
/// means what it always does. A key that is held down counts once.
bool vote_mode_key(Studio& studio, const KeyChord& chord, bool repeated);

/// When the window must look again; 0: something else will wake it.
double next_vote_change_s(const Studio& studio);

/// The bar over the whole width, which nobody can miss, and what the audience sees.
bool has_vote_bar(const Studio& studio);
/// Whether the program may end now. While a round is under way it has to be asked twice within some
/// seconds; the first time says what ends.
bool may_quit(Studio& studio);

void draw_vote_bar(Studio& studio);
/// False: no round is under way.
bool draw_vote_stage(Studio& studio);

}  // namespace livery
