#include "live/capture_work.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "calibration/preflight.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/log.h"
#include "core/pictures/white_balance.h"
#include "core/statistics.h"
#include "jobs/calibrate/calibration_check.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/capture_bench.h"
#include "jobs/watched_captures.h"
#include "live/projector_setup.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

constexpr double kWhite = 0.9;     ///< of full scale
constexpr double kClipped = 0.98;  ///< of full scale
constexpr std::size_t kLookedAt = 60000;

void normalise(CaptureHistogram& histogram) {
    // What lies in the dark around the mock-up would leave nothing of the rest.
    const float most = *std::max_element(histogram.share.begin() + 1, histogram.share.end());
    for (float& share : histogram.share) share = std::min(1.0f, most > 0.0f ? share / most : share);
}

std::size_t bin_of(double share_of_full_scale) {
    return static_cast<std::size_t>(std::clamp(share_of_full_scale, 0.0, 1.0) * 63.0 + 0.5);
}

/// The pixels of a picture made small, each by its place in the large one.
template <typename Pixel>
Image8 thinned(int width, int height, int wanted, const Pixel& pixel) {
    const int step = std::max(1, (width + wanted - 1) / wanted);
    Image8 small(std::max(1, width / step), std::max(1, height / step), 3);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
            for (int c = 0; c < 3; ++c) small.at(x, y, c) = pixel(x * step, y * step, step, c);
    return small;
}

}  // namespace

Image8 small_photograph(const Photograph& photograph, int width, const glm::dvec3& balance) {
    const ImageF& image = photograph.image;
    const double full = std::isfinite(photograph.saturates_at)
                            ? photograph.saturates_at - photograph.black_level
                            : 1.0;
    return thinned(image.width, image.height, width, [&](int x, int y, int step, int c) {
        double sum = 0.0;
        int count = 0;
        for (int v = y; v < std::min(y + step, image.height); ++v)
            for (int u = x; u < std::min(x + step, image.width); ++u, ++count)
                sum += static_cast<double>(image.at(u, v, c)) - photograph.black_level;
        const double light = count > 0 ? balance[c] * sum / (count * kWhite * full) : 0.0;
        return static_cast<std::uint8_t>(
            255.0 * srgb_encode(std::clamp(std::isfinite(light) ? light : 0.0, 0.0, 1.0)) + 0.5);
    });
}

Image8 small_picture(const Image8& picture, int width) {
    return thinned(picture.width, picture.height, width, [&](int x, int y, int step, int c) {
        int sum = 0, count = 0;
        for (int v = y; v < std::min(y + step, picture.height); ++v)
            for (int u = x; u < std::min(x + step, picture.width); ++u, ++count)
                sum += picture.at(u, v, c);
        return static_cast<std::uint8_t>(count > 0 ? sum / count : 0);
    });
}

CaptureHistogram histogram_of(const Photograph& photograph) {
    CaptureHistogram histogram;
    if (!std::isfinite(photograph.saturates_at)) return histogram;
    const double full = photograph.saturates_at - photograph.black_level;
    const std::size_t pixels = photograph.image.pixel_count();
    const std::size_t step = std::max<std::size_t>(1, pixels / kLookedAt);
    double clipped = 0.0, count = 0.0;
    for (std::size_t i = 0; i < pixels; i += step) {
        double most = 0.0;
        for (std::size_t c = 0; c < 3; ++c)
            most = std::max(
                most,
                static_cast<double>(photograph.image.values[3 * i + c]) - photograph.black_level);
        histogram.share[bin_of(most / full)] += 1.0f;
        clipped += most >= kClipped * full;
        count += 1.0;
    }
    histogram.clipped = clipped / std::max(count, 1.0);
    normalise(histogram);
    return histogram;
}

