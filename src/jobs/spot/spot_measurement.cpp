#include "jobs/spot/spot_measurement.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/spot/spot_of_light.h"
#include "capture/stand_folders.h"
#include "core/angles.h"
#include "core/error.h"
#include "core/paths.h"
#include "jobs/merged_captures.h"

namespace livery {

namespace {

constexpr const char* kSpotChannels[] = {"red", "green", "blue"};
constexpr double kLeastEta = 1.0, kMostEta = 4.0;
/// A lens is some degrees wide, and so is what a polished surface mirrors.
constexpr double kOffMirror_deg = 5.0;
constexpr double kMostIncidence_deg = 30.0, kMostView_deg = 60.0;
/// Of a camera that looks along the normal from afar: rays are parallel to 1e-3 degrees.
constexpr double kFarFocal_px = 1e8;
/// Seen aslant, light from below the surface lies beside where it would leave along the normal.
constexpr double kNotedShift = 0.2;
constexpr double kNotedPixels = 2.0;
constexpr double kNotedView_deg = 20.0;

/// The camera before the plane, and where the projector's light comes from.
struct SpotGeometry {
    View view;
    SamplePlane plane;
    std::optional<glm::dvec3> projector_mm;
    double incidence_rad = 0.0;  ///< without a place
};

SpotGeometry geometry_of(const SpotFolder& folder) {
    SpotGeometry geometry;
    if (folder.places) {
        const SpotPlaces& places = *folder.places;
        geometry.view = parse_camera(places.camera, places.camera_origin);
        geometry.plane = {places.point_mm, places.normal};
        const glm::dvec3 eye = centre_in_world(geometry.view) - places.point_mm;
        if (glm::dot(eye, places.normal) < 0.0) geometry.plane.normal = -places.normal;
        geometry.projector_mm = places.projector_mm;
        if (!(glm::dot(places.projector_mm - places.point_mm, geometry.plane.normal) > 0.0)) {
            throw FileError(folder.manifest,
                            "projector_mm",
                            "a place behind the plane, or in it",
                            "the projector on the camera's side");
        }
        return geometry;
    }
    const Photograph first = load_photograph(folder.white.lit.front());
    View& view = geometry.view;
    view.width = first.image.width;
    view.height = first.image.height;
    view.focal_px = glm::dvec2(kFarFocal_px);
    view.principal_px = 0.5 * glm::dvec2(view.width, view.height);
    const double away_mm = kFarFocal_px * folder.scale->mm_per_px;
    geometry.plane = {{0.0, 0.0, away_mm}, {0.0, 0.0, -1.0}};
    geometry.incidence_rad = folder.scale->incidence_deg / kDegreesPerRadian;
    return geometry;
}

void check_seen(const PlanePixels& pixels, const std::filesystem::path& manifest) {
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            if (pixels.at(x, y, 2) > 0.0f) continue;
            throw FileError(manifest,
                            "plane",
                            fmt::format("one that pixel {},{} does not see", x, y),
                            "a plane that fills the camera's picture");
        }
    }
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Angles at the spot.
void tell_angles(const SpotGeometry& geometry, const SpotOfLight& spot, SpotMeasurement& report) {
    const glm::dvec3& normal = geometry.plane.normal;
    const glm::dvec3 across = axis_across(geometry.plane);
    const glm::dvec3 place = geometry.plane.point_mm + spot.centre_mm.x * across +
                             spot.centre_mm.y * glm::cross(normal, across);
    const glm::dvec3 to_eye = glm::normalize(centre_in_world(geometry.view) - place);
    report.view_rad = angle_between(to_eye, normal);
    report.incidence_rad = report.off_mirror_rad = geometry.incidence_rad;
    if (!geometry.projector_mm) return;
    const glm::dvec3 to_light = glm::normalize(*geometry.projector_mm - place);
    report.incidence_rad = angle_between(to_light, normal);
    report.off_mirror_rad =
        angle_between(to_eye, 2.0 * glm::dot(to_light, normal) * normal - to_light);
}

void refuse_angles(const SpotMeasurement& report) {
    const auto degrees = [](double rad) { return kDegreesPerRadian * rad; };
    if (degrees(report.incidence_rad) > kMostIncidence_deg) {
        throw Refused(
            fmt::format("the projector's light meets the surface {:.1f} degrees from the "
                        "normal, and profiles are of light along it",
                        degrees(report.incidence_rad)),
            fmt::format("light the sample at {:.0f} degrees or less", kMostIncidence_deg));
    }
    if (degrees(report.view_rad) > kMostView_deg) {
        throw Refused(fmt::format("the camera looks {:.1f} degrees from the normal",
                                  degrees(report.view_rad)),
                      fmt::format("look from {:.0f} degrees or less", kMostView_deg));
    }
    if (degrees(report.off_mirror_rad) < kOffMirror_deg) {
        throw Refused(fmt::format("the camera stands {:.1f} degrees from where the surface mirrors "
                                  "the projector: the mirrored spot counts as light from within",
                                  degrees(report.off_mirror_rad)),
                      "move the camera or the projector until they are 20 degrees or more apart");
    }
}

ImageF load_added_light(const SpotPictures& pictures,
                        const View& camera,
                        const Progress& progress) {
    const auto load = [&](const Capture& one) { return load_photograph_of(one, camera); };
    const MergedCaptures lit = merge_captures(pictures.lit, load, progress.part(0.0, 0.5));
    const MergedCaptures black = merge_captures(pictures.black, load, progress.part(0.5, 1.0));
    for (const auto& [merged, what] :
         {std::pair{&lit, "with the spot"}, std::pair{&black, "of the projector's black"}}) {
        if (!merged->all_saturated()) continue;
        throw Refused(fmt::format("every pixel is saturated in every photograph {}", what),
                      "add photographs with a shorter exposure");
    }
    return added_light(lit.picture, black.picture);
}

std::filesystem::path file_of(const std::filesystem::path& out, const char* channel) {
    return out.parent_path() / (out.stem().string() + "-" + channel + ".csv");
}

/// A name as a shell takes it for one word.
std::string shell_word(const std::filesystem::path& name) {
    const std::string text = name.string();
    const bool plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '/' || c == '.' || c == '-' || c == '_';
    });
    if (plain) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

