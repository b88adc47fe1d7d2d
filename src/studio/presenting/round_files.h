// What a round leaves beside its ballots: its frozen frames, pictures and reach of its looks, whose
// eye they were shaded for and what seats missed of them, and its report.
#pragma once

#include "core/image.h"
#include "evaluation/report/round_details.h"
#include "live/projector_setup.h"
#include "session/document.h"
#include "studio/studio.h"

namespace livery {

using VoteFrames = std::map<std::string, std::shared_ptr<const Image8>>;

/// Of the picture's size and values.
std::string hash_of(const Image8& picture);

/// One PNG a frame, in a folder that appears whole or not at all. Throws FileError.
void write_vote_frames(const std::filesystem::path& folder, const VoteFrames& frames);

/// Those that `hashes` names. Throws FileError when one is missing or is not what was frozen.
VoteFrames read_vote_frames(const std::filesystem::path& folder,
                            const std::map<std::string, std::string>& hashes);

/// A look as it was frozen.
struct FrozenLook {
    std::shared_ptr<const ImageF> wanted_working;  ///< R, G, B, coverage
    std::shared_ptr<const Image8> drive;
};

/// What a look loses that cannot be judged any more: the paper calls differences under 3 hard to
/// see, and a fifth of a look is no detail.
inline constexpr double kFairDe00 = 3.0, kFairFraction = 0.8;
bool is_fair(const LookReachability& reach);

/// "374: 93% of it as wanted, 95% within 4.1 (CIEDE2000)".
std::string reach_in_words(const LookDetails& look);
/// Codes of looks that cannot be shown fairly, by their details.
std::vector<int> unfair_looks(const RoundDetails& details);

/// For a thread that may wait: what each look wants as sRGB, how much of it this projector shows,
/// by its calibration (nothing is said without one), in the round's folder beside the ballots, with
/// the eye that they were shaded for. Throws FileError.
RoundDetails write_frozen_looks(const std::filesystem::path& ballots,
                                const Round& round,
                                const std::vector<FrozenLook>& looks,
                                const ProjectorSetup& setup,
                                const std::optional<RoundEye>& eye = {});

/// On the background thread: HTML and PDF in that folder; the notice says where.
void write_round_report(Studio& studio, const Round& round);

/// The eye in use and the seats, without what they miss.
RoundEye eye_of_round(const Document& document);

/// Looks of the presented round for which it is not recorded yet what seats miss.
std::vector<int> looks_to_record(const Studio& studio);

/// Once a frame of the window: when all is found it is written beside the ballots, and seats that
/// see other looks than they should are named.
void record_seat_errors(Studio& studio);

}  // namespace livery
