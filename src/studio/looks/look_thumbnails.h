// Small pictures of looks, seen from the audience's eye, all in one light.
#pragma once

#include "studio/paint/swatches.h"
#include "studio/studio.h"

struct ImVec2;

namespace livery {

struct LookThumbnailState {
    std::shared_ptr<SwatchInbox> inbox = std::make_shared<SwatchInbox>();  ///< by the look's name
    std::map<std::string, Texture2D> pictures;
    std::map<std::string, std::string> asked;  ///< for which state of the session, and size
};

/// Draws the look's picture into the current window; asks for it anew when the look has changed,
/// and shows the one before until it is there. An empty frame when there is none (a look that was
/// deleted since).
void draw_look_thumbnail(Studio& studio,
                         const std::string& look_name,
                         const ImVec2& corner,
                         const ImVec2& size);

/// The look that has this name now; null: none.
const SessionLook* look_named(const Document& document, const std::string& name);

}  // namespace livery
