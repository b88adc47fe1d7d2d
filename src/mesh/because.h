// Why nothing is left of a mesh. Internal to mesh/.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace livery {

/// " (what was dropped; what was not read)", the first few of the notes; nothing without any.
inline std::string because(const std::vector<std::string>& notes) {
    constexpr std::size_t most = 5;
    std::string text;
    for (std::size_t k = 0; k < std::min(notes.size(), most); ++k) {
        text += (k == 0 ? " (" : "; ") + notes[k].substr(0, 120);
    }
    if (notes.size() > most) text += "; and " + std::to_string(notes.size() - most) + " more";
    return text.empty() ? text : text + ")";
}

}  // namespace livery
