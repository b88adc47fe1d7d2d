// livery calibrate register, livery calibrate scan

#include <memory>

#include <fmt/format.h>

#include "cli/capture_options.h"
#include "cli/command.h"
#include "core/error.h"
#include "jobs/registration.h"
#include "scene/library.h"

namespace livery {

namespace {

std::vector<std::filesystem::path> paths_of(const std::vector<std::string>& names) {
    return {names.begin(), names.end()};
}

Json numbers_of(const auto& list) {
    Json numbers = Json::array();
    for (const double number : list) numbers.push_back(number);
    return numbers;
}

Json figures_of(const RegisteredMockup& mockup) {
    const MockupPose& pose = mockup.pose;
    Json figures = {{"rms_px", pose.rms_px},
                    {"rms_mm", pose.rms_mm},
                    {"inliers", pose.inliers},
                    {"method", pose.method},
                    {"mesh_scale", pose.mesh_scale},
                    {"rotation", json_from(pose.camera_from_product.rotation)},
                    {"translation_mm", json_from(pose.camera_from_product.translation)},
                    {"covariance", numbers_of(pose.covariance)},
                    {"refused", Json::array()},
                    {"warnings", pose.warnings}};
    if (mockup.by_points) {
        Json left_out = Json::array();
        if (mockup.by_points->bad)
            left_out.push_back({{"point", mockup.points[*mockup.by_points->bad].name},
                                {"off_px", mockup.by_points->bad_px}});
        figures["points"] = {{"view", mockup.picked_in},
                             {"held_px", mockup.held_px},
                             {"rms_px", mockup.by_points->rms_px},
                             {"left_out", left_out}};
    }
    if (mockup.by_scan) {
        const Registration& found = *mockup.by_scan;
        figures["median_px"] = found.refined.median_px;
        figures["correspondences"] = found.refined.correspondences;
        figures["agreement"] = found.evidence.agreement();
        figures["free_turns"] = found.free.count;
        Json motions = Json::array();
        for (const Rigid3& motion : found.equal_motions)
            motions.push_back({{"rotation", json_from(motion.rotation)},
                               {"translation_mm", json_from(motion.translation)}});
        figures["equal_motions"] = motions;
        Json lens = Json::array();
        for (const Refined& one : found.refined.lens)
            lens.push_back({{"name", one.name},
                            {"change", one.change},
                            {"sigma", one.sigma},
                            {"prior", one.prior},
                            {"identified", one.is_identified()}});
        figures["lens"] = lens;
    }
    return figures;
}

std::string text_of(const RegisteredMockup& mockup, const std::string& out) {
    const MockupPose& pose = mockup.pose;
    std::string text;
    if (mockup.by_scan)
        text = fmt::format(
            "registered by the scan: {:.2f} px, {:.3f} mm (root mean square), {} of {} pixels, "
            "{:.0f}% of what would be seen\n",
            pose.rms_px,
            pose.rms_mm,
            pose.inliers,
            mockup.by_scan->refined.correspondences,
            100.0 * mockup.by_scan->evidence.agreement());
    else
        text = fmt::format(
            "registered by {} points in the {}'s picture: {:.2f} px, {:.3f} mm (root mean square); "
            "held to {:.1f} px (one standard deviation, at worst, in the projector's picture)\n",
            pose.inliers,
            mockup.picked_in,
            pose.rms_px,
            pose.rms_mm,
            mockup.held_px);
    if (mockup.by_scan)
        for (const Refined& one : mockup.by_scan->refined.lens)
            text += fmt::format("    {} {:+.5f} +- {:.5f}{}\n",
                                one.name,
                                one.change,
                                one.sigma,
                                one.is_identified() ? "" : ", known no better than before");
    for (const std::string& warning : pose.warnings) text += "warning: " + warning + "\n";
    return text + "wrote " + out + "\n";
}

Json json_of(const std::vector<RemovedPlane>& planes) {
    Json list = Json::array();
    for (const RemovedPlane& plane : planes)
        list.push_back(
            {{"points", plane.points}, {"behind", plane.behind}, {"rms_mm", plane.rms_mm}});
    return list;
}

std::string text_of(const RemovedPlanes& removed) {
    std::string text;
    for (std::size_t k = 0; k < removed.planes.size(); ++k) {
        const RemovedPlane& plane = removed.planes[k];
        text += fmt::format(
            "plane {} left out: {} of the projector's pixels on it ({:.2f} mm, root mean square), "
            "{} behind it\n",
            k + 1,
            plane.points,
            plane.rms_mm,
            plane.behind);
    }
    if (!removed.planes.empty())
        text += fmt::format("{} that are left lie close beside a plane\n", removed.beside);
    return text;
}

}  // namespace

Command calibrate_register_command() {
    struct Arguments {
        std::string mesh, unit, points, out, patterns, view = "either";
        std::vector<std::string> captures, calibration;
        bool scale_free = false, lens_fixed = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "calibrate register";
    command.summary = "mesh + scan or picked points -> pose of the mock-up";
    command.example =
        "livery calibrate register --mesh car --captures captures --calibration geometry --out "
        "registered";
    command.options = {
        {"--mesh", "FILE", "mesh or product of the mock-up", &arguments->mesh, true},
        unit_option(arguments->unit),
        {"--captures",
         "DIR...",
         "Gray code photographs, a folder a position of the camera",
         &arguments->captures},
        patterns_option(arguments->patterns),
        {"--points",
         "FILE",
         "picked points, CSV x_mm,y_mm,z_mm,u_px,v_px; with --captures a place to begin",
         &arguments->points},
        {"--view",
         "VIEW",
         "picture that the points are of: camera, projector or either (default: the one they fit)",
         &arguments->view,
         false,
         {"camera", "projector", "either"}},
        {"--calibration",
         "DIR...",
         "camera.json and projector.json, one folder for all captures or one for each",
         &arguments->calibration,
         true},
        {"--free-scale",
         "",
         "the mock-up may be another size than its mesh, by up to a tenth",
         &arguments->scale_free},
        {"--fixed-lens", "", "keep lenses and stereo pose as calibrated", &arguments->lens_fixed},
        {"--out", "DIR", "pose.json, camera.json, projector.json", &arguments->out, true},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        if (arguments->captures.empty() && arguments->points.empty())
            throw std::invalid_argument(
                "--captures, --points: found neither, expected one or both");
        RegistrationRequest request;
        request.product = find_product(arguments->mesh, parse_unit(arguments->unit));
        request.product_name = arguments->mesh;
        request.captures = paths_of(arguments->captures);
        request.patterns_manifest = arguments->patterns;
        request.points = arguments->points;
        request.calibrations = paths_of(arguments->calibration);
        request.pick_view = arguments->view == "camera"      ? PickView::camera
                            : arguments->view == "projector" ? PickView::projector
                                                             : PickView::either;
        request.scale_free = arguments->scale_free;
        request.lens_fixed = arguments->lens_fixed;
        Outcome outcome;
        try {
            const RegisteredMockup mockup = register_mockup(request, progress);
            write_registration(arguments->out, mockup);
            outcome.figures = figures_of(mockup);
            outcome.text = text_of(mockup, arguments->out);
        } catch (const Refused& refused) {
            outcome.figures = {{"rms_px", nullptr}, {"rms_mm", nullptr}, {"inliers", 0}};
            report_refusal(refused, outcome);
        }
        tell_notes(request.product->notes, outcome);
        return outcome;
    };
    return command;
}

Command calibrate_scan_command() {
    struct Arguments {
        std::string out, patterns;
        std::vector<std::string> captures, calibration;
        double spacing_mm = 0.3;
        int without_planes = 0;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "calibrate scan";
    command.summary = "Gray code photographs -> a mesh of the mock-up";
    command.example =
        "livery calibrate scan --captures captures --calibration geometry --out scanned";
    command.options = {
        {"--captures",
         "DIR...",
         "Gray code photographs, a folder a position of the camera",
         &arguments->captures,
         true},
        patterns_option(arguments->patterns),
        {"--calibration",
         "DIR...",
         "camera.json and projector.json, one folder for all captures or one for each",
         &arguments->calibration,
         true},
        {"--spacing-mm",
         "MM",
         "distance of neighbouring vertices (default 0.3; a projector pixel at least)",
         &arguments->spacing_mm},
        {"--without-planes",
         "N",
         "leave out so many planes (table, wall), the largest first, and what lies behind them; "
         "flat sides of the product are none (default 0)",
         &arguments->without_planes},
        {"--out",
         "DIR",
         "scan.ply, camera.json, projector.json; from fringes also direct.exr, global.exr",
         &arguments->out,
         true},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        if (!(arguments->spacing_mm > 0.0 && arguments->spacing_mm < 1000.0))
            throw std::invalid_argument(
                fmt::format("--spacing-mm: found {}, expected more than 0 and less than 1000",
                            arguments->spacing_mm));
        if (arguments->without_planes < 0 || arguments->without_planes > 10)
            throw std::invalid_argument(fmt::format("--without-planes: found {}, expected 0 to 10",
                                                    arguments->without_planes));
        Outcome outcome;
        try {
            const ScannedLight light = decode_light(paths_of(arguments->captures),
                                                    paths_of(arguments->calibration),
                                                    arguments->patterns,
                                                    progress);
            const ScanFiles scan =
                scan_product(light, arguments->spacing_mm, arguments->without_planes, progress);
            write_scan(arguments->out, scan);
            const bool separated = write_separated_light(arguments->out, light);
            const Bounds box = bounds_of(scan.surface);
            std::vector<std::string> warnings = light.warnings;
            for (const auto* more : {&scan.scan.warnings, &scan.removed.warnings})
                warnings.insert(warnings.end(), more->begin(), more->end());
            outcome.figures = {{"points", scan.surface.positions_mm.size()},
                               {"triangles", scan.surface.triangles.size()},
                               {"spacing_mm", scan.spacing_mm},
                               {"size_mm", json_from(box.high - box.low)},
                               {"known_fraction", scan.scan.known_fraction},
                               {"gap_px", scan.scan.gap_px},
                               {"planes", json_of(scan.removed.planes)},
                               {"beside_planes", scan.removed.beside},
                               {"separated_light", separated},
                               {"refused", Json::array()},
                               {"warnings", warnings}};
            outcome.text = fmt::format(
                "{} points, {} triangles, {:.2f} mm apart; the rays of camera and projector pass "
                "each other by {:.2f} px; wrote {}\n",
                scan.surface.positions_mm.size(),
                scan.surface.triangles.size(),
                scan.spacing_mm,
                scan.scan.gap_px,
                arguments->out);
            if (arguments->without_planes > 0) outcome.text += text_of(scan.removed);
            for (const std::string& warning : warnings)
                outcome.text += "warning: " + warning + "\n";
        } catch (const Refused& refused) {
            outcome.figures = {{"points", 0}, {"triangles", 0}};
            report_refusal(refused, outcome);
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
