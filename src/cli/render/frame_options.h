// What `livery render` and `livery plan` have in common: the scene, the view and the quality.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "compensation/lit_pixels.h"
#include "core/image.h"
#include "jobs/render/render.h"
#include "ledger/budget.h"
#include "scene/colour_calibration.h"
#include "scene/frame_plan.h"

namespace livery {

struct DesignWhite {
    double y = 0.0;           ///< luminance on the scale of the calibration's XYZ
    double percentile = 0.0;  ///< of the pixels that count
    std::string mask;         ///< in words: which pixels count
    std::size_t pixels = 0;   ///< how many of them are valid
    PixelShares shares;       ///< what becomes of them, valid or not
};

/// `counted`: non-zero counts; empty: all. `mask` says in words what it holds.
DesignWhite design_white_of(const ColourCalibration& calibration,
                            double percentile,
                            const Image8& counted,
                            std::string mask);

/// "design white 0.3, the 20th percentile of 5000 pixels: coverage (92.7% measured, ...)"
std::string text_of(const DesignWhite& white);
/// design_white_y, design_white_mask, design_white_pixels and pixel_fractions.
void tell(const DesignWhite& white, Outcome& outcome);
Json json_of(const PixelShares& shares);

struct FrameArguments {
    std::string product = "car", unit, look = "solid-red", calibration, camera, eye;
    std::string quality, levels, stage = "radiance";
    double budget_ms = 0.0, swap_budget_ms = 0.0;
    double design_white = kDesignWhitePercentile;
    std::string gamut = "strict";
    bool anyway = false;
};

std::vector<Option> frame_options(FrameArguments& arguments);

/// Everything resolved. The view is --camera's, else the one in the calibration folder, else the
/// default bench's projector; the eye is --eye, else the default bench's.
struct ResolvedFrame {
    RenderRequest request;
    std::optional<View> projector;  ///< the calibration's, else the default bench's
    std::optional<CompensationTable> compensation;
    std::optional<DesignWhite> design_white;  ///< of that correction
    std::vector<std::string> notes;     ///< what was assumed or repaired when loading the product
    std::optional<PricedFrame> priced;  ///< where a budget chose the levels
};
ResolvedFrame resolve_frame(const FrameArguments& arguments, const CommonOptions& common);

/// What the correction is scaled to, where there is one: figures, and a line.
void tell_design_white(const ResolvedFrame& frame, Outcome& outcome);

/// passes[], skipped[] and ms_total.
Json json_of(const FramePlan& plan);
/// effects[]: level, milliseconds, what it leaves, what the next level would buy.
Json json_of(const PricedFrame& frame);
std::string text_of(const FramePlan& plan);

}  // namespace livery
