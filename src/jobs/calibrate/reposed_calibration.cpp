#include "jobs/calibrate/reposed_calibration.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/drift.h"
#include "calibration/predict.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/statistics.h"
#include "core/time.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/captured_calibration.h"
#include "mesh/mesh.h"
#include "scene/colour_calibration.h"
#include "scene/mockup_mask.h"
#include "scene/mockup_pose.h"
#include "scene/view.h"
#include "tracing/tracer.h"

namespace livery {

namespace {

/// A projector and a camera with the product's frame for their world.
struct PairOfViews {
    View projector, camera;
};

/// What the middle of each projector pixel lights.
struct LitPlaces {
    std::vector<glm::vec3> places;  ///< NaN: nothing of the mesh
    std::vector<glm::vec3> normals;
    ImageF irradiance;  ///< projector_irradiance()
};

LitPlaces lit_places(const Mesh& mesh,
                     const Tracer& tracer,
                     const View& projector,
                     const Progress& progress) {
    const auto width = static_cast<std::size_t>(projector.width);
    LitPlaces lit;
    lit.places.assign(width * static_cast<std::size_t>(projector.height),
                      glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    lit.normals.resize(lit.places.size());
    const glm::vec3 lamp(centre_in_world(projector));
    parallel_for(
        static_cast<std::size_t>(projector.height), 8, [&](std::size_t begin, std::size_t end) {
            std::vector<glm::vec3> directions(width);
            std::vector<Hit> hits(width);
            for (std::size_t y = begin; y < end; ++y) {
                for (std::size_t x = 0; x < width; ++x)
                    directions[x] = glm::vec3(
                        ray_through(projector,
                                    {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5})
                            .direction);
                tracer.closest_from(lamp, directions, hits);
                for (std::size_t x = 0; x < width; ++x) {
                    if (!hits[x].valid()) continue;
                    const SurfacePoint point = surface_point(mesh, hits[x]);
                    lit.places[y * width + x] = point.position_mm;
                    lit.normals[y * width + x] = point.normal;
                }
            }
        });
    lit.irradiance = projector_irradiance(mesh, projector, progress);
    return lit;
}

/// A pixel of then that lit the place, with its share.
struct CarriedFrom {
    std::size_t pixel = 0;
    double share = 0.0;
};

/// The pixels of then around a place of the mesh that were measured there. Empty: too few.
std::vector<CarriedFrom> sources_of(const ColourCalibration& then,
                                    const LitPlaces& lit,
                                    const View& projector,
                                    const glm::dvec3& place,
                                    const glm::dvec3& normal,
                                    float least_irradiance) {
    std::vector<CarriedFrom> sources;
    const auto pixel = project(projector, place);
    if (!pixel) return sources;
    const double left = std::floor(pixel->x - 0.5), top = std::floor(pixel->y - 0.5);
    const double px_mm = glm::length(place - centre_in_world(projector)) / projector.focal_px.x;
    double weight = 0.0;
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 2; ++column) {
            const double x = left + column, y = top + row;
            if (!(x >= 0.0 && y >= 0.0 && x < then.width && y < then.height)) continue;
            const auto index = static_cast<std::size_t>(y) * static_cast<std::size_t>(then.width) +
                               static_cast<std::size_t>(x);
            const auto status = static_cast<PixelStatus>(then.status.values[index]);
            if (status != PixelStatus::measured && status != PixelStatus::filled) continue;
            if (!(lit.irradiance.values[index] > least_irradiance)) continue;
            // The same surface: within two pixels of the tangent plane, and not far along it.
            const glm::dvec3 between = glm::dvec3(lit.places[index]) - place;
            if (!(std::abs(glm::dot(between, normal)) < 2.0 * px_mm) ||
                !(glm::length(between) < 10.0 * px_mm))
                continue;
            const double share =
                (1.0 - std::abs(pixel->x - 0.5 - x)) * (1.0 - std::abs(pixel->y - 0.5 - y));
            sources.push_back({index, share});
            weight += share;
        }
    if (weight < 0.5) return {};
    for (CarriedFrom& source : sources) source.share /= weight;
    return sources;
}

void carry_pixel(const ColourCalibration& then,
                 const LitPlaces& lit_then,
                 const std::vector<CarriedFrom>& sources,
                 double irradiance,
                 std::size_t pixel,
                 ColourCalibration& now) {
    bool filled = false;
    for (const CarriedFrom& source : sources) {
        const auto plane = [&](const ImageF& from, ImageF& to, std::size_t channels, double by) {
            for (std::size_t c = 0; c < channels; ++c)
                to.values[channels * pixel + c] += static_cast<float>(
                    by * static_cast<double>(from.values[channels * source.pixel + c]));
        };
        plane(then.unmixing, now.unmixing, 9, source.share);
        plane(then.dark, now.dark, 3, source.share);
        plane(then.span,
              now.span,
              3,
              source.share * irradiance /
                  static_cast<double>(lit_then.irradiance.values[source.pixel]));
        filled |=
            then.status.values[source.pixel] == static_cast<std::uint8_t>(PixelStatus::filled);
    }
    now.status.values[pixel] =
        static_cast<std::uint8_t>(filled ? PixelStatus::filled : PixelStatus::measured);
}

/// Where the camera sees a place now: where it saw it, and how far the pose moves it.
std::optional<glm::dvec2> seen_now(const ColourCalibration& then,
                                   const std::vector<CarriedFrom>& sources,
                                   const PairOfViews& views_then,
                                   const PairOfViews& views_now,
                                   const glm::dvec3& place) {
    const auto before = project(views_then.camera, place), after = project(views_now.camera, place);
    if (!before || !after) return std::nullopt;
    glm::dvec2 seen(0.0);
    for (const CarriedFrom& source : sources)
        seen += source.share * glm::dvec2(then.camera_px.values[2 * source.pixel],
                                          then.camera_px.values[2 * source.pixel + 1]);
    return seen + *after - *before;
}

void copy_pixel(const ColourCalibration& then, std::size_t pixel, ColourCalibration& now) {
    const auto plane = [&](const ImageF& from, ImageF& to, std::size_t channels) {
        std::copy_n(from.values.begin() + static_cast<std::ptrdiff_t>(channels * pixel),
                    channels,
                    to.values.begin() + static_cast<std::ptrdiff_t>(channels * pixel));
    };
    plane(then.unmixing, now.unmixing, 9);
    plane(then.dark, now.dark, 3);
    plane(then.span, now.span, 3);
    plane(then.camera_px, now.camera_px, 2);
    now.status.values[pixel] = then.status.values[pixel];
}

/// Each projector pixel of now lights a place of the mesh, which other pixels lit then: their
/// unmixing and dark, and their span over the irradiance that they threw there (cos(theta) /
/// distance^2) times that of now, between those of the four that were measured and lit the same
/// surface; half of the weight at least. What only saw light of its own room keeps it: the dark is
/// not scaled. What nothing is carried to is predicted as predict_hidden() does, or without a
/// correction. Off the mesh all stays as it was. The projector's own vignetting between two places
/// some pixels apart is not looked at. Throws std::invalid_argument for views of
/// another size than the calibration.
ColourCalibration carry_colours(const ColourCalibration& then,
                                const Mesh& mesh,
                                const PairOfViews& views_then,
                                const PairOfViews& views_now,
                                const Progress& progress = {}) {
    for (const View* projector : {&views_then.projector, &views_now.projector})
        check_argument(projector->width == then.width && projector->height == then.height,
                       "carry_colours: a projector of another size than the calibration");
    const Tracer tracer(mesh);
    const LitPlaces lit_then =
        lit_places(mesh, tracer, views_then.projector, progress.part(0.0, 0.4));
    const LitPlaces lit_now =
        lit_places(mesh, tracer, views_now.projector, progress.part(0.4, 0.8));
    // Light that hardly grazes a surface says nothing of it under another angle.
    const float least_irradiance =
        static_cast<float>(kGrazingShare) * quantile(lit_then.irradiance.values, 0.999);

    ColourCalibration now = then;
    now.created = utc_now();
    now.unmixing = ImageF(then.width, then.height, 9);
    now.dark = ImageF(then.width, then.height, 3);
    now.span = ImageF(then.width, then.height, 3);
    now.status = Image8(then.width, then.height, 1);
    now.camera_px = ImageF(then.width, then.height, 2, std::numeric_limits<float>::quiet_NaN());
    parallel_for(lit_now.places.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const glm::dvec3 place(lit_now.places[p]);
            const double irradiance = static_cast<double>(lit_now.irradiance.values[p]);
            if (!(irradiance > 0.0)) {
                if (!(lit_then.irradiance.values[p] > 0.0f)) copy_pixel(then, p, now);
                continue;
            }
            now.status.values[p] = static_cast<std::uint8_t>(PixelStatus::not_decoded);
            if (!std::isfinite(place.x)) continue;
            const std::vector<CarriedFrom> sources = sources_of(then,
                                                                lit_then,
                                                                views_then.projector,
                                                                place,
                                                                glm::dvec3(lit_now.normals[p]),
                                                                least_irradiance);
            if (sources.empty()) continue;
            carry_pixel(then, lit_then, sources, irradiance, p, now);
            if (const auto seen = seen_now(then, sources, views_then, views_now, place)) {
                now.camera_px.values[2 * p] = static_cast<float>(seen->x);
                now.camera_px.values[2 * p + 1] = static_cast<float>(seen->y);
            }
        }
    });
    std::size_t lit = 0, valid = 0;
    for (const std::uint8_t status : now.status.values) {
        lit += status != static_cast<std::uint8_t>(PixelStatus::unlit);
        valid += is_valid(static_cast<PixelStatus>(status));
    }
    now.valid_fraction =
        static_cast<double>(valid) / static_cast<double>(std::max<std::size_t>(lit, 1));
    now.predicted_fraction = now.prediction_error_median = now.prediction_error_p95 = 0.0;
    progress.update(0.9, "predicting what is hidden");
    return predict_hidden(std::move(now), lit_now.irradiance);
}

const RoomGeometry& room_of(const CalibrationOrigin& origin) {
    if (!origin.room)
        throw Refused("the calibration does not say where its camera stands",
                      "calibrate with livery capture or in the window, with the data sheets' "
                      "figures");
    return *origin.room;
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
    seal(reposed.calibration);
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
