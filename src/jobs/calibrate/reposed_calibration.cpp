#include "jobs/calibrate/reposed_calibration.h"

#include <chrono>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/drift.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/time.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/carried_colours.h"
#include "scene/mockup_mask.h"
#include "scene/mockup_pose.h"
#include "tracing/tracer.h"

namespace livery {

namespace {

const RoomGeometry& room_of(const CalibrationOrigin& origin) {
    if (!origin.room)
        throw Refused("the calibration does not say where its camera stands",
                      "calibrate with livery capture or in the window, with the data sheets' "
                      "figures");
    return *origin.room;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double mean_light(const Photograph& photograph) {
    double sum = 0.0;
    for (const float value : photograph.image.values)
        sum += linear_from_file_units(photograph, static_cast<double>(value));
    return sum / static_cast<double>(photograph.image.values.size());
}

/// One of the two pictures, photographed.
Photograph seen_stripes(const BenchPorts& ports,
                        const StripeCode& code,
                        bool inverse,
                        const CalibrationOrigin& origin) {
    const std::string role = stripe_role(inverse);
    if (ports.turn_to) {
        ports.turn_to(role);
        Photograph photograph = ports.photograph(0.0);
        photograph.name = role;
        return photograph;
    }
    const double exposure_s = origin.ends ? origin.ends->exposure_s : 0.0;
    if (ports.announce) ports.announce(role);
    ports.show(stripe_picture(code, inverse));
    Photograph photograph = ports.photograph(exposure_s);
    for (int waited = 0; origin.ends && waited < origin.ends->late; ++waited)
        photograph = ports.photograph(exposure_s);
    // A projector that has just been found shows nothing yet: half of white's light is awaited, and
    // one photograph more, since half of the picture may have come.
    constexpr int kPatience = 8;
    const auto shows = [&] {
        const DriftReference& ends = *origin.ends;
        double black = 0.0;
        for (const float value : ends.black.values) black += static_cast<double>(value);
        black /= static_cast<double>(std::max<std::size_t>(ends.black.values.size(), 1));
        const double white = (ends.light.x + ends.light.y + ends.light.z) / 3.0;
        return mean_light(photograph) - black > 0.25 * white;
    };
    bool awaited = false;
    for (int waited = 0; origin.ends && waited < kPatience && !shows(); ++waited) {
        photograph = ports.photograph(exposure_s);
        awaited = true;
    }
    return awaited ? ports.photograph(exposure_s) : photograph;
}

RoomGeometry room_now(RoomGeometry room, const Repose& found, const std::string& made_of) {
    room.projector = found.projector;
    room.camera = found.camera;
    room.median_px = found.median_px;
    // Of a normal distribution of that median, across the stripes alone.
    room.rms_px = 1.4826 * found.median_px;
    room.rms_mm =
        room.rms_px * glm::length(centre_in_world(found.projector)) / found.projector.focal_px.x;
    room.correspondences = found.on_product;
    room.inliers =
        static_cast<std::size_t>(found.agree_share * static_cast<double>(found.on_product));
    room.warnings = found.warnings;
    room.made_of = made_of;
    return room;
}

}  // namespace

StripeCode stripes_for(const CalibrationOrigin& origin, const Product& product) {
    const RoomGeometry& room = room_of(origin);
    if (!origin.shape.empty() && origin.shape != shape_hash(product.mesh))
        throw Refused(what_changed(origin, product, "").at(0),
                      "find where everything stands with the geometry step again");
    const Bounds box = bounds_of(product.mesh);
    return stripe_code(room.projector.width,
                       room.projector.height,
                       wants_rows(room.projector, room.camera, 0.5 * (box.low + box.high)));
}

ReposedCalibration repose_through_ports(const BenchPorts& ports,
                                        const ColourCalibration& calibration,
                                        const CalibrationOrigin& origin,
                                        const Product& product,
                                        const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    ReposeInput input;
    input.code = stripes_for(origin, product);
    const RoomGeometry& room = room_of(origin);
    input.projector = room.projector;
    input.camera = room.camera;
    input.free_turns = room.free_turns;
    input.around = origin.around;
    progress.update(0.0, "photographing stripes");
    input.stripes = seen_stripes(ports, input.code, false, origin);
    progress.update(0.1, "photographing the stripes' inverse");
    input.inverse = seen_stripes(ports, input.code, true, origin);
    double capture_seconds = seconds_since(start);

    const auto solving = std::chrono::steady_clock::now();
    ReposedCalibration reposed;
    const Tracer tracer(product.mesh);
    try {
        reposed.found = find_mockup_again(product.mesh, tracer, input, progress.part(0.15, 0.5));
    } catch (...) {
        if (!ports.turn_to) ports.show(Image8(input.code.width, input.code.height, 3));
        throw;
    }
    const Repose& found = reposed.found;
    reposed.calibration = carry_colours(calibration,
                                        product.mesh,
                                        {room.projector, room.camera},
                                        {found.projector, found.camera},
                                        progress.part(0.5, 0.9));
    reposed.origin = origin;
    reposed.origin.reposed_from = calibration.id;
    Hasher hasher;
    hasher.add(room.made_of);
    hasher.add(reposed.calibration.id);
    reposed.origin.room = room_now(room, found, hasher.hex());
    reposed.origin.solve_seconds = seconds_since(solving);

    reposed.origin.ends.reset();
    if (!ports.turn_to && origin.ends) {
        const auto again = std::chrono::steady_clock::now();
        reposed.origin.ends = photograph_ends(ports,
                                              *origin.ends,
                                              mockup_mask(product.mesh, found.projector),
                                              progress.part(0.9, 1.0));
        ports.show(Image8(input.code.width, input.code.height, 3));
        capture_seconds += seconds_since(again);
    }
    reposed.origin.capture_seconds = capture_seconds;
    return reposed;
}

void write_reposed(const std::filesystem::path& folder, const ReposedCalibration& reposed) {
    write_setup(folder, reposed.calibration, reposed.found.projector);
    write_origin(folder, reposed.origin);
}

std::vector<GradedFigure> grade_figures(const Repose& found) {
    std::vector<GradedFigure> figures;
    figures.push_back({"Mock-up moved by",
                       fmt::format("{:.1f} mm, {:.2f} degrees",
                                   found.moved_mm,
                                   found.turned_rad * 180.0 / std::numbers::pi),
                       "",
                       "How far its middle is from where it was, and how far it is turned.",
                       "",
                       Grade::good});
    figures.push_back({"Mock-up in its place",
                       fmt::format("{:.2f} px", found.median_px),
                       "projector pixels, median; good under 0.25, usable under 0.5",
                       "How far the stripes on it lie from where mesh and pose have them.",
                       "Photograph the geometry again where that is not enough.",
                       grade_of(found.median_px, 0.25, 0.5)});
    figures.push_back(graded_share("Stripes that agree",
                                   found.agree_share,
                                   0.9,
                                   0.6,
                                   "Of the borders of stripes seen on the mock-up, those that lie "
                                   "where its mesh has them.",
                                   "See that nothing stands before the mock-up or lies on it."));
    return figures;
}

std::string write_nudged(const std::filesystem::path& from,
                         const std::filesystem::path& to,
                         const View& projector,
                         const Bounds& mockup) {
    const auto before = projector_view_of(from);
    if (!before) {
        throw FileError(
            from / "projector.json", "", "nothing", "the projector's camera file: nothing to move");
    }
    View elsewhere = *before;
    elsewhere.view_from_world = projector.view_from_world;
    check_argument(elsewhere == projector, "a nudge moves the mock-up, not the projector's lens");
    const std::string moved = in_words(motion_between(*before, projector, mockup));
    ColourCalibration calibration = read_calibration(from);
    calibration.made_with += "; moved by hand: " + moved;
    calibration.created = utc_now();
    seal(calibration);
    auto origin = read_origin(from);
    write_setup(to, calibration, projector);
    if (!origin) return calibration.id;
    if (origin->room) {
        // camera from product = camera from projector * projector from product
        View& camera = origin->room->camera;
        camera.view_from_world =
            camera.view_from_world * inverse(before->view_from_world) * projector.view_from_world;
        origin->room->projector = projector;
        origin->room->warnings.push_back("moved by hand after it was found: " + moved);
    }
    write_origin(to, *origin);
    return calibration.id;
}

}  // namespace livery