CaptureHistogram histogram_of(const Image8& srgb) {
    CaptureHistogram histogram;
    const std::size_t pixels = srgb.pixel_count();
    const std::size_t step = std::max<std::size_t>(1, pixels / kLookedAt);
    double clipped = 0.0, count = 0.0;
    for (std::size_t i = 0; i < pixels; i += step) {
        const auto most =
            *std::max_element(srgb.values.begin() + static_cast<std::ptrdiff_t>(3 * i),
                              srgb.values.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
        histogram.share[bin_of(srgb_decode(most / 255.0))] += 1.0f;
        clipped += most >= 253;
        count += 1.0;
    }
    histogram.clipped = clipped / std::max(count, 1.0);
    normalise(histogram);
    return histogram;
}

namespace {

constexpr std::array<std::uint8_t, 3> kOutline{255, 150, 40}, kMeasured{70, 150, 90},
    kPredicted{80, 120, 190}, kMissing{200, 60, 50};

void paint(Image8& picture, int x, int y, const std::array<std::uint8_t, 3>& colour) {
    for (int c = 0; c < 3; ++c) picture.at(x, y, c) = colour[static_cast<std::size_t>(c)];
}

}  // namespace

Image8 outline_on_photograph(const Photograph& photograph,
                             const View& camera,
                             const Mesh& mesh,
                             int width) {
    Image8 picture = small_photograph(photograph, width, white_balance(photograph));
    const Image8 inside = mockup_mask(mesh, resized(camera, picture.width, picture.height));
    for (int y = 1; y < picture.height; ++y)
        for (int x = 1; x < picture.width; ++x) {
            const bool here = inside.at(x, y) != 0;
            if (here != (inside.at(x - 1, y) != 0) || here != (inside.at(x, y - 1) != 0))
                paint(picture, x, y, kOutline);
        }
    return picture;
}

Image8 status_picture(const ColourCalibration& calibration, const Image8& mockup, int width) {
    Image8 picture(calibration.width, calibration.height, 3, 24);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const auto status = static_cast<PixelStatus>(calibration.status.at(x, y));
            if (status == PixelStatus::predicted) {
                paint(picture, x, y, kPredicted);
            } else if (is_valid(status)) {
                paint(picture, x, y, kMeasured);
            } else if (!mockup.empty() && mockup.at(x, y)) {
                paint(picture, x, y, kMissing);
            }
        }
    return small_picture(picture, width);
}

CaptureView::Doing doing_of(CaptureStep step) {
    switch (step) {
        case CaptureStep::look:
            return CaptureView::Doing::preflight;
        case CaptureStep::geometry:
        case CaptureStep::colour:
            return CaptureView::Doing::capturing;
        case CaptureStep::check:
            return CaptureView::Doing::checking;
    }
    throw std::invalid_argument("unknown step");
}

CaptureStep photographed_last(const CaptureView& view) {
    return view.doing_step == CaptureStep::geometry ? CaptureStep::geometry : CaptureStep::colour;
}

bool asks_for_the_same(const CalibrationSettings& a, const CalibrationSettings& b) {
    return a.made_with == b.made_with && a.width == b.width && a.height == b.height &&
           a.projector == b.projector && a.product == b.product && a.data_sheets == b.data_sheets &&
           a.turned_as == b.turned_as && a.places == b.places;
}

std::vector<GradedFigure> compared_with(const std::filesystem::path& kept,
                                        const StagedCalibration& run) {
    if (kept.empty() || !run.made || !run.made->projector) return {};
    try {
        const auto projector = projector_view_of(kept);
        if (!projector) return {};
        return grade_figures(compare_calibrations(read_calibration(kept),
                                                  *projector,
                                                  run.made->calibration,
                                                  *run.made->projector,
                                                  run.settings.product->mesh));
    } catch (const FileError& error) {
        log_line(LogLevel::warning, error.what());  // One that is gone is no fault of the new one.
    } catch (const Refused& refused) {
        log_line(LogLevel::warning, refused.what());
    } catch (const std::invalid_argument& other_size) {
        log_line(LogLevel::warning, other_size.what());
    }
    return {};
}

