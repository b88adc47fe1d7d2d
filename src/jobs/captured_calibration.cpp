#include "jobs/captured_calibration.h"

#include <algorithm>

#include "calibration/captures/captures.h"
#include "core/error.h"
#include "core/image_io.h"
#include "jobs/camera_to_xyz_file.h"

namespace livery {

namespace {

Captures load(const CapturesFolder& folder, bool with_geometry, const Progress& progress) {
    Captures loaded;
    double done = 0.0;
    for (const Capture& capture : folder.captures) {
        progress.update(done / static_cast<double>(folder.captures.size()),
                        "reading the photographs");
        done += 1.0;
        if (is_geometry_role(capture.role) && !with_geometry) continue;
        add_capture(loaded, {capture.role, load_photograph(capture)});
    }
    return loaded;
}

/// Drive of the uniform picture with this role; the paper's mode takes s and t from here.
std::optional<int> uniform_drive(const CapturesFolder& folder, const std::string& role) {
    for (const Capture& capture : folder.captures) {
        if (capture.role == role && capture.drive.size() == 3) return capture.drive[1];
    }
    return std::nullopt;
}

/// The picture in a pattern's file, at the projector's size.
Pattern read_pattern(const CapturesFolder& folder, const Capture& capture) {
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
    Pattern shown{
        capture.role, Image8(folder.projector_width, folder.projector_height, 3), capture.drive};
    const double per_level = picture.full_scale / 255.0;
    for (std::size_t i = 0; i < picture.image.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const auto from = i * static_cast<std::size_t>(picture.image.channels) + c;
            shown.drive.values[3 * i + c] = static_cast<std::uint8_t>(
                static_cast<double>(picture.image.values[from]) / per_level + 0.5);
        }
    }
    return shown;
}

/// What was shown for each colour role: the pattern files, else the pictures of our own for this
/// size, s and t. A photograph that shows another picture is told by how it follows the levels.
std::vector<Pattern> patterns_shown(const CapturesFolder& folder,
                                    const ColourOptions& options,
                                    std::vector<std::string>& warnings) {
    const int width = folder.projector_width, height = folder.projector_height;
    std::vector<Pattern> patterns =
        colour_patterns(width, height, options.dark_drive, options.bright_drive);
    for (Pattern& mosaic : mosaic_patterns(width, height, kMosaics)) {
        patterns.push_back(std::move(mosaic));
    }
    const auto known_as = [&](const std::string& role) {
        return std::find_if(patterns.begin(), patterns.end(), [&](const Pattern& pattern) {
            return pattern.role == role;
        });
    };
    std::set<std::string> replaced;
    for (const Capture& capture : folder.captures) {
        // What role and drive say of a uniform picture needs no file.
        if (is_geometry_role(capture.role) || capture.pattern.empty() ||
            capture.drive.size() == 3) {
            continue;
        }
        const auto known = known_as(capture.role);
        std::error_code error;
        const bool uniform = known != patterns.end() && known->drive_values.size() == 3;
        if (known != patterns.end() && !uniform &&
            !std::filesystem::exists(capture.pattern, error)) {
            warnings.push_back("the pattern of " + capture.role + ", " + capture.pattern.string() +
                               ", is not there: the picture that livery patterns writes for a " +
                               std::to_string(width) + "x" + std::to_string(height) +
                               " projector is taken to be the one that was shown");
            continue;
        }
        Pattern shown = read_pattern(folder, capture);
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

ColourCalibration calibrate_from_folder(const CapturedCalibrationRequest& request,
                                        const Progress& progress) {
    const CapturesFolder folder = read_captures_folder(request.captures, request.patterns_manifest);

    const bool has_colours =
        std::any_of(folder.captures.begin(), folder.captures.end(), [](const Capture& capture) {
            return !is_geometry_role(capture.role);
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

    Captures loaded = load(folder, !request.map, progress);
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
    std::vector<std::string> warnings;
    const std::vector<Pattern> patterns = patterns_shown(folder, options, warnings);
    ColourCalibration calibration =
        calibrate_from_captures(std::move(loaded), patterns, map, options, progress);
    if (!warnings.empty()) {
        calibration.warnings.insert(calibration.warnings.end(), warnings.begin(), warnings.end());
        seal(calibration);
    }
    return calibration;
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
