#include "calibration/captures/captures.h"

#include <map>

#include "calibration/correspondence/gray_order.h"
#include "core/error.h"

namespace livery {
namespace {

/// What decoding looks at, in a third of the memory.
ImageF mean_of_channels(const ImageF& image) {
    if (image.channels == 1) return image;
    ImageF mean(image.width, image.height, 1);
    for (std::size_t i = 0; i < mean.values.size(); ++i)
        mean.values[i] =
            (image.values[3 * i] + image.values[3 * i + 1] + image.values[3 * i + 2]) / 3.0f;
    return mean;
}

/// Undoes a change of the light by `factor`. Room light is scaled with it: rightly for an exposure;
/// for a lamp wrongly, by a hundredth of itself at most, since it may not change by more while the
/// colours are photographed.
void divide_light(Photograph& photo, double factor) {
    const auto gain = static_cast<float>(1.0 / factor),
               black = static_cast<float>(photo.black_level);
    for (float& value : photo.image.values) value = black + (value - black) * gain;
}

/// Each as if it had been taken when bright-gray was, at the exposure of the others.
void take_out(const CaptureVerdict& verdict, Captures& captures) {
    const auto taken_at = [&](const std::string& role, std::size_t nth) {
        for (const CaptureSummary& summary : captures.summaries)
            if (summary.role == role && nth-- == 0) return summary.taken_at;
        return 0.0;
    };
    const double reference = verdict.drift.light_at(taken_at("bright-gray", 0));
    std::map<std::string, std::size_t> shots;
    for (RoledPhotograph& colour : captures.colours) {
        const std::size_t nth = shots[colour.role]++;
        if (colour.role == "dark-gray") continue;  // hardly any of its light is the lamp's
        double light = verdict.drift.light_at(taken_at(colour.role, nth)) / reference;
        const auto gain = verdict.gains.find(colour.role);
        if (gain != verdict.gains.end()) light /= gain->second;
        if (light != 1.0) divide_light(colour.photograph, light);
    }
}

}  // namespace

bool is_geometry_role(const std::string& role) {
    return role.starts_with("gray-column-") || role.starts_with("gray-row-") || role == "white" ||
           role == "black";
}

void add_capture(Captures& captures, RoledPhotograph photograph, double taken_at) {
    ImageF& image = photograph.photograph.image;
    const double before = captures.summaries.empty() ? -1.0 : captures.summaries.back().taken_at;
    captures.summaries.push_back(summarise(photograph));
    captures.summaries.back().taken_at = taken_at >= 0.0 ? taken_at : before + 1.0;
    captures.sizes.insert({image.width, image.height});
    const bool geometry = is_geometry_role(photograph.role);
    if (geometry) image = mean_of_channels(image);
    (geometry ? captures.geometry : captures.colours).push_back(std::move(photograph));
}

CaptureVerdict judge_captures(const Captures& captures,
                              int projector_width,
                              int projector_height,
                              const ShownDrives& drives,
                              bool with_stripes) {
    if (captures.sizes.size() != 1) return {};
    if (with_stripes)
        if (const auto which =
                exchanged_stripes(captures.geometry, projector_width, projector_height))
            throw Refused("the photographs of " + *which + " are exchanged",
                          "check which file has which role in manifest.json, and that each "
                          "picture is shown when its photograph is taken");
    return check_captures(
        captures.summaries, summary_block_px(captures.sizes.begin()->first), drives);
}

ProjectorToCamera map_of_captures(const Captures& captures,
                                  int projector_width,
                                  int projector_height,
                                  std::vector<std::string>& warnings) {
    ProjectorToCamera map =
        invert_map(decode_gray_code(captures.geometry, projector_width, projector_height),
                   projector_width,
                   projector_height);
    if (is_mirrored(map))
        warnings.push_back(
            "the photographs are mirrored against the projector's picture: right with a mirror in "
            "the way or a projector set for rear projection; else the files are mirrored");
    return map;
}

ColourCalibration calibrate_judged(Captures captures,
                                   const CaptureVerdict& verdict,
                                   const std::vector<Pattern>& patterns,
                                   const ProjectorToCamera& map,
                                   const ColourOptions& options,
                                   const Progress& progress) {
    captures.geometry.clear();
    take_out(verdict, captures);
    ColourCalibration calibration =
        calibrate_colour(captures.colours, patterns, map, options, progress);
    if (!verdict.warnings.empty()) {
        calibration.warnings.insert(
            calibration.warnings.begin(), verdict.warnings.begin(), verdict.warnings.end());
        seal(calibration);
    }
    return calibration;
}

ColourCalibration calibrate_from_captures(Captures captures,
                                          const std::vector<Pattern>& patterns,
                                          const std::optional<ProjectorToCamera>& map,
                                          const ColourOptions& options,
                                          const Progress& progress) {
    check_argument(!patterns.empty(), "calibrate_from_captures: no patterns");
    const Image8& drive = patterns.front().drive;
    // Before anything is solved: the projector must not be blamed for a shadow.
    CaptureVerdict verdict = judge_captures(
        captures, drive.width, drive.height, {options.dark_drive, options.bright_drive}, !map);
    const ProjectorToCamera places =
        map ? *map : map_of_captures(captures, drive.width, drive.height, verdict.warnings);
    return calibrate_judged(std::move(captures), verdict, patterns, places, options, progress);
}

}  // namespace livery
