// What is known of a round beside its ballots: what was asked, how its looks were shown, whose eye
// they were shaded for and what the other seats missed. A small JSON file, with pictures, in a
// folder beside the ballots' file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace livery {

/// Of one look, by its code: CIEDE2000 of what was projected to what the seat should have seen.
struct SeatMiss {
    int code = 0;
    double de00_median = 0.0, de00_p95 = 0.0;
    double share_over_3 = 0.0;  ///< of the mock-up

    bool operator==(const SeatMiss&) const = default;
};

struct RoundSeat {
    int seat = 0;                      ///< its number, from 1
    glm::dvec3 eye_mm{0.0};            ///< in the mock-up's frame
    bool counts = true;                ///< in the mean
    std::vector<SeatMiss> looks = {};  ///< empty: not known

    bool operator==(const RoundSeat&) const = default;
};

struct RoundEye {
    std::string of = {};  ///< "of seat 4", "in the mean of 5 seats"
    glm::dvec3 eye_mm{0.0};
    std::vector<RoundSeat> seats = {};

    bool operator==(const RoundEye&) const = default;
};

/// How much of a look the projector could show, as it was shown; what is not recorded is nothing.
struct LookReachability {
    std::optional<double> reachable_fraction;  ///< of the lit pixels
    std::optional<double> de00_median,
        de00_p95;  ///< CIEDE2000 of what was shown to what was wanted
};

struct LookDetails {
    int code = 0;
    std::string picture = {};  ///< a file's name in the same folder; empty: none
    std::optional<LookReachability> reachability = {};
};

/// One time that looks were shown, to whom and in which order.
struct LookShowing {
    std::string at;          ///< ISO 8601, UTC
    std::vector<int> seats;  ///< of the session; empty: not recorded
    std::vector<int> codes;  ///< in the order shown
};

struct RoundDetails {
    std::string title = {}, question = {};
    std::string note = {};  ///< what a reader must know, such as that the round is a made-up sample
    std::vector<LookDetails> looks = {};
    std::vector<LookShowing> showings = {};
    std::optional<RoundEye> eye = {};   ///< nothing: from before it was recorded
    std::filesystem::path folder = {};  ///< where the pictures are
};

/// `codes` are the round's. Throws FileError: malformed, unknown fields, another round's number or
/// a code that is none of them, a picture's name that leads elsewhere.
RoundDetails parse_round_details(const std::string& text,
                                 const std::filesystem::path& file,
                                 int round,
                                 const std::vector<int>& codes);

/// "ballots-round-3/round.json" beside "ballots.sqlite".
std::filesystem::path round_details_file(const std::filesystem::path& ballots, int round);

/// What parse_round_details() reads, into a folder that is made. Pictures are written by whoever
/// has them. Throws FileError.
void write_round_details(const std::filesystem::path& file, int round, const RoundDetails& details);

/// Nothing known where there is no such file. Throws as parse_round_details().
RoundDetails read_round_details(const std::filesystem::path& file,
                                int round,
                                const std::vector<int>& codes);

}  // namespace livery
