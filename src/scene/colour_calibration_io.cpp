#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/image_io.h"
#include "core/json.h"
#include "core/paths.h"
#include "core/replace_folder.h"
#include "scene/colour_calibration.h"

namespace livery {

namespace {

constexpr std::size_t kMaxJsonBytes = std::size_t{256} << 20u;

constexpr int kCalibrationVersion = 1;
constexpr int kLargestPlaneSide = 16384;
constexpr double kHuge = 1e300;

const std::vector<std::string> kMatrixNames{
    "m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"};
const std::vector<std::string> kColourNames{"R", "G", "B"};
const std::vector<std::string> kPlaceNames{"X", "Y"};

std::string size_text(int width, int height, int channels) {
    return fmt::format("{}x{} with {} channels", width, height, channels);
}

// ---- Writing

/// The planes must be there and agree before a file is touched.
void check_complete(const ColourCalibration& c) {
    const auto fits = [&](int width, int height, int channels, std::size_t values, int wanted) {
        const auto needed = static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height) *
                            static_cast<std::size_t>(wanted);
        return width == c.width && height == c.height && channels == wanted && values == needed;
    };
    const auto plane_fits = [&](const ImageF& p, int wanted) {
        return fits(p.width, p.height, p.channels, p.values.size(), wanted);
    };
    const auto& status = c.status;
    check_argument(c.width > 0 && c.height > 0 && plane_fits(c.unmixing, 9) &&
                       plane_fits(c.dark, 3) && plane_fits(c.span, 3) &&
                       plane_fits(c.camera_px, 2) &&
                       fits(status.width, status.height, status.channels, status.values.size(), 1),
                   fmt::format("write_calibration: not every plane is {}x{}", c.width, c.height));
    // What is written must open again.
    const auto grid = static_cast<std::size_t>(c.table.grid);
    check_argument(c.table.n_from_drive.size() == grid * grid * grid,
                   fmt::format("write_calibration: {} values in a drive table of {} a side",
                               c.table.n_from_drive.size(),
                               c.table.grid));
    for (const auto& curve : c.response) {
        check_argument(curve.drive_from_n.size() >= 2 && std::isfinite(curve.largest_violation),
                       "write_calibration: a response curve is missing");
    }
    check_argument(std::isfinite(c.additivity_error + c.condition_p99 + c.valid_fraction +
                                 c.ambient_fraction + c.mixing_spread + c.predicted_fraction +
                                 c.prediction_error_median + c.prediction_error_p95),
                   "write_calibration: a residual is not finite");
    ColourCalibration again = c;
    seal(again);
    check_argument(again.id == c.id, "write_calibration: seal the calibration first");
}

Json json_from_curve(const ResponseCurve& curve) {
    return {{"drive_from_n", curve.drive_from_n}, {"largest_violation", curve.largest_violation}};
}

// ---- Reading

ImageF read_plane(const std::filesystem::path& file,
                  const ColourCalibration& c,
                  const std::vector<std::string>& names) {
    const ImageFile picture = read_image(file, c.status.pixel_count());
    const ImageF& image = picture.image;
    const auto wanted = static_cast<int>(names.size());
    if (image.width != c.width || image.height != c.height || image.channels != wanted) {
        throw FileError(file,
                        "size",
                        size_text(image.width, image.height, image.channels),
                        size_text(c.width, c.height, wanted) + ", as calibration.json says");
    }
    // Picture files order channels as they like: the names say which is which.
    std::vector<int> channel;
    for (const auto& name : names) {
        const auto found =
            std::find(picture.channel_names.begin(), picture.channel_names.end(), name);
        if (found == picture.channel_names.end()) {
            throw FileError(file, "channels", "no channel " + name, "a channel of that name");
        }
        channel.push_back(static_cast<int>(found - picture.channel_names.begin()));
    }
    ImageF plane(c.width, c.height, wanted);
    for (int y = 0; y < c.height; ++y) {
        for (int x = 0; x < c.width; ++x) {
            for (int k = 0; k < wanted; ++k) {
                plane.at(x, y, k) = image.at(x, y, channel[static_cast<std::size_t>(k)]);
            }
        }
    }
    return plane;
}

/// A valid pixel's values go straight into the compensation: each must be a number.
void check_valid_pixels(const std::filesystem::path& file,
                        const ColourCalibration& c,
                        const ImageF& plane) {
    for (int y = 0; y < c.height; ++y) {
        for (int x = 0; x < c.width; ++x) {
            if (!is_valid(static_cast<PixelStatus>(c.status.at(x, y)))) continue;
            const float* values = plane.pixel(x, y);
            for (int k = 0; k < plane.channels; ++k) {
                if (std::isfinite(values[k])) continue;
                throw FileError(file,
                                fmt::format("pixel ({}, {})", x, y),
                                fmt::format("{:g}", values[k]),
                                "finite numbers where the status is valid");
            }
        }
    }
}

Image8 read_status(const std::filesystem::path& file, const ColourCalibration& c) {
    const auto pixels = static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
    const ImageFile picture = read_image(file, pixels);
    const ImageF& image = picture.image;
    if (image.width != c.width || image.height != c.height || image.channels != 1 ||
        picture.full_scale != 255.0) {
        throw FileError(file,
                        "size",
                        size_text(image.width, image.height, image.channels),
                        size_text(c.width, c.height, 1) + " of 8 bit, as calibration.json says");
    }
    Image8 status(c.width, c.height, 1);
    for (std::size_t k = 0; k < pixels; ++k) {
        const float value = image.values[k];
        if (value > static_cast<float>(PixelStatus::filled)) {
            throw FileError(file,
                            fmt::format("pixel {}", k),
                            fmt::format("status {:g}", value),
                            "a status from 0 to 9");
        }
        status.values[k] = static_cast<std::uint8_t>(value);
    }
    return status;
}

ResponseCurve read_curve(const JsonReader& field) {
    ResponseCurve curve;
    const auto samples = field["drive_from_n"];
    if (samples.size() < 2 || samples.size() > 65536) {
        samples.fail(fmt::format("{} samples", samples.size()), "2 to 65536 samples");
    }
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const auto drive = static_cast<float>(samples.at(k).number_between(0.0, 255.0));
        if (k > 0 && drive < curve.drive_from_n.back()) {
            samples.at(k).fail(samples.at(k).found(), "at least the sample before it");
        }
        curve.drive_from_n.push_back(drive);
    }
    curve.largest_violation = field["largest_violation"].number_between(0.0, kHuge);
    return curve;
}

