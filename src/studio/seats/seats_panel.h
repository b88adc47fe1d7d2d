// Seats round the mock-up: a plan of the room, whose eye highlights are drawn for, and what each
// seat misses of them.
#pragma once

#include <glm/vec2.hpp>

#include "live/seat_error_thread.h"
#include "studio/seats/room_plan.h"
#include "studio/studio.h"

namespace livery {

struct ProjectorSetup;

/// What seat errors were asked for; asked anew when it changes.
struct SeatErrorKey {
    std::uint64_t revision = 0;
    std::vector<int> looks;
    std::shared_ptr<const ProjectorSetup> setup;
    bool operator==(const SeatErrorKey&) const = default;
};

struct SeatsPanelState {
    bool open = false;
    std::vector<int> judged_looks;    ///< that a vote asks about as well
    int selected = 0;                 ///< a seat's number; 0: none
    int arc = 5;                      ///< seats of the next arc
    Held<std::vector<EyeSeat>> held;  ///< while one is dragged or typed
    Held<glm::dvec3> held_eye_mm;     ///< the eye that is set by hand
    glm::dvec2 grabbed_mm{0.0};       ///< from what is dragged to the pointer
    std::string why;                  ///< what kept a seat from where it was wanted
    double why_until_s = 0.0;

    // The plan.
    std::shared_ptr<const Product> outline_of;
    std::vector<glm::dvec2> outline_mm;
    Bounds bounds;
    PlanExtent extent;  ///< stands while something is dragged
    bool dragging = false;

    // What each seat misses. Nothing of it is there without seats.
    std::unique_ptr<SeatErrorThread> thread;
    std::optional<SeatErrorKey> asked;
    std::uint64_t number = 0;  ///< of the newest request
    std::shared_ptr<const SeatErrorResults> results;
    bool map_on_stage = false;
    Texture2D map_texture;
    std::shared_ptr<const Image8> map_in_texture;
};

/// Opens or closes the panel.
void show_seats(Studio& studio, bool shown);
/// Instead of the tabs.
void draw_seats_panel(Studio& studio);
/// What a key means while the panel is open and a seat is chosen; true when it meant something.
bool seats_key(Studio& studio, const KeyChord& chord);

/// The plan with its seats to drag, this wide; each seat is an item "plan:seat:N", the eye that is
/// set by hand "plan:eye". `seats` are the document's, or what is held of them.
void draw_room_plan(Studio& studio, std::vector<EyeSeat>& seats, float width);

/// Mock-up from above and its bounds, found once a product.
void take_outline(Studio& studio);

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
