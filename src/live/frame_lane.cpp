#include "live/frame_lane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <set>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "appearance/material_library.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/error.h"
#include "core/time.h"
#include "jobs/comparison.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

/// On a thread of its own that gives way, waited for: a thread's priority only goes down, and this
/// one has frames to draw afterwards.
void run_giving_way(std::optional<Urgency> urgency, const std::function<void()>& work) {
    if (!urgency) return work();
    std::exception_ptr error;
    std::thread thread([&] {
        lower_priority_of_this_thread(*urgency);
        try {
            work();
        } catch (...) {
            error = std::current_exception();
        }
    });
    thread.join();
    if (error) std::rethrow_exception(error);
}

template <typename T>
bool all_same(const std::vector<T>& a, const std::vector<T>& b, bool (*same)(const T&, const T&)) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

/// In one light.
bool looks_the_same(const Scene& a, const Scene& b) {
    return all_same(a.part_materials, b.part_materials, same_reflectance) &&
           all_same(a.artwork, b.artwork, looks_alike) && a.exposure_ev == b.exposure_ev;
}

bool serves(const FrameGeometry& geometry, const SolveKey& key) {
    return geometry.product == key.product && geometry.view == key.view &&
           geometry.map.samples_per_pixel >= sub_samples_of(key.levels);
}

/// `more` into `plan`: milliseconds are added up, and passes that it lacks put in where they stand.
void add_milliseconds(FramePlan& plan, const FramePlan& more, bool add_passes) {
    for (const PlannedPass& pass : more.passes) {
        PlannedPass* known = find_pass(plan, pass.id);
        if (known && pass.ms) {
            known->ms = known->ms.value_or(0.0) + *pass.ms;
        } else if (!known && add_passes) {
            plan.passes.push_back(pass);
        }
    }
}

/// What a paint's program depends on.
struct ProgramOf {
    ReflectanceModel model = ReflectanceModel::lambert;
    bool glints = false;

    explicit ProgramOf(ReflectanceModel its_model) : model(its_model) {}
    explicit ProgramOf(const Material& paint) : model(paint.model), glints(has_glints(paint)) {}
    auto operator<=>(const ProgramOf&) const = default;
};

/// A paint that is drawn with that program.
Material plain_paint(const ProgramOf& program) {
    Material paint;
    paint.model = program.model;
    if (program.model == ReflectanceModel::measured) paint.measured = blank_measured_paint();
    if (program.model == ReflectanceModel::translucent) paint = translucent_paint({});
    if (program.glints) paint.glint_density_per_mm2 = 1000.0;
    return paint;
}

/// What the next paint may need: the library's, and that of a glowing part.
std::set<ProgramOf> programs_likely_next(const PaintLibrary* library) {
    std::set<ProgramOf> programs{ProgramOf(glow_paint())};
    if (!library) return programs;
    for (const auto* paints : {&library->shipped, &library->users, &library->unread}) {
        for (const Material& paint : *paints) programs.emplace(paint);
    }
    return programs;
}

}  // namespace

int wipe_column(const SurfaceMap& map, double wipe_at) {
    Image8 covered(map.width, map.height, 1);
    for (std::size_t i = 0; i < covered.values.size(); ++i) {
        covered.values[i] = map.coverage.values[i] > 0.0f ? 1 : 0;
    }
    const PixelRectangle box = bounds_of_mask(covered, 0);
    const double column = box.left + std::clamp(wipe_at, 0.0, 1.0) * (box.right - box.left);
    return static_cast<int>(std::lround(column));
}

Material glow_paint() {
    Material paint;
    paint.name = "glow";
    paint.model = ReflectanceModel::lambert;
    paint.diffuse = {1.0, 0.42, 0.06};
    return paint;
}

std::shared_ptr<const FrameGeometry> GeometryCache::get(const SolveKey& key,
                                                        const Progress& progress) {
    std::shared_ptr<const FrameGeometry> known;
    {
        const std::scoped_lock lock(mutex_);
        if (newest_ && newest_->product == key.product && newest_->view == key.view) {
            known = newest_;
        }
    }
    if (known && serves(*known, key)) return known;
    const int sub_samples = sub_samples_of(key.levels);
    auto made =
        known ? std::make_shared<const FrameGeometry>(*known, sub_samples, progress)
              : std::make_shared<const FrameGeometry>(key.product, key.view, progress, sub_samples);
    const std::scoped_lock lock(mutex_);
    newest_ = made;
    return made;
}

FrameLane::FrameLane(std::shared_ptr<GeometryCache> geometries, ShadingDevice device)
    : geometries_(std::move(geometries)),
      device_(chosen_device(device)),
      path_(make_drive_path(device_)) {}