std::vector<std::string> comments_of(const SpotMeasurement& report, const MeasuredChannel& one) {
    const SpotProfile& profile = one.profile;
    return {
        fmt::format("R_d around a spot of light, the camera's {}: per mm^2 and unit power that "
                    "enters; rd_se is its standard error (livery measure profile).",
                    one.channel),
        fmt::format("Half of the spot's power lies within a diameter of {:.4g} mm. Light {:.1f} "
                    "degrees from the normal, seen from {:.1f} degrees.",
                    profile.spot_mm,
                    kDegreesPerRadian * report.incidence_rad,
                    kDegreesPerRadian * report.view_rad),
        fmt::format("Within the last ring {:.1f}% of what enters comes back, half of it within "
                    "{:.4g} mm.",
                    100.0 * profile.total_reflectance,
                    profile.half_energy_radius_mm),
        "Next: " + one.fit_command};
}

std::string csv_of(const SpotMeasurement& report, const MeasuredChannel& one) {
    std::string text;
    for (const std::string& comment : comments_of(report, one)) text += "# " + comment + "\n";
    text += "r_mm,rd,rd_se,pixels\n";
    for (std::size_t k = 0; k < one.profile.samples.size(); ++k) {
        text += fmt::format("{:.6g},{:.6g},{:.3g},{}\n",
                            one.profile.samples[k].r_mm,
                            one.profile.samples[k].rd,
                            one.profile.standard_errors[k],
                            one.profile.pixels[k]);
    }
    return text;
}

std::string fit_command(std::span<const MeasuredChannel> channels,
                        double eta,
                        const std::filesystem::path& material) {
    std::string profiles, spots;
    for (const MeasuredChannel& one : channels) {
        const char* comma = profiles.empty() ? "" : ",";
        profiles += comma + shell_word(one.file);
        spots += fmt::format("{}{:.4g}", comma, one.profile.spot_mm);
    }
    return fmt::format("livery fit bssrdf --profile {} --eta {} --spot-mm {} --out {}",
                       profiles,
                       eta,
                       spots,
                       shell_word(material));
}