DriftSource drift_source(const std::filesystem::path& calibration, const Product& product) {
    const char* const fix = "calibrate with a camera first: what it photographs last is kept";
    if (calibration.empty()) throw Refused("no calibration is in use", fix);
    const auto origin = read_origin(calibration);
    const auto projector = projector_view_of(calibration);
    if (!origin || !origin->ends || !projector)
        throw Refused("the calibration in use keeps no photographs of how the bench was", fix);
    return {*origin->ends, mockup_mask(product.mesh, *projector)};
}

CalibrationSettings CaptureThread::Implementation::request() const {
    CalibrationSettings request;
    if (bench.simulated) {
        request = settings_of(bench.simulated->description(), bench.product);
        request.made_with = bench.name + ", its own projector";
    } else {
        request.product = setup.product;
        request.width = setup.width;
        request.height = setup.height;
        request.data_sheets = setup.data_sheets;
        request.made_with = (is_by_hand() ? "photographs in " + setup.camera.what : bench.name) +
                            ", " + setup.projector;
    }
    if (setup.projector_view) request.projector = setup.projector_view;
    request.shots = setup.colour_shots;
    request.places = setup.places;
    return request;
}

void CaptureThread::Implementation::preflight_now() {
    publish([](CaptureView& view) { view.step(CaptureStep::look).figures.clear(); });
    const CalibrationSettings what = request();
    preflight(ports(),
              {what.width, what.height, mockup_of(what)},
              progress(),
              [this](const GradedFigure& figure) {
                  publish([&](CaptureView& view) {
                      view.step(CaptureStep::look).figures.push_back(figure);
                  });
              });
}

void CaptureThread::Implementation::fit_curve() {
    const CalibrationSettings what = request();
    const CameraCurve curve =
        fit_camera_curve(*bench.camera, ports(), what.width, what.height, progress());
    publish([&](CaptureView& view) {
        view.curve = fmt::format(
            "the curve just fitted: with it, photographs of one light differ by {:.2f} %. It is "
            "kept "
            "in {}",
            100.0 * curve.residual,
            curve.file.string());
    });
}

/// Every photograph as it comes, from the camera or from the folder, becomes a tile.
void CaptureThread::Implementation::look_at(Recording& recording) {
    recording.tell([this, &recording](std::size_t showing, const Photograph& photograph) {
        const std::string of = recording.announced();
        if (of == "white") white = photograph;
        if (of == "white" || of == "bright-gray") balance = white_balance(photograph);
        const auto seen =
            std::make_shared<Image8>(small_photograph(photograph, kTileWidth_px, balance));
        const CaptureHistogram histogram = histogram_of(photograph);
        publish([&](CaptureView& view) {
            if (view.tiles.size() <= showing) view.tiles.resize(showing + 1);
            CaptureTile& tile = view.tiles[showing];
            tile.photographs = tile.of == of ? tile.photographs + 1 : 1;
            tile.of = of;
            tile.seen = seen;
            view.histogram = histogram;
            view.taken = taken_before + recording.taken();
            view.kept_from_before = answered_before + recording.answered();
        });
    });
}

MeetRecording CaptureThread::Implementation::meet(const std::vector<std::size_t>& again) {
    return [this, again](Recording& recording) {
        for (const std::size_t showing : again) recording.take_again(showing);
        look_at(recording);
        publish([this](CaptureView& view) {
            view.tiles.clear();
            taken_before = view.taken;
            answered_before = view.kept_from_before;
        });
    };
}

void CaptureThread::Implementation::find_geometry_now(const std::vector<std::size_t>& again) {
    find_geometry(run, ports(), meet(again), progress());
    const RoomGeometry& room = run.room->geometry;
    const auto finding = std::make_shared<Image8>(
        outline_on_photograph(white, room.camera, run.settings.product->mesh, kLiveWidth_px));
    publish([&](CaptureView& view) {
        CaptureStepView& step = view.step(CaptureStep::geometry);
        step.figures = grade_figures(room);
        step.finding = finding;
        step.finding_of = "Found: the mesh's outline";
    });
}

