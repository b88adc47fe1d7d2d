// The paint library as the panels see it: looked at again behind the window, never by a frame, and
// searched.
#pragma once

#include <set>

#include "appearance/material.h"
#include "appearance/paint_search.h"
#include "studio/studio.h"

namespace livery {

/// One look at the paint library's files (users_library.h).
struct LibraryReading {
    bool asked = false;
    std::set<std::filesystem::path> files;    ///< that are read as well
    std::vector<std::function<void()>> then;  ///< called when it is done
};

/// On the background thread, and after it.
struct LibraryReadings {
    LibraryReading now, next;
    std::string problem;  ///< why the files could not be looked at; else empty
};

/// The snapshot that the session's names are looked up in.
const PaintLibrary& current_library(const Studio& studio);

/// Looks at the library's files on the background thread and reads `wanted` and the user's measured
/// paints as well; the session goes on with a new snapshot where something is new, and `then` is
/// called on the main thread. When it cannot be read, studio.panels.of<LibraryPanelState>().problem
/// says why, and the last good one stays. Called as the window opens, when it gets the focus back
/// (whoever puts a file into the folder comes from another program), and for what is to be drawn
/// and is not read yet; never by a frame or a click that needs nothing new. Files that are being
/// read are not asked for twice.
void refresh_library(Studio& studio,
                     const std::set<std::filesystem::path>& wanted = {},
                     std::function<void()> then = {});

/// L*a*b* (10 degree observer) of a text that is a colour, as parse_colour() takes it. Nothing for
/// other texts, and for one that is not typed to its end.
std::optional<glm::dvec3> colour_in(const std::string& query);
/// Whether it can be nothing but a colour: "#b01020", "lab:45,30,-20". "gold" may be a paint's
/// name.
bool is_marked_colour(const std::string& query);

/// The colour at 45 degrees as the paint is drawn (five_angle_lab() integrates measured spectra,
/// which takes their file).
glm::dvec3 drawn_face_lab(const Material& paint);

inline constexpr std::size_t kNearestShown = 12;
/// The paints that come nearest to a colour, nearest first, at most so many.
std::vector<NearPaint> find_near_paints(const std::vector<Material>& paints,
                                        const glm::dvec3& lab10,
                                        const std::string& family);
/// As search_paints(); a colour is answered by the paints that come nearest, one that may be a name
/// only where no paint has it.
std::vector<std::size_t> find_paints(const std::vector<Material>& paints,
                                     const std::string& query,
                                     const std::string& family);

}  // namespace livery