DriveTable read_table(const JsonReader& field) {
    DriveTable table;
    table.grid = field["grid"].integer(0, 64);
    const auto grid = static_cast<std::size_t>(table.grid);
    const auto values = field["n_from_drive"].numbers(3 * grid * grid * grid);
    for (std::size_t k = 0; k < values.size(); k += 3) {
        table.n_from_drive.emplace_back(values[k], values[k + 1], values[k + 2]);
    }
    return table;
}

void read_residuals(const JsonReader& field, ColourCalibration& c) {
    c.additivity_error = field["additivity_error"].number_between(0.0, kHuge);
    c.condition_p99 = field["condition_p99"].number_between(0.0, kHuge);
    c.valid_fraction = field["valid_fraction"].number_between(0.0, 1.0);
    c.ambient_fraction = field["ambient_fraction"].number_between(0.0, kHuge);
    c.mixing_spread = field["mixing_spread"].number_between(0.0, kHuge);
    // Files from before there were predictions do not have these.
    const auto later = [&](const char* name, double high) {
        return field.has(name) ? field[name].number_between(0.0, high) : 0.0;
    };
    c.predicted_fraction = later("predicted_fraction", 1.0);
    c.prediction_error_median = later("prediction_error_median", kHuge);
    c.prediction_error_p95 = later("prediction_error_p95", kHuge);
}

}  // namespace

