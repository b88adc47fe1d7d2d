// What a round keeps of whose eye its looks were shaded for.
#pragma once

#include <optional>
#include <vector>

#include "evaluation/report/round_details.h"
#include "session/document.h"
#include "studio/studio.h"

namespace livery {

/// The eye in use and the seats, without what they miss.
RoundEye eye_of_round(const Document& document);

/// Looks of the presented round for which it is not recorded yet what seats miss.
std::vector<int> looks_to_record(const Studio& studio);

/// Once a frame of the window: when all is found it is written beside the ballots, and seats that
/// see other looks than they should are named.
void record_seat_errors(Studio& studio);

}  // namespace livery
