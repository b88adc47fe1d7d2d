#include "live/frame_lane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <set>
#include <span>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "appearance/material_library.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
#include "core/error.h"
#include "core/parallel.h"
#include "jobs/picture.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

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

bool mirrors(const Scene& scene) {
    return any_paint(scene,
                     [](const Material& paint) { return model_info(paint.model).mirrors(); });
}

template <typename T>
bool all_same(const std::vector<T>& a, const std::vector<T>& b, bool (*same)(const T&, const T&)) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

const Scene& side_of(const FrameDescription& description, std::size_t side) {
    return side == 0 ? description.scene : *description.wipe_to;
}

std::size_t side_count(const FrameDescription& description) { return description.wipe_to ? 2 : 1; }

template <typename T>
void copy_columns(const Image<T>& from, int begin, int end, Image<T>* to) {
    if (begin >= end) return;
    for (int y = 0; y < from.height; ++y) {
        const T* row = from.pixel(0, y);
        std::copy(row + begin * from.channels, row + end * from.channels, to->pixel(begin, y));
    }
}

template <typename T>
void join(const Image<T>& left, const Image<T>& right, int column, Image<T>* joined) {
    if (joined->width != left.width || joined->height != left.height ||
        joined->channels != left.channels) {
        *joined = Image<T>(left.width, left.height, left.channels);
    }
    copy_columns(left, 0, column, joined);
    copy_columns(right, column, right.width, joined);
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
        if (newest_ && same_pose({newest_->product, newest_->view, {}, {}, {}, {}}, key)) {
            known = newest_;
        }
    }
    const int sub_samples = sub_samples_of(key.quality);
    if (known && known->map.samples_per_pixel >= sub_samples) return known;
    auto made =
        known ? std::make_shared<const FrameGeometry>(*known, sub_samples, progress)
              : std::make_shared<const FrameGeometry>(key.product, key.view, progress, sub_samples);
    const std::scoped_lock lock(mutex_);
    newest_ = made;
    return made;
}

FrameLane::FrameLane(std::shared_ptr<GeometryCache> geometries, ShadingDevice device)
    : geometries_(std::move(geometries)), device_(device) {}

void FrameLane::solve(const FrameDescription& description,
                      Quality quality,
                      std::optional<Urgency> urgency,
                      const Progress& progress) {
    SolveKeys keys = with_quality(keys_of(description), quality);
    if (keys[1] && same_light(*keys[0], *keys[1])) keys[1].reset();
    solved_ = {};
    prepared_ = mirrors_solved_ = false;
    sides_ = {};
    solve_light(0, description.scene, *keys[0], urgency, progress);
    bool mirroring = mirrors(description.scene);
    if (keys[1]) {
        solve_light(1, *description.wipe_to, *keys[1], urgency, progress);
        mirroring = mirroring && mirrors(*description.wipe_to);
    } else {
        lights_[1] = {};
    }
    mirrors_solved_ = mirroring || (!keys[0]->environment && (!keys[1] || !keys[1]->environment));
    solved_ = std::move(keys);
}

void FrameLane::solve_light(std::size_t index,
                            const Scene& scene,
                            const SolveKey& key,
                            std::optional<Urgency> urgency,
                            const Progress& progress) {
    Solved& light = lights_[index];
    FramePlan plan = plan_frame(scene, key.quality, FrameStage::projector);
    const auto serves = [&](const FrameGeometry& geometry) {
        return same_pose({geometry.product, geometry.view, {}, {}, {}, {}}, key) &&
               geometry.map.samples_per_pixel >= sub_samples_of(key.quality);
    };
    if (!light.renderer || !serves(*light.renderer->geometry())) {
        light = {};
        std::shared_ptr<const FrameGeometry> geometry;
        run_giving_way(urgency, [&] { geometry = geometries_->get(key, progress); });
        light.renderer = std::make_unique<RadianceRenderer>(std::move(geometry), true, device_);
    }
    run_giving_way(urgency, [&] { light.renderer->solve(scene, plan, progress); });
    if (light.untold) add_milliseconds(plan, *light.untold, false);
    light.untold = std::move(plan);
}