void CaptureThread::Implementation::find_colours_now(const std::vector<std::size_t>& again) {
    check_calibrations_folder();
    if (finds_room(run.settings) && !run.room) {
        find_geometry_now(again);
        publish([](CaptureView& view) { view.step(CaptureStep::geometry).done = true; });
    }
    find_colours(run, ports(), meet(again), progress());
    finish();
}

void CaptureThread::Implementation::finish() {
    const CalibrationResult& made = *run.made;
    const auto kept = keep_calibration(made, run.settings);
    const Image8 mockup = made.projector && run.settings.product
                              ? mockup_mask(run.settings.product->mesh, *made.projector)
                              : Image8();
    const auto finding =
        std::make_shared<Image8>(status_picture(made.calibration, mockup, kLiveWidth_px));
    const auto figures = grade_figures(made.calibration);
    const CaptureSeconds captured = made.all_captured();
    publish([&](CaptureView& view) {
        CaptureStepView& step = view.step(CaptureStep::colour);
        step.figures = figures;
        step.finding = finding;
        step.finding_of = "Measured green, predicted blue, none red";
        view.finished = kept;
        view.compared.clear();
        view.capture_s = captured.all;
        view.camera_s = captured.camera;
        view.projector_s = captured.projector;
    });
}

void CaptureThread::Implementation::check_now() {
    check_colours(run, ports(), progress());
    Photograph grey = run.check->colours.front().photograph;
    const float brightest = quantile(grey.image.values, 0.995);
    grey.saturates_at = std::max(grey.black_level + 1e-6, 1.5 * static_cast<double>(brightest));
    const auto finding = std::make_shared<Image8>(small_photograph(grey, kLiveWidth_px, balance));
    const std::vector<GradedFigure> compared = compared_with(setup.in_use, run);
    publish([&](CaptureView& view) {
        CaptureStepView& step = view.step(CaptureStep::check);
        step.figures = grade_figures(*run.check);
        step.finding = finding;
        step.finding_of = "A corrected grey, brightened";
        view.compared = compared;
    });
}

void CaptureThread::Implementation::look_for_drift_now(const std::filesystem::path& calibration) {
    publish([](CaptureView& view) { view.drift.clear(); });
    const DriftSource source = drift_source(calibration, *request().product);
    const Drift drift = livery::look_for_drift(ports(), source.then, source.mockup, progress());
    publish([&](CaptureView& view) { view.drift = grade_figures(drift); });
}

void CaptureThread::Implementation::find_mockup_now(const std::filesystem::path& calibration) {
    publish([](CaptureView& view) {
        view.found_again.clear();
        view.reposed.reset();
    });
    check_calibrations_folder();
    const auto origin = calibration.empty() ? std::nullopt : read_origin(calibration);
    if (!origin)
        throw Refused("the calibration in use does not say where everything stood",
                      "calibrate with a camera first");
    const ReposedCalibration reposed = repose_through_ports(
        ports(), read_calibration(calibration), *origin, *request().product, progress());
    const auto kept = keep_reposed(reposed);
    publish([&](CaptureView& view) {
        view.found_again = grade_figures(reposed.found);
        view.reposed = kept;
        view.drift.clear();  // Of where it stood before.
    });
}

/// What is asked of a step follows from the set-up as it is now.
void CaptureThread::Implementation::show_steps() {
    if (setup.width == 0 && !bench.simulated) return;
    CalibrationSettings now = request();
    if (!asks_for_the_same(now, run.settings)) run = {};
    run.folder = folder(now.made_with);
    run.settings = std::move(now);
    const double each_s = times.photographs > 0 ? times.seconds / times.photographs : 0.0;
    publish([&](CaptureView& view) {
        // Photographs in a folder come from a camera that nobody can look through, all at once
        view.step(CaptureStep::look).called_for = !is_by_hand();
        view.step(CaptureStep::look).done = !view.step(CaptureStep::look).figures.empty();
        view.step(CaptureStep::geometry).called_for = finds_room(run.settings) && !is_by_hand();
        view.step(CaptureStep::geometry).done = run.room.has_value();
        view.step(CaptureStep::colour).done = run.made.has_value();
        view.step(CaptureStep::check).called_for =
            !is_by_hand() &&
            (run.made ? can_check(run) : run.settings.projector || finds_room(run.settings));
        view.step(CaptureStep::check).done = run.check.has_value();
        for (const auto& [step, stage] : kPhotographed) {
            CaptureStepView& shown = view.step(step);
            shown.can_go_on = can_go_on(run, stage);
            shown.expected_s = each_s * expected_photographs(run.settings, stage);
            if (shown.done) continue;
            shown.figures.clear();
            shown.finding.reset();
        }
        if (!run.check) view.compared.clear();
    });
}

