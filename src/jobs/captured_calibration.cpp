#include "jobs/captured_calibration.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/captures/captures.h"
#include "calibration/captures/identify.h"
#include "calibration/correspondence/patterns.h"
#include "capture/patterns_folder.h"
#include "core/error.h"
#include "core/image_io.h"

namespace livery {

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
                                    const CalibrationSettings& settings,
                                    std::vector<std::string>& warnings) {
    const int width = folder.projector_width, height = folder.projector_height;
    std::vector<Pattern> patterns =
        colour_patterns(width, height, settings.dark_drive, settings.bright_drive);
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
CalibrationPhotographs of_its_colours(CalibrationPhotographs taken) {
    std::error_code error;
    const auto colours = taken.folder / "colour";
    if (std::filesystem::exists(taken.folder / "manifest.json", error) ||
        !std::filesystem::exists(colours / "manifest.json", error))
        return taken;
    taken.folder = colours;
    if (!taken.map && std::filesystem::exists(colours / "map.exr", error))
        taken.map = colours / "map.exr";
    return taken;
}

}  // namespace

ColourCalibration calibrate_from_folder(const CalibrationPhotographs& asked,
                                        CalibrationSettings settings,
                                        const Progress& progress) {
    const CalibrationPhotographs taken = of_its_colours(asked);
    const CapturesFolder folder = read_shown_captures(
        taken.folder, PhotographUse::light, taken.patterns_manifest, settings.warnings, progress);
    std::vector<std::string> geometry;
    for (const Capture& capture : folder.captures) {
        if (is_geometry_role(capture.role)) geometry.push_back(capture.role);
    }
    if (geometry.size() == folder.captures.size()) {
        throw FileError(taken.folder,
                        "captures",
                        std::to_string(geometry.size()) +
                            (std::any_of(geometry.begin(), geometry.end(), is_fringe_role)
                                 ? " photographs of Gray code and fringes alone"
                                 : " Gray code photographs alone"),
                        "photographs of the colour patterns too (livery patterns --kind all or "
                        "color), with their roles in manifest.json");
    }
    if (!taken.map && geometry.empty()) {
        throw FileError(taken.folder,
                        "captures",
                        "no Gray code photographs",
                        "Gray code photographs, or --map FILE.exr");
    }

    settings.width = folder.projector_width;
    settings.height = folder.projector_height;
    settings.shots = 1;
    settings.made_with = "photographs in " + taken.folder.string();
    settings.dark_drive = uniform_drive(folder, "dark-gray").value_or(settings.dark_drive);
    settings.bright_drive = uniform_drive(folder, "bright-gray").value_or(settings.bright_drive);
    if (taken.map) {
        settings.map = read_map(*taken.map, settings.width, settings.height);
    } else {
        check_gray_code(folder.folder, geometry, settings.width, settings.height);
        if (check_fringes(folder.folder, geometry)) settings.places = PlaceCode::gray_and_phase;
    }
    settings.patterns = patterns_shown(folder, settings, settings.warnings);
    return calibrate_through_ports(ports_of(folder), std::move(settings), progress).calibration;
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

namespace {

constexpr std::size_t kMostNamedPhotographs = 4;

Glimpse glimpse_at(const Capture& capture) { return glimpse_of(load_photograph(capture)); }

/// White and black, and the first and the last pair of stripes: enough to see that a row of files
/// is shifted or turned round.
std::vector<std::size_t> telling_places(const std::vector<Capture>& captures) {
    std::vector<std::size_t> places;
    const auto add = [&](std::size_t place) {
        if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
    };
    std::size_t last_inverse = 0;
    for (std::size_t k = 0; k < captures.size(); ++k) {
        const std::string& role = captures[k].role;
        if (role == "white" || role == "black") add(k);
        if (!role.ends_with("-inverse") || k == 0) continue;
        if (last_inverse == 0) {
            add(k - 1);
            add(k);
        }
        last_inverse = k;
    }
    if (last_inverse > 0) {
        add(last_inverse - 1);
        add(last_inverse);
    }
    std::sort(places.begin(), places.end());
    return places;
}

struct Looked {
    IdentifiedPhotographs found;
    bool alike = true;  ///< in size
};
Looked look_at(const std::vector<Capture>& captures,
               const std::vector<std::size_t>& photographs,
               const std::vector<std::string>& roles,
               const Progress& progress) {
    std::vector<Glimpse> glimpses;
    for (const std::size_t place : photographs) {
        progress.check_stop();
        progress.update(0.0, "looking at " + captures[place].file.filename().string());
        glimpses.push_back(glimpse_at(captures[place]));
        if (glimpses.back().values.size() != glimpses.front().values.size()) return {{}, false};
    }
    return {identify(glimpses, roles), true};
}

/// The photograph of one capture for the picture of another.
Capture with_role_of(Capture photograph, const Capture& picture) {
    photograph.role = picture.role;
    photograph.pattern = picture.pattern;
    photograph.drive = picture.drive;
    return photograph;
}

}  // namespace

CapturesFolder read_shown_captures(const std::filesystem::path& path,
                                   PhotographUse use,
                                   const std::filesystem::path& patterns_manifest,
                                   std::vector<std::string>& warnings,
                                   const Progress& progress) {
    CapturesFolder folder = read_captures_folder(path, use, patterns_manifest);
    std::error_code error;
    if (std::filesystem::exists(path / "manifest.json", error)) return folder;
    const std::vector<Capture>& captures = folder.captures;
    const auto roles_at = [&](const std::vector<std::size_t>& places) {
        std::vector<std::string> roles;
        for (const std::size_t place : places) roles.push_back(captures[place].role);
        return roles;
    };
    const std::vector<std::size_t> some = telling_places(captures);
    const Looked first = look_at(captures, some, roles_at(some), progress);
    const bool holds =
        first.found.complete() && first.found.odd.empty() && first.found.out_of_order.empty();
    if (holds || !first.alike) return folder;

    std::vector<std::string> names;
    for (const Capture& capture : captures) names.push_back(capture.file.filename().string());
    const std::vector<std::size_t> order = order_of_names(names);
    std::vector<std::size_t> all(captures.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const Looked looked = look_at(captures, order, roles_at(all), progress);
    if (!looked.alike) return folder;
    if (!looked.found.complete()) {
        for (std::size_t k = 0; k < std::min(looked.found.odd.size(), kMostNamedPhotographs); ++k)
            warnings.push_back(fmt::format(
                "{} {}", names[order[looked.found.odd[k].photograph]], looked.found.odd[k].why));
        return folder;
    }
    CapturesFolder shown = folder;
    shown.captures.clear();
    std::vector<std::size_t> role_of(captures.size(), captures.size());
    for (std::size_t role = 0; role < captures.size(); ++role)
        role_of[*looked.found.photograph_of_role[role]] = role;
    std::string moved;
    std::size_t count = 0;
    for (std::size_t taken = 0; taken < order.size(); ++taken) {
        const std::size_t role = role_of[taken];
        shown.captures.push_back(with_role_of(captures[order[taken]], captures[role]));
        if (role == order[taken]) continue;
        if (++count <= kMostNamedPhotographs)
            moved += fmt::format(
                "{}{} shows {}", count == 1 ? "" : ", ", names[order[taken]], captures[role].role);
    }
    if (count > 0)
        warnings.push_back(
            fmt::format("{} photographs are in another order than the pictures and were "
                        "recognised by what they show: {}{}",
                        count,
                        moved,
                        count > kMostNamedPhotographs ? ", …" : ""));
    return shown;
}

}  // namespace livery