void write_calibration(const std::filesystem::path& folder, const ColourCalibration& c) {
    check_complete(c);
    Json json;
    json["format_version"] = kCalibrationVersion;
    json["kind"] = "colour calibration";
    json["id"] = c.id;
    json["created"] = c.created;
    json["mode"] = c.mode;
    json["made_with"] = c.made_with;
    json["width"] = c.width;
    json["height"] = c.height;
    json["dark_drive"] = c.dark_drive;
    json["bright_drive"] = c.bright_drive;
    json["response"] = {{"red", json_from_curve(c.response[0])},
                        {"green", json_from_curve(c.response[1])},
                        {"blue", json_from_curve(c.response[2])}};
    Json values = Json::array();
    for (const auto& n : c.table.n_from_drive) values.insert(values.end(), {n.x, n.y, n.z});
    json["table"] = {{"grid", c.table.grid}, {"n_from_drive", std::move(values)}};
    json["xyz_from_camera"] = json_from(c.xyz_from_camera);
    json["xyz_origin"] = c.xyz_origin;
    json["camera_ambient"] = json_from(c.camera_ambient);
    json["residuals"] = {{"additivity_error", c.additivity_error},
                         {"condition_p99", c.condition_p99},
                         {"valid_fraction", c.valid_fraction},
                         {"ambient_fraction", c.ambient_fraction},
                         {"mixing_spread", c.mixing_spread},
                         {"predicted_fraction", c.predicted_fraction},
                         {"prediction_error_median", c.prediction_error_median},
                         {"prediction_error_p95", c.prediction_error_p95}};
    json["warnings"] = c.warnings;

    // The JSON comes last: a folder whose writing was cut off does not open.
    FolderReplacement replacement(folder);
    const auto& files = replacement.staging();
    write_exr(files / "unmixing.exr", c.unmixing, kMatrixNames);
    write_exr(files / "dark.exr", c.dark, kColourNames);
    write_exr(files / "span.exr", c.span, kColourNames);
    write_exr(files / "camera_px.exr", c.camera_px, kPlaceNames);
    write_png(files / "status.png", c.status);
    write_json_file(files / "calibration.json", json);
    replacement.commit("calibration.json");
}

ColourCalibration read_calibration(const std::filesystem::path& folder) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error)) {
        throw FileError(folder,
                        "",
                        std::filesystem::exists(folder, error) ? "a file" : "nothing",
                        "a calibration's folder");
    }
    const auto file = folder / "calibration.json";
    ColourCalibration c = parse_calibration(read_text_file(file, kMaxJsonBytes), file);
    c.status = read_status(folder / "status.png", c);
    c.unmixing = read_plane(folder / "unmixing.exr", c, kMatrixNames);
    c.dark = read_plane(folder / "dark.exr", c, kColourNames);
    c.span = read_plane(folder / "span.exr", c, kColourNames);
    c.camera_px = read_plane(folder / "camera_px.exr", c, kPlaceNames);
    check_valid_pixels(folder / "unmixing.exr", c, c.unmixing);
    check_valid_pixels(folder / "dark.exr", c, c.dark);
    check_valid_pixels(folder / "span.exr", c, c.span);

    const std::string written = c.id;
    seal(c);
    if (c.id != written) {
        throw FileError(
            file, "id", written, c.id + " of the content: a file was changed or is of another run");
    }
    return c;
}

ColourCalibration parse_calibration(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.require_format_version(kCalibrationVersion);
    if (const auto kind = root["kind"]; kind.text() != "colour calibration") {
        kind.fail(kind.found(), "\"colour calibration\"");
    }
    root.allow_only({"format_version",
                     "kind",
                     "id",
                     "created",
                     "mode",
                     "made_with",
                     "width",
                     "height",
                     "dark_drive",
                     "bright_drive",
                     "response",
                     "table",
                     "xyz_from_camera",
                     "xyz_origin",
                     "camera_ambient",
                     "residuals",
                     "warnings"});
    ColourCalibration c;
    c.id = root["id"].text();
    c.created = root["created"].text();
    c.mode = root["mode"].text();
    if (c.mode != "paper" && c.mode != "robust") {
        root["mode"].fail(root["mode"].found(), "\"paper\" or \"robust\"");
    }
    c.made_with = root["made_with"].text();
    c.width = root["width"].integer(1, kLargestPlaneSide);
    c.height = root["height"].integer(1, kLargestPlaneSide);
    c.dark_drive = root["dark_drive"].number_between(0.0, 255.0);
    c.bright_drive = root["bright_drive"].number_between(c.dark_drive, 255.0);
    const auto response = root["response"];
    c.response = {
        read_curve(response["red"]), read_curve(response["green"]), read_curve(response["blue"])};
    c.table = read_table(root["table"]);
    c.xyz_from_camera = root["xyz_from_camera"].matrix3();
    if (!(std::abs(glm::determinant(c.xyz_from_camera)) > 0.0)) {
        root["xyz_from_camera"].fail("a singular matrix", "a matrix that can be inverted");
    }
    c.xyz_origin = root["xyz_origin"].text();
    c.camera_ambient = root["camera_ambient"].vec3();
    read_residuals(root["residuals"], c);
    for (std::size_t k = 0; k < root["warnings"].size(); ++k) {
        c.warnings.push_back(root["warnings"].at(k).text());
    }
    return c;
}

}  // namespace livery