void FrameLane::solve(const WantedFrame& frame,
                      const EffectLevels& levels,
                      std::optional<Urgency> urgency,
                      const Progress& progress) {
    SolveKeys keys = with_levels(frame.keys, levels);
    if (keys[1] && serves_both(*keys[0], *keys[1])) keys[1].reset();
    solved_ = {};
    prepared_ = false;
    sides_ = {};
    const double share = 1.0 / static_cast<double>(frame.sides());
    solve_light(0, frame.scene, *keys[0], urgency, progress.part(0.0, share));
    if (!keys[1]) lights_[1] = {};
    if (frame.wipe_to) {
        // Where both have one light, its paints may mirror other layers of it
        const std::size_t index = keys[1] ? 1 : 0;
        solve_light(index, *frame.wipe_to, *keys[index], urgency, progress.part(share, 1.0));
    }
    solved_ = std::move(keys);
    note_mirrors();
}

void FrameLane::note_mirrors() {
    for (std::size_t k = 0; k < lights_.size(); ++k) {
        mirrors_[k] = lights_[k].renderer ? lights_[k].renderer->mirrored() : SolvedMirror();
    }
}

void FrameLane::solve_light(std::size_t index,
                            const Scene& scene,
                            const SolveKey& key,
                            std::optional<Urgency> urgency,
                            const Progress& progress) {
    constexpr double kGeometryShare = 0.3;
    Solved& light = lights_[index];
    FramePlan plan = plan_frame(scene, key.levels, FrameStage::projector);
    if (!light.renderer || !serves(*light.renderer->geometry(), key)) {
        light = {};
        std::shared_ptr<const FrameGeometry> geometry;
        run_giving_way(
            urgency, [&] { geometry = geometries_->get(key, progress.part(0.0, kGeometryShare)); });
        light.renderer = std::make_unique<RadianceRenderer>(std::move(geometry), true, device_);
    }
    run_giving_way(urgency,
                   [&] { light.renderer->solve(scene, plan, progress.part(kGeometryShare, 1.0)); });
    if (light.untold) add_milliseconds(plan, *light.untold, false);
    light.untold = std::move(plan);
}

void FrameLane::prepare(const WantedFrame& frame, const Progress& progress) {
    prepare_mirrors(frame, progress.part(0.0, 0.5));
    prepare_programs(frame, Progress{{}, progress.stop});
    prepared_ = true;
}

void FrameLane::prepare_programs(const WantedFrame& frame, const Progress& progress) {
    std::set<ProgramOf> programs = programs_likely_next(frame.library.get());
    for (std::size_t side = 0; side < frame.sides(); ++side) {
        any_paint(frame.side(side), [&](const Material& paint) {
            programs.emplace(paint);
            return false;
        });
    }
    for (const ProgramOf& program : programs) {
        const auto start = Clock::now();
        bool used = false;
        for (std::size_t side = 0; side < frame.sides(); ++side) {
            Scene scene = scene_of(frame, side);
            for (Material& paint : scene.part_materials) {
                used = used || ProgramOf(paint) == program;
                paint = plain_paint(program);
            }
            const std::size_t index = nearest_of(solved_, frame.keys, side);
            RadianceRenderer& renderer = *lights_[index].renderer;
            FramePlan plan = plan_frame(scene, solved_[index]->levels, FrameStage::projector);
            run_giving_way(Urgency::background,
                           [&] { renderer.solve(scene, plan, progress, LightBetweenParts::kept); });
            renderer.prepare(scene, plan, progress, LightBetweenParts::kept);
        }
        if (used) continue;
        PlannedPass& pass = prepare_passes_.emplace_back();
        const ModelInfo& model = model_info(program.model);
        pass.id = {PassKind::prepare, "", program.model, program.glints};
        pass.why = fmt::format("{}{} may be next: made ready ahead",
                               model.in_words,
                               program.glints ? " and glints" : "");
        pass.ms = milliseconds_since(start);
    }
}

void FrameLane::prepare_mirrors(const WantedFrame& frame, const Progress& progress) {
    prepare_passes_.clear();
    std::set<std::size_t> lights;
    for (std::size_t side = 0; side < frame.sides(); ++side) {
        const std::size_t index = nearest_of(solved_, frame.keys, side);
        if (!lights.insert(index).second) continue;  // both sides have it
        const Scene scene = scene_of(frame, side);
        FramePlan plan = plan_frame(scene, solved_[index]->levels, FrameStage::projector);
        plan_ahead(plan);
        PlannedPass* pass = find_pass(plan, mirrored_ahead_pass());
        if (!pass) continue;
        RadianceRenderer& renderer = *lights_[index].renderer;
        const double from = 0.5 * static_cast<double>(side);
        run_giving_way(Urgency::background,
                       [&] { renderer.solve(scene, plan, progress.part(from, from + 0.5)); });
        prepare_passes_.push_back(*pass);
        renderer.prepare(scene, plan, Progress{{}, progress.stop});
    }
    note_mirrors();
}

