// A vote on two monitors: what its frozen frames are, and whether the projector shows one of them.
#pragma once

#include <optional>
#include <string>

#include "desktop/two_monitors.h"
#include "evaluation/ballots.h"
#include "studio/presenting/round_files.h"

namespace livery {

class PresentedVote : public TwoMonitors {
  protected:
    /// A program with a home of its own and these settings, the projector picked, the ballot panel
    /// open with the first `looks` of the session ticked.
    void start_vote(const std::string& settings, std::size_t looks);
    /// Presents, pauses in white, and loads what was frozen.
    void present_paused();
    void load_frames();
    /// The address in the QR code, once phones are let in.
    std::string let_phones_vote();

    /// Waits until every pixel that the frame lights is on the projector, by its hash; what stands
    /// beside it has no colour.
    ::testing::AssertionResult projector_shows_frame(const std::string& name);
    /// Pixels with light on the projector that no frozen frame lights: code and time.
    int lit_beside();

    /// Of the lit pixels, all channels.
    double brightness(const std::string& name) const;
    int code_of(int design) const {
        return presented.round.codes.at(static_cast<std::size_t>(design));
    }

    /// The segment that the bar over the window fills: its number from the left, and its colour.
    struct Segment {
        int number = 0;
        Rgb colour;
    };
    Segment filled_segment();

    BallotStore::Presented presented;
    VoteFrames frames;

  private:
    std::optional<int> bar_left_;  ///< where the first segment begins, which edit fills
};

}  // namespace livery
