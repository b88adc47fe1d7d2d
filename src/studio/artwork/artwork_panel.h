// What the artwork panel remembers between frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/look.h"
#include "studio/kit/widgets.h"

namespace livery {

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

}  // namespace livery
