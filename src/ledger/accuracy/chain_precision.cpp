#include "ledger/accuracy/chain_precision.h"

#include <algorithm>
#include <cmath>

#include "compensation/compensate.h"
#include "compensation/compensation.h"
#include "compensation/lit_pixels.h"
#include "core/error.h"
#include "core/pictures/picture_means.h"
#include "core/statistics.h"
#include "jobs/synthetic_calibration.h"
#include "ledger/accuracy/chain_steps.h"
#include "radiance/renderer.h"
#include "scene/frame_plan.h"
#include "scene/library.h"

namespace livery {

namespace {

constexpr int kHalvesSwaps = 5;

AccuracyScene scene_named(const std::string& name, const Progress& progress = {}) {
    std::vector<AccuracyScene> scenes = accuracy_scenes(true, progress);
    if (scenes.front().name != name) scenes = accuracy_scenes(false, progress);
    const auto found = std::find_if(
        scenes.begin(), scenes.end(), [&](const auto& scene) { return scene.name == name; });
    check_argument(found != scenes.end(), "no scene of the ledger is called " + name);
    return *found;
}

ChainPart part_of(const std::string& scene_name, bool slow) {
    ChainPart part;
    part.slow = slow;
    for (const char* level :
         {"light, shaded fragments and picture", "light that reaches fragments"}) {
        part.rows.push_back({"half floats, " + scene_name, level, "full floats"});
    }
    part.inputs = [scene_name] { return hash_of(scene_named(scene_name)); };
    part.measure = [scene_name](std::vector<ChainRow>& rows, const Progress& progress) {
        const AccuracyScene scene = scene_named(scene_name, progress);
        const auto geometry =
            std::make_shared<const FrameGeometry>(scene.scene.product, scene.view, progress);
        const StoredPicture full = stored_picture(scene, geometry, StoredHalves::none, progress);
        const StoredHalves halves[] = {StoredHalves::all, StoredHalves::inputs};
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const StoredPicture stored = stored_picture(scene, geometry, halves[k], progress);
            set_errors(rows[k], colour_differences(stored.working, full.working));
            rows[k].ms = stored.swap_ms;
        }
    };
    return part;
}

}  // namespace

StoredPicture stored_picture(const AccuracyScene& scene,
                             const std::shared_ptr<const FrameGeometry>& geometry,
                             StoredHalves halves,
                             const Progress& progress) {
    RadianceRenderer renderer(geometry, false, ShadingDevice::gl, halves);
    const auto drawn = [&](const Scene& its) {
        FramePlan plan = plan_frame(its, Quality::normal, FrameStage::radiance);
        return milliseconds_of([&] {
            renderer.render(its, plan, progress);
            renderer.picture();
        });
    };
    StoredPicture stored;
    drawn(scene.scene);
    stored.working = renderer.read_back();
    std::vector<double> swaps;
    Scene again = scene.scene;
    for (int k = 0; k < kHalvesSwaps; ++k) {
        progress.check_stop();
        // Another exposure shades every part anew, and nothing else
        again.exposure_ev += 0.01;
        swaps.push_back(drawn(again));
    }
    stored.swap_ms = median(swaps);
    return stored;
}

std::vector<ChainPart> half_float_parts(const AccuracyOptions&) {
    return {part_of("car, solid red, studio", false),
            part_of("car, pearl with a film, overcast", true)};
}

namespace {

constexpr int kSquare_px = 4, kRoundings = 9;

/// The car's body from dark to light.
constexpr const char* kPaints[] = {"solid black", "solid red", "solid white"};

AccuracyScene car_in(const std::string& paint) {
    AccuracyScene scene = accuracy_scenes(true).front();
    Look look = find_look("solid-red");
    look.parts["body"] = paint;
    scene.name = paint;
    scene.scene =
        make_scene(scene.scene.product, look, scene.scene.eye_in_world_mm, scene.scene.environment);
    return scene;
}

/// Means over squares whose pixels are all covered; coverage 0 elsewhere.
ImageF whole_means(const ImageF& shown, int side_px) {
    ImageF means = square_means(shown, side_px);
    const float least = 1.0f - 0.5f / static_cast<float>(side_px * side_px);
    for (std::size_t i = 3; i < means.values.size(); i += 4) {
        means.values[i] = means.values[i] > least ? 1.0f : 0.0f;
    }
    return means;
}

void measure(const std::string& paint, std::vector<ChainRow>& rows, const Progress& progress) {
    const AccuracyScene scene = car_in(paint);
    RadianceRenderer renderer(scene.scene.product, scene.view, progress);
    FramePlan plan = plan_frame(scene.scene, Quality::draft, FrameStage::radiance);
    renderer.render(scene.scene, plan, progress);
    const ImageF wanted = renderer.read_back();
    const ColourCalibration calibration = synthetic_calibration(renderer.surface_map().coverage);
    const CompensationTable table =
        bake(calibration, design_white_luminance(calibration, kDesignWhitePercentile, {}));
    const ImageF exact = exact_drive(table, wanted);
    const Image8 rounded = rounded_drive(exact), dithered = compensate(table, wanted);
    set_errors(rows.at(0), drive_errors(table, rounded, exact, 1));
    set_errors(rows.at(1), drive_errors(table, dithered, exact, 1));
    set_errors(rows.at(2), drive_errors(table, rounded, exact, kSquare_px));
    set_errors(rows.at(3), drive_errors(table, dithered, exact, kSquare_px));
    rows.at(1).ms = compensation_ms(table, wanted);
}

}  // namespace

Image8 rounded_drive(const ImageF& exact) {
    Image8 drive(exact.width, exact.height, exact.channels);
    for (std::size_t i = 0; i < exact.values.size(); ++i) {
        drive.values[i] = static_cast<std::uint8_t>(std::lround(exact.values[i]));
    }
    return drive;
}

std::vector<float> drive_errors(const CompensationTable& table,
                                const Image8& drive,
                                const ImageF& exact,
                                int side_px) {
    return colour_differences(whole_means(shown_by(table, drive), side_px),
                              whole_means(shown_by(table, exact), side_px));
}

double compensation_ms(const CompensationTable& table, const ImageF& wanted) {
    Image8 drive = compensate(table, wanted);
    std::vector<double> ms;
    for (int k = 0; k < kRoundings; ++k) {
        // Nothing is counted: covered pixels need not be known
        ms.push_back(milliseconds_of([&] { compensate_again(table, wanted, 0, &drive); }));
    }
    return median(ms);
}

std::vector<ChainPart> bit_parts(const AccuracyOptions&) {
    std::vector<ChainPart> parts;
    for (const std::string paint : kPaints) {
        ChainPart& part = parts.emplace_back();
        for (const char* level : {"rounded",
                                  "dithered",
                                  "rounded, mean of 4x4 pixels",
                                  "dithered, mean of 4x4 pixels"}) {
            part.rows.push_back({"8 bits, " + paint, level, "the exact drive"});
        }
        part.inputs = [paint] { return hash_of(car_in(paint)); };
        part.measure = [paint](std::vector<ChainRow>& rows, const Progress& progress) {
            measure(paint, rows, progress);
        };
    }
    return parts;
}

}  // namespace livery
