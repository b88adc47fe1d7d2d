// What each seat misses, asked for when somebody looks at it and kept until looks, light or seats
// change.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "live/seat_error_thread.h"
#include "studio/studio.h"

namespace livery {

struct Studio;

/// Once a frame of the window: takes over what is new and asks for what is looked at.
void step_seat_errors(Studio& studio);
/// Before the window's threads end.
void stop_seat_errors(Studio& studio);

/// Of the newest request for the session as it is; null: not found yet.
const SeatErrorMap* seat_error_of(const Studio& studio, int look, int seat);
/// How much of what was asked for is found; nothing: nothing is under way.
std::optional<double> seat_errors_progress(const Studio& studio);

/// All that was asked for of the session as it is, is found.
bool seat_errors_found(const Studio& studio);

/// What a seat misses of the look where it misses most.
struct SeatSees {
    int seat = 0, look = 0;
    SeatError error;
    bool operator==(const SeatSees&) const = default;
};
/// One a seat, of those for which all looks are found.
std::vector<SeatSees> worst_looks(const SeatErrorResults& results,
                                  const std::vector<EyeSeat>& seats,
                                  const std::vector<int>& looks);
/// "Seat 4 sees highlights where none should be: 95% within CIEDE2000 11.2."
std::string in_words(const SeatSees& sees);
/// "Seats 1 and 4 see other looks than are judged: ..." of those that miss too much; empty: none.
std::string unfair_in_words(const std::vector<SeatSees>& all);

/// On the stage: the chosen seat's map of the shown look, in the projector's pixels.
bool shows_seat_map(const Studio& studio);
void show_seat_map(Studio& studio, bool shown);
glm::ivec2 seat_map_size(const Studio& studio);  ///< 0: not found yet
void draw_seat_map(Studio& studio, const StageFrame& picture, const StageFrame& stage);

/// In the ballot panel, before *Present*: whose eye it will be, what each seat misses of these
/// looks, a warning.
void draw_seats_before_vote(Studio& studio, const std::vector<int>& looks);

}  // namespace livery
