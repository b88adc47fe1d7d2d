// What the panels remember from one frame of the window to the next; nothing here is part of the
// session. Owns textures: destroy it with the window's context current.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "appearance/fit/recolour.h"
#include "appearance/lobe_curve.h"
#include "appearance/material_library.h"
#include "appearance/measured/measured_grid.h"
#include "appearance/paint_colour.h"
#include "appearance/paint_figures.h"
#include "core/image.h"
#include "evaluation/ballots.h"
#include "gl/handles.h"
#include "ledger/predictions.h"
#include "scene/frame_plan.h"
#include "scene/look.h"
#include "scene/product.h"
#include "studio/kit/held.h"

namespace livery {

/// Where the preview's thread leaves swatches. Shared, because a swatch may be finished after the
/// panel that asked for it is gone.
struct SwatchInbox {
    std::mutex mutex;
    std::map<std::string, Image8> drawn;  ///< by the paint's parameters
};

/// One look at the paint library's files (users_library.h).
struct LibraryReading {
    bool asked = false;
    std::set<std::filesystem::path> files;    ///< that are read as well
    std::vector<std::function<void()>> then;  ///< called when it is done
};

struct LibraryPanelState {
    std::string problem;                   ///< why its files could not be looked at; else empty
    LibraryReading reading, next_reading;  ///< on the background thread, and after it
    std::string search;
    bool searching = false;     ///< the text cursor is in the search
    bool focus_search = false;  ///< set by a key: the next frame puts the text cursor there
    std::string family;         ///< empty: all
    enum class Target { part, rest, product };
    Target target = Target::part;       ///< what a click paints
    std::optional<std::string> cursor;  ///< the paint that the arrow keys are on
    bool cursor_moved = false;          ///< it must be scrolled to
    int cursor_rows = 0;                ///< up or down, pressed in the search in this frame
    bool owns_arrows = false;           ///< the swatches have the keyboard
    std::shared_ptr<SwatchInbox> inbox = std::make_shared<SwatchInbox>();
    std::map<std::string, Texture2D> swatches;
    std::set<std::string> asked;
};

/// What the background thread works out of a paint.
struct PaintPortrait {
    Material material;
    PaintFigures figures;
    std::vector<LobePoint> curve;
};
/// What of it is asked for; equal when nothing would come out differently.
struct PortraitKey {
    std::vector<double> own, other;  ///< reflectance_numbers(); other empty: none
    double light_rad = 0.0;
    bool operator==(const PortraitKey&) const = default;
};

struct PaintPortraitState {
    double light_deg = 45.0;  ///< from the normal
    bool logarithmic = true;
    std::optional<Material> compared;  ///< what the paint is held against
    std::string search;                ///< in the list to choose that from
    bool working = false;
    PortraitKey asked;
    std::optional<PaintPortrait> own, other;
    std::optional<ReflectanceDifference> difference;  ///< between the two
    std::string problem;
};

struct PaintColourState {
    std::string text;  ///< in the field
    bool typing = false, edited = false;
    std::vector<ColourChip> chips;
    std::string chips_file;
    std::optional<Recoloured> made;  ///< the last that was worked out
    std::vector<double> made_of;     ///< of that paint in that colour
};

struct PaintPanelState {
    PaintPortraitState portrait;
    PaintColourState colour;
    Held<Material> held;
    bool brushed = false;  ///< along and across are shown although they are equal
    // What the panel shows, looked up again when one of these changes.
    bool read = false;
    std::uint64_t revision = 0;
    int look = -1, part = -1;
    std::string part_name;             ///< empty: none is chosen
    std::optional<Material> material;  ///< none: the product file's own colour
    std::string problem;
    std::string becomes;  ///< the name that the first change gives
    // "Save as new paint"
    std::string new_name, new_family, save_problem;
    // "Rename"
    std::string other_name, rename_problem;
};

struct ArtworkPanelState {
    int look = -1;                      ///< whose artwork it shows
    std::optional<std::size_t> chosen;  ///< in that look's list
    Held<Artwork> held;
    std::string name;  ///< while it is typed
    bool naming = false;
    std::string search;             ///< in the list of paints
    bool placing = false;           ///< the next click on the product puts it there
    std::optional<Artwork> placed;  ///< where the pointer would put it
    std::string problem;            ///< why what is being tried cannot be worn
    /// Why each of the list is not to be seen, empty where it is; looked up again when the session
    /// has changed.
    std::optional<std::uint64_t> looked_up_at;
    std::vector<std::string> not_seen;
};

struct LightingPanelState {
    Held<Look> held;  ///< lights and environment
    Held<glm::dvec3> held_eye_mm;
    Held<double> held_ev;
    int lit_look = -1;  ///< whose lights are held
    std::shared_ptr<const Product> centre_of;
    glm::dvec3 centre_mm{0.0};  ///< of that product
    std::string observer_of;    ///< the bench
    std::optional<glm::dvec3> observer_mm;
    std::string thumbnail_of;
    Texture2D thumbnail;
    std::string thumbnail_problem;
    std::vector<std::string> shipped_environments;
    bool listed = false;
};

/// What passes took when they last ran: a frame that changes nothing runs none.
struct MeasuredCosts {
    std::chrono::steady_clock::time_point frame_done_at{};  ///< of the newest looked at
    std::map<std::pair<Quality, PassId>, double> pass_ms;
    double total_ms = 0.0, shade_ms = 0.0, compensate_ms = 0.0;  ///< of the last that was drawn
    bool newest_was_drawn = false;
};

struct PlanPanelState {
    MeasuredCosts measured;
    bool costs_read = false;
    std::optional<std::vector<PassCost>> costs;
    std::string problem;
};

struct CalibrationPanelState {
    std::vector<std::filesystem::path> kept;
    std::vector<std::string> benches;
    double listed_at_s = -1.0;
    Held<double> held_percentile;
    std::string list_problem;
    std::filesystem::path taken;  ///< the finished calibration that was put to use
    bool dismissed = false;       ///< the refusal was read
};

struct LookThumbnailState {
    std::shared_ptr<SwatchInbox> inbox = std::make_shared<SwatchInbox>();  ///< by the look's name
    std::map<std::string, Texture2D> pictures;
    std::map<std::string, std::string> asked;  ///< for which state of the session, and size
};

struct BallotPanelState {
    enum class Page { start, vote, thanks, result };
    Page page = Page::start;
    bool was_open = false;             ///< in the frame before
    std::vector<Round> rounds;         ///< read when the panel opens and after each change
    std::map<int, bool> chosen_looks;  ///< by the look's number
    std::string evaluator, thanked;
    bool focus_name = false;
    std::optional<int> best, second;
    std::string problem;
    std::optional<int> shown_round;
    bool asking_to_close = false;
};

struct PanelStates {
    LibraryPanelState library;
    PaintPanelState paint;
    ArtworkPanelState artwork;
    LightingPanelState lighting;
    PlanPanelState plan;
    CalibrationPanelState calibration;
    BallotPanelState ballot;
    LookThumbnailState thumbnails;
};

}  // namespace livery
