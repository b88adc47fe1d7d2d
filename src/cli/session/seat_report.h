// What `livery session seats` tells: who sits where, whose eye looks are drawn for, what seats
// miss.
#pragma once

#include <memory>
#include <string>

#include "cli/command.h"
#include "live/projector_setup.h"
#include "session/document.h"

namespace livery {

/// "hand", "mean" or a seat's number, as options have it. Throws std::invalid_argument.
EyeChoice parse_eye_choice(const std::string& option, const std::string& text);

/// The seats and the eye in use: eye{of, eye_mm}, seats[].{seat, eye_mm, counts}.
Outcome seats_told(const Document& document);

/// With what each seat misses of a look ("all": of each), shaded at half of the projector's pixels:
/// seats[].looks[].{look, name, de00_median, de00_p95, share_over_3} and unfair_seats[]. `maps`, a
/// folder, takes a picture of each; empty: none. Throws Refused without seats.
Outcome seats_told(const Document& document,
                   const std::string& look,
                   const std::shared_ptr<const Product>& product,
                   const ProjectorSetup& setup,
                   const std::filesystem::path& maps,
                   const Progress& progress);

}  // namespace livery