MeasuredChannel measured_channel(const PlanePixels& pixels,
                                 const ImageF& sample,
                                 const SpotOfLight& spot,
                                 int channel,
                                 const SpotOptics& optics,
                                 const SpotMeasurementRequest& request) {
    MeasuredChannel measured;
    measured.channel = kSpotChannels[channel];
    try {
        measured.profile = spot_profile(pixels, sample, spot, channel, optics);
    } catch (const Refused& refused) {
        throw Refused(measured.channel + ": " + refused.why(), refused.fix());
    }
    measured.file = file_of(request.out, kSpotChannels[channel]);
    measured.fit_command =
        fit_command({&measured, 1},
                    request.eta,
                    std::filesystem::path(measured.file).replace_extension(".json"));
    return measured;
}

void tell_doubts(const SpotOfLight& spot, SpotMeasurement& report) {
    double widest_mm = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        widest_mm = std::max(widest_mm, spot.diameter_mm[c]);
        if (spot.power[c] > 0.0) continue;
        report.notes.push_back(fmt::format("the spot has no {} light: no profile of it was written",
                                           kSpotChannels[c]));
    }
    if (widest_mm < kNotedPixels * report.pixel_mm) {
        report.notes.push_back(
            fmt::format("the spot is {:.1f} pixels wide: its width is the "
                        "camera's as much as its own",
                        widest_mm / report.pixel_mm));
    }
    const double best_deg = kDegreesPerRadian * report.best_view_rad;
    const double view_deg = kDegreesPerRadian * report.view_rad;
    if (std::abs(view_deg - best_deg) > kNotedView_deg) {
        report.notes.push_back(
            fmt::format("seen from {:.0f} degrees off the normal, where light from deep down is "
                        "some percent stronger or weaker than in the mean; best is {:.0f}",
                        view_deg,
                        best_deg));
    }
    double spread_mm = widest_mm;
    for (const MeasuredChannel& one : report.channels) {
        spread_mm = std::max(spread_mm, kNotedShift * one.profile.half_energy_radius_mm);
    }
    if (report.shift_mm > spread_mm) {
        report.notes.push_back(
            fmt::format("the sample's light is centred {:.3g} mm beside the spot on white: the two "
                        "surfaces are not in one plane, or something moved",
                        report.shift_mm));
    }
}

void check_spot_request(const SpotMeasurementRequest& request) {
    if (request.out.extension() != ".csv") {
        throw std::invalid_argument(fmt::format(
            "--out: found \"{}\", expected a name that ends in .csv", request.out.string()));
    }
    if (!(request.eta >= kLeastEta && request.eta <= kMostEta)) {
        throw std::invalid_argument(
            fmt::format("--eta: found {}, expected {} to {}", request.eta, kLeastEta, kMostEta));
    }
}

}  // namespace

SpotMeasurement measure_profile(const SpotMeasurementRequest& request, const Progress& progress) {
    check_spot_request(request);
    const SpotFolder folder = read_spot_folder(request.captures);
    const SpotGeometry geometry = geometry_of(folder);
    SpotMeasurement report;
    report.photographs = photographs_of(folder).size();

    const ImageF white = load_added_light(folder.white, geometry.view, progress.part(0.0, 0.4));
    const PlanePixels pixels = plane_pixels(geometry.view, geometry.plane);
    check_seen(pixels, folder.manifest);
    progress.update(0.4, "finding the spot");
    const SpotOfLight spot = spot_of_light(pixels, white);
    report.reach_mm = spot.reach_mm;
    report.pixel_mm = spot.pixel_mm;
    tell_angles(geometry, spot, report);
    report.best_view_rad = mean_view_rad(request.eta);
    refuse_angles(report);

    const ImageF sample = load_added_light(folder.sample, geometry.view, progress.part(0.5, 0.9));
    progress.update(0.9, "measuring rings");
    report.shift_mm = glm::distance(centre_of_light(pixels, sample, spot.centre_mm, spot.radius_mm),
                                    spot.centre_mm);
    const SpotOptics optics{request.eta, std::cos(report.incidence_rad), folder.white_reflectance};
    for (int c = 0; c < 3; ++c) {
        if (!(spot.power[static_cast<std::size_t>(c)] > 0.0)) continue;
        report.channels.push_back(measured_channel(pixels, sample, spot, c, optics, request));
    }
    if (report.channels.size() == 3) {
        report.fit_command =
            fit_command(report.channels,
                        request.eta,
                        std::filesystem::path(request.out).replace_extension(".json"));
    }
    tell_doubts(spot, report);
    progress.check_stop();
    for (const MeasuredChannel& one : report.channels) {
        write_text_file(one.file, csv_of(report, one));
    }
    return report;
}

}  // namespace livery
