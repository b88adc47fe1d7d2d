// How a round is shown: which looks, how long, and where it stands. Values and one pure function.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace livery {

struct PresentationTimes {
    double adapt_s = 120.0;  ///< eyes get used to a neutral white
    double look_s = 9.0;
    double grey_s = 4.5;  ///< between two looks
    bool operator==(const PresentationTimes&) const = default;
};

/// Throws std::invalid_argument unless all are 0.2 to 3600.
void check_times(const PresentationTimes& times);

/// What is shown of a round, settled when it begins and never changed after it.
struct PresentationPlan {
    /// People who sit before the mock-up at once, and the designs (from 0) in the order shown to
    /// them. Successive passes follow each other in one sitting.
    std::vector<std::vector<int>> sittings;
    PresentationTimes times;
    std::string session = {};  ///< the session's file whose looks these are; empty: none
    std::string folder = {};   ///< of the frames, beside the ballots
    std::map<std::string, std::string> frames = {};  ///< their hashes, by frame_of_look() and such
    /// Numbers of the seats of each sitting, whose people vote when it has been shown; empty: all
    /// that vote do so from the first vote on. Filled in when the round is opened.
    std::vector<std::vector<int>> seats = {};
    bool operator==(const PresentationPlan&) const = default;
};

/// Throws std::invalid_argument for a plan without sittings, an empty one, a design outside 0 to
/// designs - 1, one that is never shown, times out of range, or seats of another number of sittings
/// or one of them twice.
void check_plan(const PresentationPlan& plan, int designs);

/// Names of frames. Greys are the same whichever of the two looks comes first.
inline constexpr const char* kWhiteFrame = "white";  ///< that eyes adapt to
inline constexpr const char* kRestFrame = "rest";    ///< grey of all looks: while voting
std::string frame_of_look(int design);
std::string frame_of_grey(int one, int other);
/// Every frame that the sittings need.
std::vector<std::string> frames_needed(const std::vector<std::vector<int>>& sittings);

enum class PresentationPhase { edit, adapting, presenting, voting, locked };

struct PresentationState {
    PresentationPhase phase = PresentationPhase::edit;
    int sitting = 0;
    int place = 0;      ///< of the look within the sitting
    bool grey = false;  ///< after that look
    bool paused = false;
    bool blank = false;   ///< grey instead of what is due; time stands still
    double left_s = 0.0;  ///< of this step, at `at_s`; infinite: it waits for the operator
    double at_s = 0.0;    ///< any clock that rises
    bool operator==(const PresentationState&) const = default;
};

inline constexpr double kWaits = std::numeric_limits<double>::infinity();

enum class PresentationEvent {
    tick,     ///< time has passed
    present,  ///< edit -> adapting
    pause,    ///< and go on: it is a switch
    blank,    ///< the same
    repeat,   ///< this step from its beginning; in a grey the look before it
    next,     ///< a look -> the grey after it -> the next look; after the last one -> voting;
              ///< voting -> the next sitting, where there is one
    back,     ///< the look before this one; from the first one to the adaptation; voting -> the
              ///< grey after the last look: votes that are in stay, and more may come meanwhile
    lock,     ///< voting -> locked
    abort,    ///< adapting, presenting -> edit
    done,     ///< locked -> edit
    resume,   ///< the program has come back: the step from its beginning, paused
};
inline constexpr int kPresentationEvents = 11;

/// Whether the event does something in this state; a tick always may.
bool is_allowed(const PresentationPlan& plan,
                const PresentationState& state,
                PresentationEvent event);

/// The state after the event at this time; the same state where the event is not allowed. A step
/// ends in the tick that comes after its time, and the next one begins with all of its own then: no
/// look is cut short because a tick came late.
PresentationState after(const PresentationPlan& plan,
                        PresentationState state,
                        PresentationEvent event,
                        double now_s);

/// Of this step, now; at least 0.
double left_s(const PresentationState& state, double now_s);
/// How long this step is in all; infinite: it waits for the operator.
double step_s(const PresentationPlan& plan, const PresentationState& state);
bool is_running(const PresentationState& state);  ///< its time goes by

/// Which stored frame is to be seen; empty in edit.
std::string frame_of(const PresentationPlan& plan, const PresentationState& state);
/// The design on show; -1: none.
int design_of(const PresentationPlan& plan, const PresentationState& state);

/// How long all sittings take from `present` to votes, when nobody interferes.
double duration_s(const PresentationPlan& plan);

const char* to_string(PresentationPhase phase);  ///< "edit", "adapting", ...
const char* to_string(PresentationEvent event);

/// As JSON, for the ballots' log, and back. Throws FileError of that file for anything else.
std::string text_of(const PresentationPlan& plan);
PresentationPlan parse_plan(const std::string& text, const std::string& file);
/// Without its clock: after parse_state() `at_s` is 0 and the step has all of its time.
std::string text_of(const PresentationState& state, PresentationEvent event);
struct PresentationStep {
    std::string at;  ///< ISO 8601, UTC
    PresentationEvent event = PresentationEvent::present;
    PresentationState state;
};
PresentationStep parse_step(const std::string& text, const std::string& file);

}  // namespace livery