void CaptureThread::Implementation::take_step(CaptureStep step,
                                              bool anew,
                                              const std::vector<std::size_t>& again) {
    publish([&](CaptureView& view) { view.doing_step = step; });
    show_steps();
    for (const auto& [photographed, stage] : kPhotographed)
        if (photographed == step && anew) forget(run, stage);
    if (step == CaptureStep::geometry || step == CaptureStep::colour)
        publish([](CaptureView& view) {
            view.finished.reset();
            view.found_before.clear();
            view.taken = view.kept_from_before = 0;
        });
    const auto start = CaptureClock::now();
    switch (step) {
        case CaptureStep::look:
            preflight_now();
            break;
        case CaptureStep::geometry:
            find_geometry_now(again);
            break;
        case CaptureStep::colour:
            is_by_hand() ? capture_by_hand() : find_colours_now(again);
            break;
        case CaptureStep::check:
            check_now();
            break;
    }
    const double seconds = std::chrono::duration<double>(CaptureClock::now() - start).count();
    publish([&](CaptureView& view) { view.step(step).seconds = seconds; });
}

/// One picture after the other, each until somebody says that it was taken.
void CaptureThread::Implementation::show_by_hand(const std::vector<Pattern>& patterns) {
    const ShowPicture show = ports().show;
    if (patterns.empty()) return;
    publish([](CaptureView& view) { view.waits_for_next = true; });
    const Progress told = progress();
    for (std::size_t k = 0; k < patterns.size(); ++k) {
        show(patterns[k].drive);
        next_picture = false;  // before it is said: who reads that may press at once
        told.update(static_cast<double>(k) / static_cast<double>(patterns.size()),
                    fmt::format("shoot {} of {}: {}", k + 1, patterns.size(), patterns[k].role));
        while (!next_picture) {
            told.check_stop();
            std::this_thread::sleep_for(kBetweenLooks);
        }
    }
    show(Image8(setup.width, setup.height, 3));
    publish([](CaptureView& view) { view.waits_for_next = false; });
}

void CaptureThread::Implementation::capture_by_hand() {
    check_calibrations_folder();
    const CalibrationSettings& settings = run.settings;
    std::vector<Pattern> patterns =
        place_patterns(settings.places, settings.width, settings.height);
    for (Pattern& pattern : colour_patterns(settings.width, settings.height, 0, 255))
        patterns.push_back(std::move(pattern));
    std::vector<std::string> roles;
    for (const Pattern& pattern : patterns) roles.push_back(pattern.role);
    WatchedCaptures watched(setup.camera.what, roles);
    const auto before = watched.look_at_what_is_there(std::move(patterns));
    publish([&](CaptureView& view) { view.found_before = before.words; });
    show_by_hand(before.still_to_shoot);
    const Progress told = progress();
    told.update(0.0, fmt::format("copy the {} photographs to {}", roles.size(), setup.camera.what));
    const BenchPorts files = watched.ports(told, [&](const WatchedState& state) {
        told.update(static_cast<double>(state.found) / static_cast<double>(state.wanted),
                    text_of(state));
    });
    run.made = calibrate_through_ports(files, run.settings, told);
    run.room = run.made->room;
    finish();
}

}  // namespace livery
