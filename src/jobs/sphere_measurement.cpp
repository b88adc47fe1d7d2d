#include "jobs/sphere_measurement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "appearance/measured/measured_samples.h"
#include "calibration/settings.h"
#include "capture/stand_folders.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/worst_error.h"
#include "jobs/merged_captures.h"

namespace livery {

namespace {

constexpr double kMostAcross_px = 800;  ///< a larger sphere's pixels are averaged in blocks
constexpr double kSameLamp_mm = 0.01;
constexpr double kMatteRms = 0.1, kNotedResidual = 0.1, kNotedCorrection = 0.02;

/// Of the lamp at that place; made when there is none yet.
LitSphere& of_lamp(std::vector<LitSphere>& lit, const glm::dvec3& light_mm) {
    for (LitSphere& one : lit) {
        if (glm::distance(one.light_mm, light_mm) < kSameLamp_mm) return one;
    }
    lit.push_back({{}, light_mm});
    return lit.back();
}

std::vector<LitSphere> load_lit(const SphereFolder& folder,
                                const View& camera,
                                const SphereWindow& window,
                                const Progress& progress) {
    std::vector<LitSphere> lit;
    double done = 0.0;
    for (const SphereCapture& capture : folder.captures) {
        progress.update(done / static_cast<double>(folder.captures.size()),
                        "reading " + capture.photograph.file.filename().string());
        done += 1.0;
        add(windowed(load_photograph_of(capture.photograph, camera), window.pixels),
            of_lamp(lit, *capture.light_position_mm).picture);
    }
    return lit;
}

struct WhiteLamp {
    glm::dvec3 light_mm;
    LampResponse response;
};

/// Under the lamp that makes a matte sphere look most like the photograph.
WhiteLamp recognised(const SphereWindow& window,
                     const Sphere& sphere,
                     const MergedPhotographs& picture,
                     const glm::dvec3& reflectance,
                     std::span<const LitSphere> lamps) {
    std::optional<WhiteLamp> best;
    std::optional<Refused> refusal;
    for (const LitSphere& lamp : lamps) {
        try {
            const LitSphere white{picture, lamp.light_mm};
            const LampResponse response = lamp_response(window.view, sphere, white, reflectance);
            if (!best || response.rms < best->response.rms) best = {lamp.light_mm, response};
        } catch (const Refused& one) {
            refusal = one;
        }
    }
    if (!best) throw Refused(*refusal);
    return *best;
}

std::vector<WhiteLamp> white_lamps(const SphereFolder& folder,
                                   const View& camera,
                                   const Sphere& painted,
                                   std::span<const LitSphere> lamps) {
    const Sphere sphere = folder.white_sphere ? Sphere{folder.white_sphere->centre_mm,
                                                       folder.white_sphere->diameter_mm}
                                              : painted;
    const SphereWindow window = window_around(camera, sphere, kMostAcross_px, folder.manifest);
    std::vector<LitSphere> known;
    std::vector<WhiteLamp> result;
    for (const SphereCapture& capture : folder.white) {
        if (capture.light_position_mm) {
            add(windowed(load_photograph_of(capture.photograph, camera), window.pixels),
                of_lamp(known, *capture.light_position_mm).picture);
            continue;
        }
        MergedPhotographs picture;
        add(windowed(load_photograph_of(capture.photograph, camera), window.pixels), picture);
        result.push_back(recognised(window, sphere, picture, folder.white_reflectance, lamps));
    }
    for (const LitSphere& white : known) {
        result.push_back(
            {white.light_mm, lamp_response(window.view, sphere, white, folder.white_reflectance)});
    }
    return result;
}

/// Each lamp's own, where the white sphere was photographed under it; else their mean.
std::vector<LampResponse> responses_of(std::span<const LitSphere> lit,
                                       std::span<const WhiteLamp> whites,
                                       SphereMeasurement& report) {
    LampResponse mean;
    for (const WhiteLamp& white : whites) {
        mean.units += white.response.units / static_cast<double>(whites.size());
        mean.rms = worse_of(mean.rms, white.response.rms);
    }
    report.white_rms = mean.rms;
    for (const WhiteLamp& white : whites) {
        const glm::dvec3 off = glm::abs(white.response.units / mean.units - 1.0);
        report.lamp_spread = worse_of({report.lamp_spread, off.x, off.y, off.z});
    }
    std::vector<LampResponse> responses(lit.size(), mean);
    for (std::size_t k = 0; k < lit.size(); ++k) {
        for (const WhiteLamp& white : whites) {
            if (glm::distance(white.light_mm, lit[k].light_mm) < kSameLamp_mm) {
                responses[k] = white.response;
            }
        }
    }
    return responses;
}

/// Rec.709 of the camera's colours, on whose scale a perfect white is 1, 1, 1.
glm::dmat3 rec709_from_balanced(const std::filesystem::path& file, SphereMeasurement& report) {
    const CameraToXyz camera = camera_matrix(file);
    report.camera_colours = camera.origin;
    const glm::dvec3 white = glm::inverse(camera.xyz_from_camera) * d65_xyz();
    if (!(white.x > 0.0 && white.y > 0.0 && white.z > 0.0)) {
        throw FileError(file,
                        "matrix",
                        fmt::format("one by which the camera sees white as {:.3g}, {:.3g}, {:.3g}",
                                    white.x,
                                    white.y,
                                    white.z),
                        "a matrix from linear camera RGB to XYZ");
    }
    return rec709_from_xyz() * camera.xyz_from_camera *
           glm::dmat3(white.x, 0.0, 0.0, 0.0, white.y, 0.0, 0.0, 0.0, white.z);
}

void tell_doubts(SphereMeasurement& report) {
    const Sphere& was = report.manifest_sphere;
    const Sphere& is = report.outline.sphere;
    const double moved = glm::distance(was.centre_mm, is.centre_mm);
    const double grown = std::abs(is.diameter_mm - was.diameter_mm);
    if (std::max(moved, grown) > kNotedCorrection * was.diameter_mm) {
        report.notes.push_back(fmt::format(
            "the outline lies {:.2f} mm from the manifest's sphere and is {:.2f} mm across, not "
            "{:.2f}: the outline's was taken",
            moved,
            is.diameter_mm,
            was.diameter_mm));
    }
    if (report.white_rms > kMatteRms) {
        report.notes.push_back(
            fmt::format("the white sphere differs from a matte one by {:.0f}%: check its "
                        "light_position_mm, its "
                        "place and its paint",
                        100.0 * report.white_rms));
    }
    if (report.reflectance.residual_median > kNotedResidual) {
        report.notes.push_back(fmt::format(
            "several looks at the same directions differ by {:.0f}% (median): check the light "
            "positions, the camera and that the lamp shines evenly",
            100.0 * report.reflectance.residual_median));
    }
}

}  // namespace

SphereMeasurement measure_sphere(const SphereMeasurementRequest& request,
                                 const Progress& progress) {
    if (request.out.extension() != ".csv") {
        throw std::invalid_argument(fmt::format(
            "--out: found \"{}\", expected a name that ends in .csv", request.out.string()));
    }
    const SphereFolder folder = read_sphere_folder(request.captures);
    const View camera = parse_camera(folder.camera, folder.camera_origin);
    SphereMeasurement report;
    const glm::dmat3 rec709_from_camera = rec709_from_balanced(
        request.camera_to_xyz.empty() ? folder.camera_to_xyz : request.camera_to_xyz, report);

    const Sphere given{folder.sphere.centre_mm, folder.sphere.diameter_mm};
    const SphereWindow window = window_around(camera, given, kMostAcross_px, folder.manifest);
    const std::vector<LitSphere> lit = load_lit(folder, camera, window, progress);
    check_lit(window.view, given, lit);
    progress.update(0.0, "finding the outline");
    report.manifest_sphere = given;
    report.outline = fit_outline(window.view, given, lit);
    const Sphere& sphere = report.outline.sphere;
    const auto whites = white_lamps(folder, camera, sphere, lit);
    const auto responses = responses_of(lit, whites, report);
    report.reflectance = sphere_reflectance(window.view, sphere, lit, responses, {}, progress);

    SphereReflectance& measured = report.reflectance;
    for (glm::dvec3& value : measured.values) value = rec709_from_camera * value;
    report.photographs = folder.captures.size();
    report.white_photographs = folder.white.size();
    report.lamps = lit.size();
    report.samples = measured.pairs.size();
    tell_doubts(report);
    const std::vector<std::string> comments = {
        fmt::format("Reflectance of a sphere of {:.2f} mm, from {} photographs under {} lamps "
                    "(livery measure brdf).",
                    sphere.diameter_mm,
                    report.photographs,
                    report.lamps),
        fmt::format("Seen: {:.1f}% of the pairs of directions up to 80 degrees. Several looks at "
                    "the same differ by {:.1f}% (median), {:.1f}% (root mean square).",
                    100.0 * measured.coverage,
                    100.0 * measured.residual_median,
                    100.0 * measured.residual),
        fmt::format("Linear signed Rec.709 under D65, per steradian, without the cosine; the "
                    "camera's colours: {}.",
                    report.camera_colours)};
    progress.check_stop();
    write_text_file(request.out, measured_csv(measured.pairs, measured.values, comments));
    return report;
}

}  // namespace livery
