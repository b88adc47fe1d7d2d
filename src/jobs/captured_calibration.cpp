#include "jobs/captured_calibration.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include "calibration/captures/captures.h"
#include "calibration/correspondence/fringes.h"
#include "calibration/predict.h"
#include "capture/patterns_folder.h"
#include "core/error.h"
#include "core/image_io.h"
#include "jobs/calibrate/shown_captures.h"
#include "jobs/camera_to_xyz_file.h"
#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

ImageF projector_irradiance(const Mesh& mesh, const View& projector, const Progress& progress) {
    constexpr int kSamplesPerPixel = 16;
    const Tracer tracer(mesh);
    const SurfaceMap map = build_surface_map(mesh, tracer, projector, kSamplesPerPixel, progress);
    const glm::dvec3 lamp = centre_in_world(projector);

    ImageF irradiance(projector.width, projector.height, 1);
    for (const Fragment& fragment : map.fragments) {
        const glm::dvec3 to_lamp = lamp - glm::dvec3(fragment.position_mm);
        const double distance2 = glm::dot(to_lamp, to_lamp);
        // The mean of the normals is shorter than the unit mean normal by their scatter.
        const double shorter = 1.0 / std::sqrt(1.0 + static_cast<double>(fragment.normal_variance));
        const double cosine =
            shorter * glm::dot(glm::dvec3(fragment.normal), to_lamp) / std::sqrt(distance2);
        irradiance.values[fragment.pixel] += static_cast<float>(
            static_cast<double>(fragment.coverage) * std::max(0.0, cosine) / distance2);
    }
    for (std::size_t i = 0; i < irradiance.values.size(); ++i) {
        const float coverage = map.coverage.values[i];
        irradiance.values[i] = coverage < 0.5f ? 0.0f : irradiance.values[i] / coverage;
    }
    return irradiance;
}

namespace {

/// Drive of the uniform picture with this role; the paper's mode takes s and t from here.
std::optional<int> uniform_drive(const CapturesFolder& folder, const std::string& role) {
    for (const Capture& capture : folder.captures) {
        if (capture.role == role && capture.drive.size() == 3) return capture.drive[1];
    }
    return std::nullopt;
}

/// What was shown for each colour role: the pattern files, else the pictures of our own for this
/// size, s and t, of which those mosaics are left out that nobody photographed. A photograph that
/// shows another picture is told by how it follows the levels. Warns of files that are not there,
/// and of photographs with roles that are no colours.
std::vector<Pattern> patterns_shown(const CapturesFolder& folder,
                                    const ColourOptions& options,
                                    std::vector<std::string>& warnings) {
    const int width = folder.projector_width, height = folder.projector_height;
    std::vector<Pattern> patterns =
        colour_patterns(width, height, options.dark_drive, options.bright_drive);
    std::set<std::string> roles, replaced, others;
    for (const Capture& capture : folder.captures) roles.insert(capture.role);
    for (Pattern& mosaic : mosaic_patterns(width, height, kMosaics)) {
        if (roles.contains(mosaic.role)) patterns.push_back(std::move(mosaic));
    }
    for (const Capture& capture : folder.captures) {
        const auto known = std::find_if(patterns.begin(), patterns.end(), [&](const Pattern& one) {
            return one.role == capture.role;
        });
        const bool is_known = known != patterns.end();
        if (!is_known && (capture.pattern.empty() || !capture.role.starts_with("colors-"))) {
            if (!is_geometry_role(capture.role)) others.insert(capture.role);
            continue;
        }
        // What role and drive say of a uniform picture needs no file.
        if (capture.pattern.empty() || capture.drive.size() == 3) continue;
        std::error_code error;
        const bool uniform = is_known && known->drive_values.size() == 3;
        if (is_known && !uniform && !std::filesystem::exists(capture.pattern, error)) {
            warnings.push_back(
                fmt::format("the pattern of {}, {}, is not there: the picture that livery patterns "
                            "writes for a {}x{} projector is taken to be the one that was shown",
                            capture.role,
                            capture.pattern.string(),
                            width,
                            height));
            continue;
        }
        Pattern shown{capture.role, read_pattern(capture.pattern, width, height), capture.drive};
        if (!replaced.insert(capture.role).second && known->drive.values != shown.drive.values) {
            throw FileError(folder.folder / "manifest.json",
                            "pattern",
                            "another picture for " + capture.role + ", " + capture.pattern.string(),
                            "one picture a role, however many shots");
        }
        if (is_known) {
            *known = std::move(shown);
        } else {
            patterns.push_back(std::move(shown));
        }
    }
    for (const std::string& role : others) {
        warnings.push_back("the photographs of " + role + " are not asked for and were not read");
    }
    return patterns;
}

/// Of a capture that was made in stages, the folder with the colours and their map.
CapturedCalibrationRequest of_its_colours(CapturedCalibrationRequest request) {
    std::error_code error;
    const auto colours = request.captures / "colour";
    if (std::filesystem::exists(request.captures / "manifest.json", error) ||
        !std::filesystem::exists(colours / "manifest.json", error))
        return request;
    request.captures = colours;
    if (!request.map && std::filesystem::exists(colours / "map.exr", error))
        request.map = colours / "map.exr";
    return request;
}

}  // namespace

