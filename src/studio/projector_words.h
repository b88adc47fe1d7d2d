// What the bar says of the projector: never that it shows what it does not.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "projection/projector_screen.h"

struct ImVec4;

namespace livery {

struct ProjectorFacts {
    ProjectorScreen::State state = ProjectorScreen::State::off;
    std::string why_waiting;
    bool only_screen = false;  ///< the chosen one, which therefore stays dark
    bool black = false, frozen = false;
    bool monitor_numbers = false, signal_test = false, nudge = false;  ///< shown instead
    bool freezing = false, voting = false;  ///< looks for a vote; frozen frames are shown instead
    std::uint64_t wanted = 0;               ///< the newest frame that was asked for
    std::uint64_t shown = 0;                ///< the frame on the projector
    double waited_s = 0.0;                  ///< since the wanted one was asked for
    std::string not_drawn;                  ///< why there is no such frame
    std::string other_product;              ///< why its correction is wrong; empty: it is not
};

struct ProjectorWords {
    enum class Mood { quiet, good, warning, error };
    std::string text;
    Mood mood = Mood::quiet;
    std::string help;  ///< may be empty
};

/// A frame may be on its way for so long before the bar speaks of it.
inline constexpr double kUnspokenWait_s = 0.25;

const ImVec4& colour_of(SignalWarning::Severity severity);
/// Of warnings and errors; notes are none.
long count_of_warnings(const std::vector<SignalWarning>& list);

ProjectorWords projector_words(const ProjectorFacts& facts);

}  // namespace livery
