#include "jobs/file_check.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <new>
#include <set>
#include <string>
#include <vector>

#include "appearance/directions.h"
#include "appearance/material_library.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/measured/measured_reflectance.h"
#include "appearance/subsurface/radial_profile.h"
#include "appearance/subsurface/scattering_stack.h"
#include "appearance/subsurface/translucent_material.h"
#include "calibration/captures/captures.h"
#include "calibration/registration/picked_points.h"
#include "calibration/settings.h"
#include "capture/captures_folder.h"
#include "capture/patterns_folder.h"
#include "capture/stand_folders.h"
#include "compensation/lit_pixels.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/json.h"
#include "core/paths.h"
#include "core/text/csv.h"
#include "core/utf8.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/pair_geometry.h"
#include "jobs/registration.h"
#include "scene/colour_calibration.h"
#include "scene/look.h"
#include "scene/mockup_pose.h"
#include "scene/product.h"
#include "scene/room.h"
#include "scene/view.h"
#include "session/session_file.h"
#include "twin/description.h"
#include "twin/spectra.h"

namespace livery {

namespace {

/// Collects what a file in `folder` reads. Links count as where they lead.
class FilesElsewhere {
  public:
    explicit FilesElsewhere(const std::filesystem::path& folder);

    /// Nothing for files below the folder or among the shipped data.
    void add(const std::filesystem::path& file);
    /// "reads A and B, which lie elsewhere"; empty when there is none.
    std::string note() const;