ColourCalibration calibrate_from_folder(const CapturedCalibrationRequest& asked,
                                        const Progress& progress) {
    const CapturedCalibrationRequest request = of_its_colours(asked);
    std::vector<std::string> warnings;
    const CapturesFolder folder = read_shown_captures(
        request.captures, PhotographUse::light, request.patterns_manifest, warnings, progress);
    const int width = folder.projector_width, height = folder.projector_height;
    std::vector<std::string> geometry;
    for (const Capture& capture : folder.captures) {
        if (is_geometry_role(capture.role)) geometry.push_back(capture.role);
    }
    if (geometry.size() == folder.captures.size()) {
        throw FileError(request.captures,
                        "captures",
                        std::to_string(geometry.size()) +
                            (std::any_of(geometry.begin(), geometry.end(), is_fringe_role)
                                 ? " photographs of Gray code and fringes alone"
                                 : " Gray code photographs alone"),
                        "photographs of the colour patterns too (livery patterns --kind all or "
                        "color), with their roles in manifest.json");
    }
    if (!request.map && geometry.empty()) {
        throw FileError(request.captures,
                        "captures",
                        "no Gray code photographs",
                        "Gray code photographs, or --map FILE.exr");
    }

    LiveOptions options;
    options.width = width;
    options.height = height;
    ColourOptions& colour = options.colour;
    colour.mode = request.mode;
    colour.camera_to_xyz =
        request.camera_to_xyz ? read_camera_to_xyz(*request.camera_to_xyz) : assumed_rec709();
    colour.made_with = "photographs in " + request.captures.string();
    colour.dark_drive = uniform_drive(folder, "dark-gray").value_or(colour.dark_drive);
    colour.bright_drive = uniform_drive(folder, "bright-gray").value_or(colour.bright_drive);
    if (request.map) {
        options.map = read_map(*request.map, width, height);
    } else {
        check_gray_code(folder.folder, geometry, width, height);
        if (check_fringes(folder.folder, geometry)) options.places = PlaceCode::gray_and_phase;
    }
    options.patterns = patterns_shown(folder, colour, warnings);
    ColourCalibration calibration = calibrate_live(ports_of(folder), options, progress).calibration;
    if (!warnings.empty()) {
        calibration.warnings.insert(calibration.warnings.end(), warnings.begin(), warnings.end());
        seal(calibration);
    }
    if (!request.product || !request.projector) return calibration;
    return predict_hidden(
        std::move(calibration),
        projector_irradiance(request.product->mesh, *request.projector, progress));
}

ProjectorToCamera read_map(const std::filesystem::path& file,
                           int projector_width,
                           int projector_height) {
    ImageFile picture = read_image(file);
    if (picture.image.width != projector_width || picture.image.height != projector_height) {
        throw FileError(file,
                        "size",
                        fmt::format("{}x{}", picture.image.width, picture.image.height),
                        fmt::format("the projector's {}x{}", projector_width, projector_height));
    }
    if (picture.channel_names != std::vector<std::string>{"X", "Y"}) {
        throw FileError(
            file, "channels", fmt::format("{}", fmt::join(picture.channel_names, ",")), "X,Y");
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