bool can_draw(const SolveKeys& solved, const SolvedMirrors& mirrors, const WantedFrame& frame) {
    if (!solved[0] || !frame.malformed.empty()) return false;
    for (std::size_t side = 0; side < frame.sides(); ++side) {
        if (!same_pose(*solved[0], *frame.keys[side])) return false;
        try {
            const std::size_t light = nearest_of(solved, frame.keys, side);
            if (!mirrors[light].serves(frame.side(side))) return false;
        } catch (const std::invalid_argument&) {
            continue;  // a paint that cannot be: drawing it says why
        }
    }
    return true;
}

bool FrameLane::can_draw(const WantedFrame& frame) const {
    return livery::can_draw(solved_, mirrors_, frame);
}

Scene FrameLane::scene_of(const WantedFrame& frame, std::size_t side) const {
    Scene scene = frame.side(side);
    const SolveKey& light = *solved_[nearest_of(solved_, frame.keys, side)];
    scene.environment = light.environment;
    scene.lights = light.lights;
    scene.eye_in_world_mm = light.eye_mm;
    scene.relief = light.relief;
    if (const auto part = frame.glowing_part) {
        check_argument(
            *part >= 0 && static_cast<std::size_t>(*part) < scene.part_materials.size(),
            fmt::format(
                "part {} cannot glow: the product has {}", *part, scene.part_materials.size()));
        scene.part_materials[static_cast<std::size_t>(*part)] = glow_paint();
        std::erase_if(scene.artwork, [&](const PartArtwork& artwork) {
            return artwork.part == static_cast<std::size_t>(*part);
        });
    }
    return scene;
}

void FrameLane::draw_ahead(const WantedFrame& frame) {
    draw_picture(frame);
    for (Side& side : sides_) side.told = false;
}

std::shared_ptr<FinishedFrame> FrameLane::draw(const WantedFrame& frame) {
    std::shared_ptr<FinishedFrame> finished = draw_picture(frame);
    finished->plan = told_plan(frame.wipe_to.has_value());
    finished->scene = sides_[0].scene;
    if (frame.wipe_to) finished->wiped_to = sides_[1].scene;
    return finished;
}

std::shared_ptr<FinishedFrame> FrameLane::draw_picture(const WantedFrame& frame) try {
    const auto start = Clock::now();
    check_argument(frame.malformed.empty(), frame.malformed);
    check_argument(can_draw(frame), "this frame's light was not solved");
    auto finished = std::make_shared<FinishedFrame>();
    std::array<bool, 2> was_ahead{};
    for (std::size_t side = 0; side < frame.sides(); ++side) {
        const bool ahead = !sides_[side].told;
        draw_side(frame, side);
        was_ahead[side] = ahead;
    }
    compose(frame);
    // The whole frame is on its way: what waits for numbers keeps nothing from being done.
    for (std::size_t side = 0; side < frame.sides(); ++side) {
        measure_side(side);
        const double side_ms = sides_[side].shade_ms + sides_[side].compensate_ms;
        finished->shade_ms += sides_[side].shade_ms;
        finished->compensate_ms += sides_[side].compensate_ms;
        if (was_ahead[side]) finished->ms_total += side_ms;
    }
    const auto& slot = composed_.pictures->drive.slot;
    finished->number = frame.number;
    finished->drive_texture = slot->texture.name();
    finished->size_px = {slot->texture.width(), slot->texture.height()};
    finished->ready = {slot, &slot->ready};
    finished->fade_s = frame.fade_s;
    finished->pictures = composed_.pictures;
    finished->compensation = sides_[0].compensation;
    finished->asked_at = frame.asked_at;
    finished->ms_total += milliseconds_since(start);
    finished->done_at = Clock::now();
    return finished;
} catch (const std::invalid_argument&) {
    throw;
} catch (...) {
    // What OpenGL or the memory refused in the middle leaves nothing to build on.
    lights_ = {};
    solved_ = {};
    sides_ = {};
    composed_ = {};
    prepared_ = false;
    throw;
}