void FrameLane::prepare(const FrameDescription& description, const Progress& progress) {
    std::vector<PlannedPass> passes;
    std::set<ProgramOf> programs = programs_likely_next(description.library.get());
    for (std::size_t side = 0; side < side_count(description); ++side) {
        any_paint(side_of(description, side), [&](const Material& paint) {
            programs.emplace(paint);
            return false;
        });
    }
    for (const ProgramOf& program : programs) {
        const auto start = Clock::now();
        bool used = false;
        for (std::size_t side = 0; side < side_count(description); ++side) {
            Scene scene = scene_of(description, side);
            for (Material& paint : scene.part_materials) {
                used = used || ProgramOf(paint) == program;
                paint = plain_paint(program);
            }
            const std::size_t index = nearest_of(solved_, keys_of(description), side);
            RadianceRenderer& renderer = *lights_[index].renderer;
            FramePlan plan = plan_frame(scene, solved_[index]->quality, FrameStage::projector);
            run_giving_way(Urgency::background, [&] { renderer.solve(scene, plan, progress); });
            renderer.prepare(scene, plan, progress);
        }
        if (used) continue;
        PlannedPass& pass = passes.emplace_back();
        const ModelInfo& model = model_info(program.model);
        pass.id = {PassKind::prepare, "", program.model, program.glints};
        pass.why = fmt::format("{}{} may be next: made ready ahead",
                               model.in_words,
                               program.glints ? " and glints" : "");
        pass.ms = milliseconds_since(start);
    }
    prepare_passes_ = std::move(passes);
    prepared_ = mirrors_solved_ = true;
}

bool FrameLane::can_draw(const FrameDescription& description) const {
    if (!solved_[0]) return false;
    const SolveKeys keys = keys_of(description);
    for (std::size_t side = 0; side < side_count(description); ++side) {
        if (!same_pose(*solved_[0], *keys[side])) return false;
        if (!mirrors_solved_ && mirrors(side_of(description, side))) return false;
    }
    return true;
}

