// Seats round the mock-up: a plan of the room, whose eye highlights are drawn for, and what each
// seat misses of them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "gl/handles.h"
#include "live/seat_error_thread.h"
#include "studio/kit/widgets.h"
#include "studio/seats/room_plan.h"

namespace livery {

struct KeyChord;
struct ProjectorSetup;
struct Studio;

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

}  // namespace livery
