#include "calibration/captures/captures.h"

#include <algorithm>
#include <utility>

#include "calibration/colour/colour_report.h"
#include "calibration/correspondence/exposed_alike.h"
#include "calibration/correspondence/gray_order.h"
#include "core/error.h"

namespace livery {
namespace {

/// Undoes a change of the light by `factor`. Room light is scaled with it: rightly for an exposure;
/// for a lamp wrongly, by a hundredth of itself at most, since it may not change by more while the
/// colours are photographed.
void divide_light(Photograph& photo, double factor) {
    const auto gain = static_cast<float>(1.0 / factor),
               black = static_cast<float>(photo.black_level);
    for (float& value : photo.image.values) value = black + (value - black) * gain;
}

/// Each as if it had been taken when bright-gray was, at the exposure of the others.
void take_out(const CaptureVerdict& verdict, std::vector<RoledPhotograph>& colours) {
    const auto bright = std::find_if(colours.begin(), colours.end(), [](const auto& colour) {
        return colour.role == "bright-gray";
    });
    if (bright == colours.end()) return;  // refused by name where the colours are sampled
    const double reference = verdict.drift.light_at(bright->photograph.taken_at);
    for (auto& [role, photograph] : colours) {
        if (role == "dark-gray") continue;  // hardly any of its light is the lamp's
        double light = verdict.drift.light_at(photograph.taken_at) / reference;
        const auto gain = verdict.gains.find(role);
        if (gain != verdict.gains.end()) light /= gain->second;
        if (light != 1.0) divide_light(photograph, light);
    }
}

}  // namespace

bool is_geometry_role(const std::string& role) {
    return role.starts_with("gray-column-") || role.starts_with("gray-row-") ||
           is_fringe_role(role) || role == "white" || role == "black";
}

void add_capture(Captures& captures, RoledPhotograph photograph) {
    ImageF& image = photograph.photograph.image;
    std::vector<CaptureSummary>& summaries = captures.summaries;
    CaptureSummary summary = summarise(photograph);
    const auto later = std::upper_bound(
        summaries.begin(), summaries.end(), summary, [](const auto& one, const auto& other) {
            return one.taken_at < other.taken_at;
        });
    summaries.insert(later, std::move(summary));
    captures.width = image.width;
    const bool geometry = is_geometry_role(photograph.role);
    if (geometry)
        image = is_fringe_role(photograph.role) ? unsaturated_mean(photograph.photograph)
                                                : mean_of_channels(image);
    (geometry ? captures.geometry : captures.colours).push_back(std::move(photograph));
}

CaptureVerdict judge_captures(const Captures& captures,
                              int projector_width,
                              int projector_height,
                              const ShownDrives& drives,
                              bool with_stripes) {
    if (with_stripes)
        if (const auto which =
                exchanged_stripes(captures.geometry, projector_width, projector_height))
            throw Refused("the photographs of " + *which + " are exchanged",
                          "check which file has which role in manifest.json, and that each "
                          "picture is shown when its photograph is taken");
    return check_captures(captures.summaries, summary_block_px(captures.width), drives);
}

ProjectorToCamera map_of_captures(const Captures& captures,
                                  int projector_width,
                                  int projector_height,
                                  std::vector<std::string>& warnings,
                                  SeparatedLight* light) {
    constexpr double kMuchGlobal = 0.05;
    FineCode code = decode_places(captures.geometry, projector_width, projector_height);
    ProjectorToCamera map = invert_map(code.places, projector_width, projector_height);
    if (code.report.global_fraction > kMuchGlobal)
        warnings.push_back(
            percent(code.report.global_fraction) +
            " of the camera pixels where the Gray code was decoded get most of their light from "
            "other parts, through the material, or blurred, and were left out: cover what shines "
            "on the mock-up with dark cloth, and check the focus over its whole depth");
    if (light) *light = std::move(code.light);
    if (is_mirrored(map))
        warnings.push_back(
            "the photographs are mirrored against the projector's picture: right with a mirror in "
            "the way or a projector set for rear projection; else the files are mirrored");
    return map;
}

ColourCalibration calibrate_judged(Captures& captures,
                                   const CaptureVerdict& verdict,
                                   const std::vector<Pattern>& patterns,
                                   const ProjectorToCamera& map,
                                   const ColourOptions& options,
                                   const Progress& progress) {
    captures.geometry.clear();
    take_out(verdict, captures.colours);
    ColourCalibration calibration =
        calibrate_colour(captures.colours, patterns, map, options, progress);
    if (!verdict.warnings.empty()) {
        calibration.warnings.insert(
            calibration.warnings.begin(), verdict.warnings.begin(), verdict.warnings.end());
        seal(calibration);
    }
    return calibration;
}

}  // namespace livery