  private:
    std::filesystem::path folder_, shipped_;
    std::vector<std::string> files_;
    std::size_t count_ = 0;
};

using Path = std::filesystem::path;

constexpr std::size_t kMostNamed = 5;

Path resolved(const Path& path) {
    std::error_code error;
    const Path absolute = std::filesystem::absolute(path, error);
    const Path canonical = std::filesystem::weakly_canonical(absolute, error);
    return error ? absolute.lexically_normal() : canonical;
}

bool is_below(const Path& file, const Path& folder) {
    const auto part = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first;
    return !folder.empty() && part == folder.end();
}

FilesElsewhere::FilesElsewhere(const Path& folder)
    : folder_(resolved(folder.empty() ? Path(".") : folder)) {
    try {
        shipped_ = resolved(shipped_path("materials")).parent_path();
    } catch (const FileError&) {
        // Without shipped data nothing lies among them.
    }
}

void FilesElsewhere::add(const Path& file) {
    if (file.empty()) return;
    const Path place = resolved(file);
    if (is_below(place, folder_) || is_below(place, shipped_)) return;
    const std::string name = printable(place.string(), 200);
    if (std::find(files_.begin(), files_.end(), name) != files_.end()) return;
    ++count_;
    if (files_.size() < kMostNamed) files_.push_back(name);
}

std::string FilesElsewhere::note() const {
    if (files_.empty()) return "";
    std::string text = "reads " + list_of(files_);
    if (count_ > files_.size()) text += " and " + std::to_string(count_ - files_.size()) + " more";
    return text + (count_ == 1 ? ", which lies elsewhere" : ", which lie elsewhere");
}

using Path = std::filesystem::path;

struct FileKind {
    std::string name;
    std::function<void(const Path&, FileCheck&)> read;
};

std::string suffix_of(const Path& file) {
    std::string suffix = file.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return suffix;
}

bool is_there(const Path& file) {
    std::error_code error;
    return std::filesystem::exists(file, error);
}

/// As make_scene finds a look's paints.
Path file_beside(const Path& folder, const std::string& name) {
    std::error_code error;
    const Path beside = folder / name;
    return std::filesystem::is_regular_file(beside, error) ? beside : Path(name);
}

void check_calibration(const Path& folder, FileCheck& check) {
    const PixelShares shares = pixel_shares(read_calibration(folder), {});
    check.notes.push_back("of the lit pixels " + text_of(shares));
}

void check_mesh(const Path& file, FileCheck& check) { load_mesh(file, &check.notes); }

void tell(const FilesElsewhere& elsewhere, FileCheck& check) {
    if (const std::string note = elsewhere.note(); !note.empty()) check.notes.push_back(note);
}

void check_photographs(const std::vector<Capture>& captures,
                       const Path& folder,
                       FileCheck& check,
                       const Progress& progress) {
    double done = 0.0;
    FilesElsewhere elsewhere(folder);
    for (const Capture& capture : captures) {
        elsewhere.add(capture.file);
        elsewhere.add(capture.pattern);
        const bool response = capture.transfer != "linear" && capture.transfer != "srgb";
        if (response) elsewhere.add(capture.transfer);
    }
    tell(elsewhere, check);
    for (const Capture& capture : captures) {
        progress.update(done / static_cast<double>(captures.size()),
                        "checking " + capture.file.string());
        done += 1.0;
        try {
            load_photograph(capture);
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& error) {
            check.problems.emplace_back(error.what());
        }
    }
}

void read_captures(const Path& folder,
                   const Path& patterns,
                   FileCheck& check,
                   const Progress& progress) {
    CapturesFolder captures = read_captures_folder(folder, PhotographUse::places, patterns);
    const bool of_colours =
        std::any_of(captures.captures.begin(), captures.captures.end(), [](const Capture& capture) {
            return !is_geometry_role(capture.role);
        });
    if (of_colours) captures = read_captures_folder(folder, PhotographUse::light, patterns);
    const auto [shortest, longest] = std::minmax_element(
        captures.captures.begin(), captures.captures.end(), [](const auto& a, const auto& b) {
            return a.exposure_s < b.exposure_s;
        });
    const std::string least = text_of(ExposureSettings{shortest->exposure_s, 0.0, 0.0}),
                      most = text_of(ExposureSettings{longest->exposure_s, 0.0, 0.0});
    check.notes.push_back(std::to_string(captures.captures.size()) + " photographs, exposed for " +
                          least + (most == least ? "" : " to " + most));
    // Who named the patterns knows that they lie elsewhere.
    if (!patterns.empty())
        for (Capture& capture : captures.captures) capture.pattern.clear();
    check_photographs(captures.captures, folder, check, progress);
}

/// Photographs of a painted sphere.
void read_sphere(const Path& manifest, FileCheck& check, const Progress& progress) {
    const SphereFolder folder = read_sphere_folder(manifest.parent_path());
    parse_camera(folder.camera, folder.camera_origin);
    if (!folder.camera_to_xyz.empty()) read_camera_to_xyz(folder.camera_to_xyz);
    std::vector<Capture> captures;
    for (const auto* list : {&folder.captures, &folder.white}) {
        for (const SphereCapture& capture : *list) captures.push_back(capture.photograph);
    }
    FilesElsewhere elsewhere(manifest.parent_path());
    elsewhere.add(folder.camera_origin.starts_with(manifest.string()) ? Path()
                                                                      : Path(folder.camera_origin));
    elsewhere.add(folder.camera_to_xyz);
    tell(elsewhere, check);
    check_photographs(captures, manifest.parent_path(), check, progress);
}

void read_picture(const Path& file, FileCheck& check) {
    const ImageFile picture = read_image(file);
    // Of the colours: a path tracer's picture may say that it does not know how sure a pixel is.
    const auto channels = static_cast<std::size_t>(picture.image.channels);
    std::size_t bad = 0;
    for (std::size_t i = 0; i < picture.image.values.size(); ++i) {
        const std::size_t c = i % channels;
        const bool is_colour = c >= picture.channel_names.size() ||
                               picture.channel_names[c].find('.') == std::string::npos;
        bad += is_colour && !std::isfinite(picture.image.values[i]) ? 1u : 0u;
    }
    if (bad > 0) {
        check.problems.push_back(std::to_string(bad) + " values are not finite");
    }
}

/// Photographs of a mirror ball or a panorama.
void read_environment(const Path& manifest, FileCheck& check, const Progress& progress) {
    const EnvironmentFolder folder = read_environment_folder(manifest.parent_path());
    if (!folder.camera_to_xyz.empty()) read_camera_to_xyz(folder.camera_to_xyz);
    FilesElsewhere elsewhere(manifest.parent_path());
    elsewhere.add(folder.camera_to_xyz);
    std::vector<Path> masks{folder.panorama.mask};
    for (const BallView& view : folder.views) {
        parse_camera(view.camera, view.camera_origin);
        if (!view.camera_origin.starts_with(manifest.string())) elsewhere.add(view.camera_origin);
        masks.push_back(view.mask);
    }
    for (const Path& mask : masks) {
        if (mask.empty()) continue;
        elsewhere.add(mask);
        read_picture(mask, check);
    }
    tell(elsewhere, check);
    check_photographs(photographs_of(folder), manifest.parent_path(), check, progress);
}

/// Photographs of a spot of light on a translucent sample.
void read_spot(const Path& manifest, FileCheck& check, const Progress& progress) {
    const SpotFolder folder = read_spot_folder(manifest.parent_path());
    FilesElsewhere elsewhere(manifest.parent_path());
    if (folder.places) {
        const std::string& origin = folder.places->camera_origin;
        parse_camera(folder.places->camera, origin);
        if (!origin.starts_with(manifest.string())) elsewhere.add(origin);
    }
    tell(elsewhere, check);
    check_photographs(photographs_of(folder), manifest.parent_path(), check, progress);
}

/// A map from projector to camera pixels says "unknown" with NaN: that is no problem.
void read_map(const Path& file, FileCheck& check) {
    const ImageFile map = read_image(file);
    check.notes.push_back(std::to_string(map.image.width) + "x" + std::to_string(map.image.height) +
                          " projector pixels");
}

void read_patterns(const Path& manifest, FileCheck& check) {
    const PatternsManifest patterns = read_patterns_manifest(manifest);
    FilesElsewhere elsewhere(manifest.parent_path());
    for (const PatternEntry& pattern : patterns.patterns) {
        elsewhere.add(manifest.parent_path() / pattern.file);
    }
    tell(elsewhere, check);
    for (const PatternEntry& pattern : patterns.patterns) {
        read_picture(manifest.parent_path() / pattern.file, check);
    }
    check.notes.emplace_back("patterns that nobody has photographed yet");
}

void read_session(const Path& file, FileCheck& check) {
    SessionFile session(file, SessionFile::Access::read);
    session.check_all();
    const std::int64_t steps = session.last_step();
    const Document document = with_paints_read(session.document(session.position()));
    check.notes.push_back(std::to_string(document.looks.size()) + " looks, " +
                          std::to_string(steps) + (steps == 1 ? " step" : " steps"));
    std::set<std::string> environments;
    FilesElsewhere elsewhere(file.parent_path());
    std::error_code error;
    if (std::filesystem::is_regular_file(document.product, error)) elsewhere.add(document.product);
    elsewhere.add(document.calibration);
    for (const SessionLook& look : document.looks) {
        Look look_here = look.look;
        for_each_paint(look_here, [&](std::string& paint) {
            const Material material = find_paint(document, paint);
            elsewhere.add(material.file);
            if (material.measured) elsewhere.add(material.measured->file);
        });
        for (const Artwork& artwork : look_here.artwork) elsewhere.add(artwork.picture);
        const EnvironmentReference& environment = look.look.environment;
        if (environments.insert(environment.file).second) {
            elsewhere.add(load_environment(environment, {}).file);
        }
    }
    tell(elsewhere, check);
}

FileKind kind_of_manifest(const Path& manifest, const Progress& progress) {
    if (is_patterns_manifest(manifest)) {
        return {"patterns",
                [manifest](const Path&, FileCheck& check) { read_patterns(manifest, check); }};
    }
    if (is_environment_manifest(manifest)) {
        return {"environment captures", [manifest, progress](const Path&, FileCheck& check) {
                    read_environment(manifest, check, progress);
                }};
    }
    // Before spheres, whose folders have a white reference too.
    if (is_spot_manifest(manifest)) {
        return {"spot captures", [manifest, progress](const Path&, FileCheck& check) {
                    read_spot(manifest, check, progress);
                }};
    }
    if (is_sphere_manifest(manifest)) {
        return {"sphere captures", [manifest, progress](const Path&, FileCheck& check) {
                    read_sphere(manifest, check, progress);
                }};
    }
    return {"captures", [manifest, progress](const Path&, FileCheck& check) {
                read_captures(manifest.parent_path(), {}, check, progress);
            }};
}

FileKind kind_of_folder(const Path& folder, const Path& patterns, const Progress& progress) {
    if (is_there(folder / "calibration.json")) {
        return {"calibration", check_calibration};
    }
    if (is_there(folder / "manifest.json")) {
        return kind_of_manifest(folder / "manifest.json", progress);
    }
    if (is_there(folder / "geometry.json")) {
        return {"geometry", [](const Path& path, FileCheck&) {
                    check_geometry_file(path / "geometry.json");
                    read_calibrated_pair(path);
                }};
    }
    if (is_there(folder / "pose.json")) {
        return {"pose", [](const Path& path, FileCheck&) {
                    read_pose_file(path / "pose.json");
                    read_calibrated_pair(path);
                }};
    }
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (has_picture_suffix(entry.path())) {
            return {"captures", [patterns, progress](const Path& path, FileCheck& check) {
                        read_captures(path, patterns, check, progress);
                    }};
        }
    }
    throw FileError(folder,
                    "",
                    error ? error.message()
                          : "no calibration.json, geometry.json, pose.json, manifest.json or "
                            "picture in it",
                    "a calibration, geometry, pose, patterns or captures folder");
}

void check_look(const Path& file, FileCheck& check) {
    Look look = read_look_file(file);
    const Path folder = file.parent_path();
    FilesElsewhere elsewhere(folder);
    for_each_paint(look, [&](std::string& paint) {
        const Material material = find_material(file_beside(folder, paint).string());
        elsewhere.add(material.file);
        if (material.measured) elsewhere.add(material.measured->file);
    });
    for (const Artwork& artwork : look.artwork) {
        if (artwork.picture.empty()) continue;
        const Path picture = find_artwork_picture(artwork.picture, folder);
        elsewhere.add(picture);
        load_artwork_picture(picture);
    }
    elsewhere.add(load_environment(look.environment, folder).file);
    tell(elsewhere, check);
}

FileKind kind_of_json(const Path& file, const Progress& progress) {
    const Json json = read_json_file(file);
    const auto has = [&](const char* key) { return json.contains(key); };
    if (has("captures")) return kind_of_manifest(file, progress);
    if (has("model") || has("parameters")) {
        return {"material", [](const Path& path, FileCheck&) { read_material_file(path); }};
    }
    if (has("kind") && json["kind"] == "geometry") {
        return {"geometry", [](const Path& path, FileCheck&) { check_geometry_file(path); }};
    }
    if (has("kind") && json["kind"] == "room") {
        return {"room", [](const Path& path, FileCheck&) { read_room_file(path); }};
    }
    if (has("kind") && json["kind"] == "origin") {
        return {"origin of a calibration",
                [](const Path& path, FileCheck&) { read_origin(path.parent_path()); }};
    }
    if (has("kind") && json["kind"] == "translucent") {
        return {"translucent",
                [](const Path& path, FileCheck&) { read_translucent_material(path); }};
    }
    if (has("layers")) {
        return {"layers", [](const Path& path, FileCheck&) { read_scattering_stack(path); }};
    }
    if (has("kind") && json["kind"] == "pose") {
        return {"pose", [](const Path& path, FileCheck&) { read_pose_file(path); }};
    }
    if (has("camera") || has("mockup") || has("base")) {
        return {"bench", [](const Path& path, FileCheck&) { read_bench_file(path); }};
    }
    if (has("mesh")) {
        return {"product", [](const Path& path, FileCheck& check) {
                    check.notes = load_product(path).notes;
                    FilesElsewhere elsewhere(path.parent_path());
                    elsewhere.add(parse_product_file(read_text_file(path), path).mesh);
                    tell(elsewhere, check);
                }};
    }
    if (has("lights") || has("environment") || has("exposure_ev")) {
        return {"look", check_look};
    }
    if (has("width") || has("distortion")) {
        return {"camera", [](const Path& path, FileCheck&) { read_camera_file(path); }};
    }
    if (has("primaries_xyz") || has("matrix")) {
        return {"camera-to-xyz", [](const Path& path, FileCheck&) { read_camera_to_xyz(path); }};
    }
    return {"unknown", [](const Path& path, FileCheck&) {
                throw FileError(
                    path,
                    "",
                    "a JSON object of no known kind",
                    "a material, translucent material, layers, look, product, bench, camera, "
                    "geometry, pose, room, camera-to-xyz or captures "
                    "file");
            }};
}

void check_measured(const Path& file, FileCheck& check) {
    const MeasuredCoverage coverage = coverage_of(read_measured_file(file));
    check.notes.push_back(std::to_string(coverage.samples) + " samples");
    if (coverage.masked > 0) {
        check.notes.push_back(std::to_string(coverage.masked) +
                              " left out: negative, so not measured");
    }
}

/// By the names of its columns.
FileKind kind_of_csv(const Path& file) {
    const std::string text = read_text_file(file, std::size_t{1} << 30u);
    const CsvReader csv(text, file);
    if (csv.find("wavelength") || csv.find("nm")) {
        return {"spectra", [](const Path& path, FileCheck&) { read_spectra_csv(path); }};
    }
    if (csv.find("theta_i") && csv.names().size() == 4) {
        return {"directions", [](const Path& path, FileCheck& check) {
                    check.notes.push_back(std::to_string(read_directions_csv(path).size()) +
                                          " pairs of directions");
                }};
    }
    if (csv.find("theta_i")) return {"measured", check_measured};
    if (csv.find("r_mm") && csv.find("rd")) {
        return {"profile", [](const Path& path, FileCheck& check) {
                    check.notes.push_back(std::to_string(read_profile_csv(path).size()) + " radii");
                }};
    }
    if (csv.find("u_px")) {
        return {
            "points", [](const Path& path, FileCheck& check) {
                check.notes.push_back(std::to_string(read_picked_points(path).size()) + " points");
            }};
    }
    throw FileError(file,
                    "header",
                    "'" + csv.names().front().substr(0, 40) + "', ...",
                    "the columns of spectra, directions, measured reflectance, a radial profile or "
                    "picked points");
}

FileKind kind_of(const Path& file, const Path& patterns, const Progress& progress) {
    if (!is_there(file)) throw FileError(file, "", "no such file", "a file or folder");
    if (std::filesystem::is_directory(file)) return kind_of_folder(file, patterns, progress);
    if (!std::filesystem::is_regular_file(file)) {
        throw FileError(file, "", "a pipe or a device", "a file or folder");
    }
    const std::string suffix = suffix_of(file);
    if (suffix == ".json") {
        if (file.filename() == "calibration.json") {
            return {"calibration", [](const Path& path, FileCheck& check) {
                        check_calibration(path.parent_path(), check);
                    }};
        }
        return kind_of_json(file, progress);
    }
    if (suffix == ".csv") return kind_of_csv(file);
    if (is_measured_file(file)) return {"measured", check_measured};
    if (suffix == ".livery" || is_session_file(file)) return {"session", read_session};
    if (suffix == ".glb" || suffix == ".gltf" || suffix == ".ply" || suffix == ".obj") {
        return {"mesh", check_mesh};
    }
    if (suffix == ".exr") {
        const auto names = read_image(file).channel_names;
        if (names == std::vector<std::string>{"X", "Y"}) return {"map", read_map};
        return {"picture", read_picture};
    }
    if (has_picture_suffix(file)) return {"picture", read_picture};
    return {
        "unknown", [](const Path& path, FileCheck&) {
            throw FileError(
                path,
                "suffix",
                path.extension().string().empty() ? "none" : path.extension().string(),
                ".livery, .glb, .gltf, .ply, .obj, .json, .csv, .binary, .brdf, .exr, .hdr, .png, "
                ".tif, .jpg, RAW or a folder");
        }};
}

}  // namespace

FileCheck check_file(const std::filesystem::path& file,
                     const Progress& progress,
                     const std::filesystem::path& patterns) {
    FileCheck check;
    check.file = file;
    check.kind = "unknown";
    try {
        const FileKind kind = kind_of(file, patterns, progress);
        check.kind = kind.name;
        kind.read(file, check);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::bad_alloc&) {
        check.problems.emplace_back(
            "found no memory left for what it asks for, expected a smaller file");
    } catch (const std::exception& error) {
        check.problems.emplace_back(error.what());
    }
    return check;
}

}  // namespace livery
