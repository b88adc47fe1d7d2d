#include "session/captured_calibration.h"

#include <algorithm>

#include "calibration/capture_check.h"
#include "calibration/gray_order.h"
#include "core/error.h"
#include "core/image_io.h"
#include "session/camera_to_xyz_file.h"

namespace livery {

namespace {

bool is_geometry(const std::string& role) {
    return role.starts_with("gray-column-") || role.starts_with("gray-row-") || role == "white" ||
           role == "black";
}

/// What decoding looks at, in a third of the memory.
ImageF mean_of_channels(const ImageF& image) {
    ImageF mean(image.width, image.height, 1);
    for (std::size_t i = 0; i < mean.values.size(); ++i) {
        mean.values[i] =
            (image.values[3 * i] + image.values[3 * i + 1] + image.values[3 * i + 2]) / 3.0f;
    }
    return mean;
}

LoadedCaptures load(const CapturesFolder& folder, bool with_geometry, const Progress& progress) {
    LoadedCaptures loaded;
    double done = 0.0;
    for (const Capture& capture : folder.captures) {
        progress.update(done / static_cast<double>(folder.captures.size()),
                        "reading the photographs");
        done += 1.0;
        if (is_geometry(capture.role) && !with_geometry) continue;
        add_capture(loaded, {capture.role, load_photograph(capture)});
    }
    return loaded;
}

/// Two stripe photographs in each other's place, by which decoded places are torn.
void refuse_exchanged(const std::vector<RoledPhotograph>& geometry,
                      const std::vector<Pattern>& patterns) {
    const Image8& drive = patterns.front().drive;
    if (const auto which = exchanged_stripes(geometry, drive.width, drive.height)) {
        throw Refused("the photographs of " + *which + " are exchanged",
                      "check which file has which role in manifest.json");
    }
}

ProjectorToCamera decoded_map(const std::vector<RoledPhotograph>& geometry,
                              int width,
                              int height,
                              std::vector<std::string>& warnings) {
    ProjectorToCamera map = invert_map(decode_gray_code(geometry, width, height), width, height);
    if (is_mirrored(map)) {
        warnings.push_back(
            "the photographs are mirrored against the projector's picture: right with a mirror in "
            "the way or a projector set for rear projection; else the files are mirrored");
    }
    return map;
}

/// Drive of the uniform picture with this role; the paper's mode takes s and t from here.
std::optional<int> uniform_drive(const CapturesFolder& folder, const std::string& role) {
    for (const Capture& capture : folder.captures) {
        if (capture.role == role && capture.drive.size() == 3) return capture.drive[1];
    }
    return std::nullopt;
}

/// What was shown for each colour role: the pattern files, else the pictures of our own for s and
/// t.
std::vector<Pattern> patterns_shown(const CapturesFolder& folder, const ColourOptions& options) {
    std::vector<Pattern> patterns = colour_patterns(
        folder.projector_width, folder.projector_height, options.dark_drive, options.bright_drive);
    std::set<std::string> replaced;
    for (const Capture& capture : folder.captures) {
        // What role and drive say of a uniform picture needs no file.
        if (is_geometry(capture.role) || capture.pattern.empty() || capture.drive.size() == 3) {
            continue;
        }
        const ImageFile picture = read_image(capture.pattern);
        if (picture.image.width != folder.projector_width ||
            picture.image.height != folder.projector_height || picture.image.channels < 3) {
            throw FileError(capture.pattern,
                            "size",
                            std::to_string(picture.image.width) + "x" +
                                std::to_string(picture.image.height) + " with " +
                                std::to_string(picture.image.channels) + " channels",
                            "the projector's " + std::to_string(folder.projector_width) + "x" +
                                std::to_string(folder.projector_height) + " with 3");
        }
        Pattern shown{capture.role,
                      Image8(folder.projector_width, folder.projector_height, 3),
                      capture.drive};
        const double per_level = picture.full_scale / 255.0;
        for (std::size_t i = 0; i < picture.image.pixel_count(); ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
                const auto from = i * static_cast<std::size_t>(picture.image.channels) + c;
                shown.drive.values[3 * i + c] = static_cast<std::uint8_t>(
                    static_cast<double>(picture.image.values[from]) / per_level + 0.5);
            }
        }
        const auto known =
            std::find_if(patterns.begin(), patterns.end(), [&](const Pattern& pattern) {
                return pattern.role == capture.role;
            });
        if (!replaced.insert(capture.role).second && known->drive.values != shown.drive.values) {
            throw FileError(folder.folder / "manifest.json",
                            "pattern",
                            "another picture for " + capture.role + ", " + capture.pattern.string(),
                            "one picture a role, however many shots");
        }
        if (known != patterns.end()) {
            *known = std::move(shown);
        } else {
            patterns.push_back(std::move(shown));
        }
    }
    return patterns;
}

}  // namespace