Scene FrameLane::scene_of(const FrameDescription& description, std::size_t side) const {
    Scene scene = side_of(description, side);
    const SolveKey& light = *solved_[nearest_of(solved_, keys_of(description), side)];
    scene.environment = light.environment;
    scene.lights = light.lights;
    scene.eye_in_world_mm = light.eye_mm;
    scene.relief = light.relief;
    if (const auto part = description.glowing_part) {
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

void FrameLane::draw_ahead(const FrameDescription& description) {
    draw_picture(description);
    for (Side& side : sides_) side.told = false;
}

std::shared_ptr<FinishedFrame> FrameLane::draw(const FrameDescription& description) {
    std::shared_ptr<FinishedFrame> frame = draw_picture(description);
    frame->plan = told_plan(description.wipe_to.has_value());
    return frame;
}

std::shared_ptr<FinishedFrame> FrameLane::draw_picture(const FrameDescription& description) try {
    const auto start = Clock::now();
    check_argument(can_draw(description), "this frame's light was not solved");
    auto frame = std::make_shared<FinishedFrame>();
    for (std::size_t side = 0; side < side_count(description); ++side) {
        const bool ahead = !sides_[side].told;
        draw_side(description, side);
        frame->shade_ms += sides_[side].shade_ms;
        frame->compensate_ms += sides_[side].compensate_ms;
        if (ahead) frame->ms_total += sides_[side].shade_ms + sides_[side].compensate_ms;
    }
    compose(description);
    frame->number = description.number;
    frame->drive_texture = composed_.slot->texture.name();
    frame->ready = {composed_.slot, &composed_.slot->ready};
    frame->owner = composed_.slot;
    frame->drive = composed_.drive;
    frame->radiance_working = composed_.radiance_working;
    frame->compensation = sides_[0].compensation;
    frame->asked_at = description.asked_at;
    frame->ms_total += milliseconds_since(start);
    frame->done_at = Clock::now();
    return frame;
} catch (const std::invalid_argument&) {
    throw;
} catch (...) {
    // What OpenGL or the memory refused in the middle leaves nothing to build on.
    lights_ = {};
    solved_ = {};
    sides_ = {};
    composed_ = {};
    prepared_ = mirrors_solved_ = false;
    throw;
}

void FrameLane::draw_side(const FrameDescription& description, std::size_t index) {
    Side& side = sides_[index];
    const Scene scene = scene_of(description, index);
    const std::size_t light = nearest_of(solved_, keys_of(description), index);
    const bool painted = side.radiance_working &&
                         all_same(side.paints, scene.part_materials, same_reflectance) &&
                         all_same(side.artwork, scene.artwork, looks_alike) &&
                         side.exposure_ev == scene.exposure_ev && side.light == light;
    const bool ahead = !std::exchange(side.told, true);
    if (ahead && painted && side.setup == description.setup) return;
    FramePlan plan = plan_frame(scene, solved_[light]->quality, FrameStage::projector);
    for (PlannedPass& pass : plan.passes) pass.ms = 0.0;
    if (ahead) {
        add_milliseconds(plan, side.plan, false);
    } else {
        side.shade_ms = side.compensate_ms = 0.0;
    }
    side.plan = std::move(plan);
    if (!painted) {
        side.radiance_working = nullptr;
        const auto start = Clock::now();
        RadianceRenderer& renderer = *lights_[light].renderer;
        FramePlan drawn = plan_frame(scene, solved_[light]->quality, FrameStage::projector);
        renderer.render(scene, drawn);
        auto radiance = renderer.picture();
        side.shade_ms += milliseconds_since(start);
        add_milliseconds(drawn, side.plan, false);
        side.plan = std::move(drawn);
        side.radiance_working = std::move(radiance);
        side.paints = scene.part_materials;
        side.artwork = scene.artwork;
        side.exposure_ev = scene.exposure_ev;
        side.light = light;
        if (auto& untold = lights_[light].untold) {
            add_milliseconds(side.plan, *untold, false);
            untold.reset();
        }
    }
    if (painted && side.setup == description.setup) return;
    side.setup = nullptr;  // until it worked
    compensate_side(description.setup, side);
    side.setup = description.setup;
}

void FrameLane::compensate_side(const std::shared_ptr<const ProjectorSetup>& setup, Side& side) {
    const auto start = Clock::now();
    std::shared_ptr<Image8> drive;
    PlannedPass& pass = *find_pass(side.plan, PassKind::compensation);
    side.compensation = {};
    if (setup->table) {
        // On the processor: quicker than OpenGL in software, and it counts what is out of the
        // gamut, which the OpenGL pass does not.
        if (corrected_.of != setup) corrected_ = {setup, std::make_unique<Recycler<Image8>>()};
        drive = corrected_.pictures->take();
        std::optional<std::size_t>& covered = lights_[side.light].covered_pixels;
        if (!covered) covered = count_covered(*side.radiance_working);
        compensate_again(
            *setup->table, *side.radiance_working, *covered, drive.get(), &side.compensation);
        pass.work_items = static_cast<double>(setup->table->pixels.size());
    } else {
        drive = drives_.take();
        srgb_from_working_into(*side.radiance_working, drive.get());
        pass.why = "without a calibration the frame goes out as sRGB";
        pass.work_items = static_cast<double>(drive->pixel_count());
    }
    side.drive = std::move(drive);
    const double ms = milliseconds_since(start);
    side.compensate_ms += ms;
    pass.ms = pass.ms.value_or(0.0) + ms;
}

void FrameLane::compose(const FrameDescription& description) {
    Composed next;
    next.from[0] = sides_[0].drive;
    if (description.wipe_to) {
        next.from[1] = sides_[1].drive;
        next.column = wipe_column(lights_[0].renderer->surface_map(), description.wipe_at);
    }
    if (composed_.slot && next.from == composed_.from && next.column == composed_.column) return;
    if (description.wipe_to) {
        auto drive = drives_.take();
        join(*sides_[0].drive, *sides_[1].drive, next.column, drive.get());
        auto radiance = radiances_.take();
        join(*sides_[0].radiance_working, *sides_[1].radiance_working, next.column, radiance.get());
        next.drive = std::move(drive);
        next.radiance_working = std::move(radiance);
    } else {
        next.drive = sides_[0].drive;
        next.radiance_working = sides_[0].radiance_working;
    }
    next.slot = upload(*next.drive);
    composed_ = std::move(next);
}

std::shared_ptr<const TexturePool::Slot> FrameLane::upload(const Image8& drive) {
    rgba_.resize(4 * drive.pixel_count(), 255);
    const std::uint8_t* from = drive.values.data();
    std::uint8_t* to = rgba_.data();
    parallel_for(drive.pixel_count(), 65536, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t c = 0; c < 3; ++c) to[4 * i + c] = from[3 * i + c];
        }
    });
    auto slot = textures_.lend(drive.width, drive.height);
    slot->texture.upload(std::span<const std::uint8_t>(rgba_));
    slot->ready = Fence::after_everything_so_far();
    return slot;
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
