// Changes to the shown look's artwork, all of them commands.
#pragma once

#include <cstddef>

#include "scene/look.h"
#include "studio/studio.h"

namespace livery {

/// Of the shown look, each over those before it.
const std::vector<Artwork>& shown_artwork(const Studio& studio);

/// Its place in the list; the topmost of a look that was just shown. None where there is none.
std::optional<std::size_t> chosen_artwork(const Studio& studio);
void choose_artwork(Studio& studio, std::optional<std::size_t> at);

/// Why the parts cannot wear it with paints of their own; empty: they can. Commands check all else.
std::string wearing_problem(Studio& studio, const Artwork& artwork);

/// Why nobody sees an artwork of the shown look, a sentence or two; empty: it is seen. Its picture
/// is gone, the paint below cannot wear it, or has its colour.
const std::string& why_not_seen(Studio& studio, std::size_t at);

/// Commits the list and chooses from it; a notice where it is refused.
void set_artwork(Studio& studio,
                 const std::vector<Artwork>& list,
                 std::optional<std::size_t> chosen);
/// The same of one of them, if the parts can wear it.
void set_artwork_at(Studio& studio, std::size_t at, const Artwork& artwork);
/// What would be committed.
SetArtwork artwork_command(const Studio& studio, std::size_t at, const Artwork& artwork);

/// On the chosen part, in a paint that is told from that part's. A picture's file gives its
/// proportions; one that cannot be read throws FileError.
Artwork artwork_to_add(Studio& studio,
                       ArtworkShape shape,
                       const std::filesystem::path& picture = {});
/// On top of the others; asks for a picture's file.
void add_artwork(Studio& studio, ArtworkShape shape);

/// Asks for a picture; `then` is called with one that can be read.
void ask_for_picture(Studio& studio,
                     const std::string& title,
                     const std::filesystem::path& start,
                     std::function<void(const std::filesystem::path&)> then);

/// Whether the next click on the product puts the chosen artwork there.
bool is_placing(const Studio& studio);
void stop_placing(Studio& studio);
/// Shows the chosen artwork where the pointer is; none: where it was last. To be called right after
/// the item that the pointer is on.
void try_placing(Studio& studio, const std::optional<PickedPoint>& point);
/// Leaves it there.
void place(Studio& studio, const PickedPoint& point);

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

void draw_artwork_fields(Studio& studio, std::size_t at);

}  // namespace livery