void add_capture(LoadedCaptures& captures, RoledPhotograph photograph) {
    ImageF& image = photograph.photograph.image;
    captures.summaries.push_back(summarise(photograph));
    captures.sizes.insert({image.width, image.height});
    const bool geometry = is_geometry(photograph.role);
    if (geometry) image = mean_of_channels(image);
    (geometry ? captures.geometry : captures.colours).push_back(std::move(photograph));
}

ColourCalibration calibrate_from_captures(LoadedCaptures captures,
                                          const std::vector<Pattern>& patterns,
                                          const std::optional<ProjectorToCamera>& map,
                                          const ColourOptions& options,
                                          const Progress& progress) {
    check_argument(!patterns.empty(), "calibrate_from_captures: no patterns");
    // Before anything is solved: the projector must not be blamed for a shadow. Photographs of
    // several sizes are refused by name where they are used.
    std::vector<std::string> warnings;
    if (!map && captures.sizes.size() == 1) refuse_exchanged(captures.geometry, patterns);
    if (captures.sizes.size() == 1) {
        warnings = check_captures(captures.summaries,
                                  summary_block_px(captures.sizes.begin()->first),
                                  {options.dark_drive, options.bright_drive});
    }
    const ProjectorToCamera places = map ? *map
                                         : decoded_map(captures.geometry,
                                                       patterns.front().drive.width,
                                                       patterns.front().drive.height,
                                                       warnings);
    captures.geometry.clear();
    ColourCalibration calibration =
        calibrate_colour(captures.colours, patterns, places, options, progress);
    if (!warnings.empty()) {
        calibration.warnings.insert(calibration.warnings.begin(), warnings.begin(), warnings.end());
        seal(calibration);
    }
    return calibration;
}

ColourCalibration calibrate_from_folder(const CapturedCalibrationRequest& request,
                                        const Progress& progress) {
    const CapturesFolder folder = read_captures_folder(request.captures, request.patterns_manifest);

    const bool has_colours =
        std::any_of(folder.captures.begin(), folder.captures.end(), [](const Capture& capture) {
            return !is_geometry(capture.role);
        });
    if (!has_colours) {
        throw FileError(request.captures,
                        "captures",
                        std::to_string(folder.captures.size()) + " Gray code photographs alone",
                        "photographs of the colour patterns too (livery patterns --kind all or "
                        "color), with their roles in manifest.json");
    }

    ColourOptions options;
    options.mode = request.mode;
    options.camera_to_xyz =
        request.camera_to_xyz ? read_camera_to_xyz(*request.camera_to_xyz) : assumed_rec709();
    options.made_with = "photographs in " + request.captures.string();
    options.dark_drive = uniform_drive(folder, "dark-gray").value_or(options.dark_drive);
    options.bright_drive = uniform_drive(folder, "bright-gray").value_or(options.bright_drive);

    LoadedCaptures loaded = load(folder, !request.map, progress);
    if (!request.map && loaded.geometry.empty()) {
        throw FileError(request.captures,
                        "captures",
                        "no Gray code photographs",
                        "Gray code photographs, or --map FILE.exr");
    }
    std::optional<ProjectorToCamera> map;
    if (request.map) {
        map = read_map(*request.map, folder.projector_width, folder.projector_height);
    }
    return calibrate_from_captures(
        std::move(loaded), patterns_shown(folder, options), map, options, progress);
}

ProjectorToCamera read_map(const std::filesystem::path& file,
                           int projector_width,
                           int projector_height) {
    ImageFile picture = read_image(file);
    if (picture.image.width != projector_width || picture.image.height != projector_height) {
        throw FileError(
            file,
            "size",
            std::to_string(picture.image.width) + "x" + std::to_string(picture.image.height),
            "the projector's " + std::to_string(projector_width) + "x" +
                std::to_string(projector_height));
    }
    if (picture.channel_names != std::vector<std::string>{"X", "Y"}) {
        std::string names;
        for (const auto& name : picture.channel_names) names += (names.empty() ? "" : ",") + name;
        throw FileError(file, "channels", names, "X,Y");
    }
    ProjectorToCamera map{
        std::move(picture.image), Image8(projector_width, projector_height, 1), {}};
    // OpenCV's pixel centres are integers, ours half integers.
    for (float& value : map.camera_px.values) value += 0.5f;
    return map;
}

void write_map(const std::filesystem::path& file, const ProjectorToCamera& map) {
    ImageF picture = map.camera_px;
    for (float& value : picture.values) value -= 0.5f;
    write_exr(file, picture, {"X", "Y"});
}

}  // namespace livery
