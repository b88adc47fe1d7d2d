// --places: what is shown to find where the camera sees each projector pixel.
#pragma once

#include <string>

#include "calibration/correspondence/fringes.h"
#include "cli/command.h"

namespace livery {

/// "gray" or "gray-and-phase"; `target` holds the default.
Option places_option(std::string& target);

/// Throws std::invalid_argument for a word that places_option() does not offer.
PlaceCode parse_places(const std::string& text);

}  // namespace livery