FramePlan FrameLane::plan_side(const Scene& scene,
                               std::size_t light,
                               const ProjectorSetup& setup) const {
    FramePlan plan = plan_frame(scene, solved_[light]->levels, FrameStage::projector);
    PlannedPass& pass = *find_pass(plan, PassKind::compensation);
    pass.why = fmt::format("{}, made on the {}, which shades it",
                           setup.table ? "the frame goes to the projector"
                                       : "without a calibration the frame goes out as sRGB",
                           device_ == ShadingDevice::gl ? "graphics card" : "processor");
    const std::size_t pixels = setup.table
                                   ? setup.table->pixels.size()
                                   : lights_[light].renderer->surface_map().coverage.pixel_count();
    pass.work_items = static_cast<double>(pixels);
    return plan;
}

void FrameLane::draw_side(const WantedFrame& frame, std::size_t index) {
    Side& side = sides_[index];
    Scene scene = scene_of(frame, index);
    const std::size_t light = nearest_of(solved_, frame.keys, index);
    const bool painted = side.radiance && side.light == light && looks_the_same(side.scene, scene);
    const bool ahead = !std::exchange(side.told, true);
    if (!ahead || !painted || side.setup != frame.setup) {
        FramePlan plan = plan_side(scene, light, *frame.setup);
        RadianceRenderer& renderer = *lights_[light].renderer;
        if (!ahead) side.shade_ms = side.compensate_ms = 0.0;
        if (painted) {
            renderer.count_work(scene, plan);  // what it shows has its price
        } else {
            side.radiance = {};
            const auto start = Clock::now();
            // What a new paint sends to other parts is solved on the back lane.
            renderer.render(scene, plan, {}, LightBetweenParts::kept);
            side.radiance = path_->take(renderer);
            side.shade_ms += milliseconds_since(start);
            side.light = light;
        }
        for (PlannedPass& pass : plan.passes) pass.ms = pass.ms.value_or(0.0);
        if (ahead) add_milliseconds(plan, side.plan, false);
        auto& untold = lights_[light].untold;
        if (!painted && untold) {
            add_milliseconds(plan, *untold, false);
            untold.reset();
        }
        side.plan = std::move(plan);
    }
    side.scene = std::move(scene);
    if (painted && side.setup == frame.setup) return;
    side.setup = nullptr;  // until it worked
    correct_side(frame.setup, index);
    side.setup = frame.setup;
}

void FrameLane::correct_side(const std::shared_ptr<const ProjectorSetup>& setup,
                             std::size_t index) {
    Side& side = sides_[index];
    Solved& light = lights_[side.light];
    if (setup->table && !light.covered_pixels) {
        light.covered_pixels = count_covered(*light.renderer->picture());
    }
    side.drive = path_->correct(index, setup, side.radiance, light.covered_pixels.value_or(0));
    side.to_measure = true;
}

void FrameLane::measure_side(std::size_t index) {
    Side& side = sides_[index];
    if (!std::exchange(side.to_measure, false)) return;
    const DrivePath::Measured measured = path_->measured(index);
    PlannedPass& pass = *find_pass(side.plan, PassKind::compensation);
    side.compensation = measured.stats;
    side.compensate_ms += measured.ms;
    pass.ms = pass.ms.value_or(0.0) + measured.ms;
}

void FrameLane::compose(const WantedFrame& frame) {
    auto pictures = std::make_shared<FramePictures>();
    Composed next;
    for (std::size_t side = 0; side < frame.sides(); ++side) {
        next.from[side] = sides_[side].drive;
        pictures->radiance[side] = sides_[side].radiance;
    }
    if (frame.wipe_to) {
        pictures->column = wipe_column(lights_[0].renderer->surface_map(), frame.wipe_at);
    }
    if (composed_.pictures && next.from == composed_.from &&
        pictures->column == composed_.pictures->column) {
        return;
    }
    pictures->drive = frame.wipe_to ? path_->join(next.from[0], next.from[1], pictures->column)
                                    : path_->show(next.from[0]);
    next.pictures = std::move(pictures);
    composed_ = std::move(next);
}

RadianceRenderer::Counters FrameLane::counters() const {
    RadianceRenderer::Counters sum;
    for (const Solved& light : lights_) {
        if (!light.renderer) continue;
        const RadianceRenderer::Counters one = light.renderer->counters();
        sum.programs += one.programs;
        sum.textures += one.textures;
        sum.passes_run += one.passes_run;
        sum.fragments_shaded += one.fragments_shaded;
    }
    sum.programs += path_->programs();
    sum.textures += path_->textures();
    return sum;
}

FramePlan FrameLane::told_plan(bool wiped) {
    FramePlan plan = sides_[0].plan;
    if (wiped) add_milliseconds(plan, sides_[1].plan, true);
    plan.passes.insert(plan.passes.end(), prepare_passes_.begin(), prepare_passes_.end());
    for (PlannedPass& pass : prepare_passes_) pass.ms = 0.0;
    return plan;
}

}  // namespace livery
