// What goes wrong while photographs are taken, told from the photographs alone and by name: before
// anything is solved from them, so that no later stage blames the projector for it.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "calibration/captures/capture_summary.h"

namespace livery {

struct ShownDrives {
    int dark = 0, bright = 255;  ///< s and t of dark-gray and bright-gray
};

/// A steady change of the lamp's light, read from the stripes, white and black.
struct LampDrift {
    double slope = 0.0;   ///< relative change a photograph; 0: none that stands out of the scatter
    double centre = 0.0;  ///< where the light is 1, in photographs
    double light_at(double taken_at) const { return 1.0 + slope * (taken_at - centre); }
};

struct CaptureVerdict {
    std::vector<std::string> warnings;
    LampDrift drift;  ///< to be taken out of the photographs
    /// By role: what the light of a photograph with a small slip of its exposure must be multiplied
    /// by so that it fits the others.
    std::map<std::string, double> gains;
};

/// `captures` in the order in which they were taken, of one size: all of a calibration, or the
/// first of them. Throws Refused for what spoils a calibration: over-exposure, automatic exposure,
/// pictures that arrive late, a camera that moved, shadows, light that changed, single exposures
/// that differ, swapped roles, files that are not linear. Warns of what only makes it worse.
CaptureVerdict check_captures(const std::vector<CaptureSummary>& captures,
                              int block_px,
                              const ShownDrives& drives);

/// A picture of stripes and its inverse.
struct StripePair {
    const CaptureSummary* first = nullptr;
    const CaptureSummary* second = nullptr;
    std::size_t order = 0;  ///< of the first
};

struct Evidence {
    const std::vector<CaptureSummary>* all = nullptr;
    int block_px = 1;
    /// The first photograph of each role; null where there is none.
    const CaptureSummary *white = nullptr, *black = nullptr, *dark = nullptr, *bright = nullptr,
                         *red = nullptr, *green = nullptr, *blue = nullptr, *levels = nullptr;
    std::vector<StripePair> pairs;
    /// Light of full white over black: the median of what the pairs of stripes add up to, else
    /// white
    /// - black or bright-gray - dark-gray. One channel.
    ImageF reference;
    std::vector<std::uint8_t> lit;  ///< blocks with a tenth of the brightest reference or more
    double lit_count = 0.0;
    /// The three tenths of the blocks that the projector lights least, darkest first: of a
    /// picture's corners the camera may see nothing at all.
    std::array<std::vector<std::size_t>, 3> dim;
    double peak = 0.0;  ///< bright reference

    const StripePair* pair_that_begins_with(const CaptureSummary& capture) const;
    std::size_t order_of(const CaptureSummary& capture) const;
};
Evidence gather_evidence(const std::vector<CaptureSummary>& captures, int block_px);

/// light(i) over `reference` on the lit blocks, NaN elsewhere.
template <typename Light>
ImageF ratio_to(const ImageF& reference, const std::vector<std::uint8_t>& lit, const Light& light) {
    ImageF ratio(reference.width, reference.height, 1, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < ratio.values.size(); ++i)
        if (lit[i]) ratio.values[i] = light(i) / reference.values[i];
    return ratio;
}

/// A part of the lit blocks, one piece of it at least 3 x 3, whose ratio is not the typical one.
struct Region {
    double typical = 1.0;             ///< median ratio of all
    double share = 0.0;               ///< of the lit blocks that deviate
    double ratio = 1.0;               ///< median ratio there over the typical one
    std::vector<std::uint8_t> holds;  ///< one a block
    bool found() const { return share > 0.004; }
};
Region region_of(const ImageF& ratio, double tolerance = 0.1);

inline constexpr const char* kManualExposure =
    "set exposure, ISO, aperture and white balance by hand, the same for all, and repeat";
inline constexpr const char* kSteady =
    "let the lamp warm up for 20 minutes, switch off eco and dynamic-contrast modes and automatic "
    "exposure, expose for whole projector frames, and repeat";

/// "30.0% darker".
std::string times_of(double ratio);

/// Photographs that differ from the others in a part of the picture.
[[noreturn]] void refuse_region(const std::string& name, const Region& region);

/// White at an exposure of its own, by the stripes: one that was photographed before the colours,
/// or one after them, of which the colours may tell more.
enum class WhiteTaken { before_colours, after_them };
void refuse_other_white(const Evidence& evidence, WhiteTaken taken);

/// Light that does not come from the projector, from the first photograph to the last.
void check_room_light(const Evidence& evidence, const ShownDrives& drives);

/// Each pair of stripes adds up to white and black, everywhere and every time.
LampDrift check_stripes(const Evidence& evidence, std::vector<std::string>& warnings);

/// The six colour photographs against one another: which stands out, and how.
void check_colours(const Evidence& evidence, const ShownDrives& drives, CaptureVerdict& verdict);

}  // namespace livery
