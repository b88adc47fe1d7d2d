#include "radiance/fragment_inputs.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "appearance/subsurface/translucent_paint.h"

namespace livery {
namespace {

/// Whether what was filtered of one serves the other: filters know neither rotation nor scale.
bool same_map(const std::shared_ptr<const Environment>& a,
              const std::shared_ptr<const Environment>& b) {
    if (a == b) return true;
    return a && b && a->radiance_working.width == b->radiance_working.width &&
           a->radiance_working.values == b->radiance_working.values;
}

/// What parts that only lamps light are mirrored before.
const std::shared_ptr<const Environment>& no_environment() {
    static const std::shared_ptr<const Environment> black = [] {
        auto environment = std::make_shared<Environment>();
        environment->radiance_working = ImageF(32, 16, 3, 0.0f);
        return environment;
    }();
    return black;
}

}  // namespace

FragmentRays rays_of(const EffectLevels& levels) {
    constexpr std::array kLight{0, 1, 16, 64};
    constexpr std::array<SkyRays, 4> kSky{
        {{0, 0, false}, {8, 0, true}, {16, 128, false}, {64, 256, false}}};
    constexpr std::array kMirror{kNoNodes, 0, 16, 24};
    constexpr std::array kBounces{0, 1, 16};
    const auto at = [&](const auto& table, Effect effect) {
        return table.at(static_cast<std::size_t>(levels[effect]));
    };
    const std::array<TransportDetail, 3> subsurface{{{}, {200, false}, {600, true}}};
    return {at(kLight, Effect::shadows),
            at(kSky, Effect::occlusion),
            at(kMirror, Effect::mirrored_environment),
            at(kBounces, Effect::interreflection),
            at(subsurface, Effect::subsurface)};
}

double StageClock::now_ms() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

FragmentInputs::FragmentInputs(const Mesh& mesh,
                               const Tracer& tracer,
                               std::shared_ptr<SharedExchange> exchange,
                               std::shared_ptr<SharedTransports> transports,
                               const View& view,
                               const SurfaceMap& map,
                               const PackedLayout& layout,
                               ShadingDevice device,
                               bool keep_better,
                               InputLayers::Precision light_precision)
    : mesh_(mesh),
      tracer_(tracer),
      shared_exchange_(std::move(exchange)),
      pixels_(pixel_size_of(view)),
      map_(&map),
      layout_(layout),
      device_(device),
      keep_better_(keep_better),
      light_precision_(light_precision),
      mirror_(mesh, tracer, map, layout),
      subsurface_(mesh, tracer, std::move(transports)) {}

void FragmentInputs::use(const SurfaceMap& map) {
    map_ = &map;
    lights_.clear();
    sky_visibility_.reset();
    sky_made_ = {};
    mirror_.use(map);
    subsurface_.clear();
    drop_exchange();
    runs_ = {};
    eye_.reset();
    directions_stale_ = sky_stale_ = diffuse_light_stale_ = places_stale_ = true;
}

const SmoothRuns& FragmentInputs::runs(Runs which) {
    // What a fragment mirrors is traced by its neighbours, of which columns would leave out half
    constexpr SmoothRuns::Limits kDragged{8, 4, 4.0, 4}, kRows{4, 1};
    std::optional<SmoothRuns>& of = runs_[static_cast<std::size_t>(which)];
    if (!of) {
        of.emplace(*map_,
                   which == Runs::dragged   ? kDragged
                   : which == Runs::of_rows ? kRows
                                            : SmoothRuns::Limits());
    }
    return *of;
}

void FragmentInputs::solve(const Scene& scene,
                           const FramePlan& plan,
                           StageClock& clock,
                           const Progress& progress,
                           bool keep_exchange) {
    solve_lights(scene, plan, clock, progress);
    solve_sky(scene, plan, clock, progress);
    solve_exchange(scene, plan, clock, progress, keep_exchange);
    solve_subsurface(scene, plan, clock, progress, keep_exchange);
    solve_mirror(scene, plan, clock, progress, keep_exchange);
}

void FragmentInputs::solve_lights(const Scene& scene,
                                  const FramePlan& plan,
                                  StageClock& clock,
                                  const Progress& progress) {
    const int rays = rays_of(plan.levels).light;
    std::size_t planned = 0;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const PassId pass = visibility_pass(i);
        const DirectionalLight& light = scene.lights[i];
        if (light.radiance_rec709 == glm::dvec3(0.0)) continue;
        const auto found = std::find_if(lights_.begin(), lights_.end(), [&](const Light& l) {
            return l.index == i && enough(l.rays, rays) && same_disc(l.light, light);
        });
        Light next{i, light, rays, {}};
        const bool stale = found == lights_.end();
        bool changed = stale || found != lights_.begin() + static_cast<std::ptrdiff_t>(planned);
        if (!stale) {
            changed = changed || found->light.radiance_rec709 != light.radiance_rec709;
            next.rays = found->rays;
            next.at = std::move(found->at);
            lights_.erase(found);
        }
        if (stale && rays == 0) next.at = unhidden_light(*map_, light);
        clock.run(pass, stale, [&] {
            next.at = light_at_fragments(mesh_,
                                         tracer_,
                                         *map_,
                                         runs(rays == 1 ? Runs::dragged : Runs::fine),
                                         light,
                                         rays,
                                         progress);
        });
        lights_.insert(lights_.begin() + static_cast<std::ptrdiff_t>(planned++), std::move(next));
        if (changed) directions_stale_ = diffuse_light_stale_ = true;
        if (changed) ++arriving_version_;
        if (changed && !subsurface_.empty()) sky_stale_ = true;
    }
    if (planned == lights_.size()) return;
    lights_.resize(planned);
    ++arriving_version_;
    directions_stale_ = diffuse_light_stale_ = true;
    if (!subsurface_.empty()) sky_stale_ = true;
}

void FragmentInputs::solve_sky(const Scene& scene,
                               const FramePlan& plan,
                               StageClock& clock,
                               const Progress& progress) {
    if (!find_pass(plan, PassKind::environment_irradiance)) {
        if (sky_made_.of) {
            sky_stale_ = diffuse_light_stale_ = true;
            ++arriving_version_;
        }
        sky_made_ = {};
        diffused_ = nullptr;
        filtered_.diffuse = filtered_.blurred = filtered_.hardly_blurred = {};
        sky_.clear();
        return;
    }
    const bool occluded = find_pass(plan, PassKind::ambient_occlusion) != nullptr;
    const SkyRays sky_rays = rays_of(plan.levels).sky;
    const int rays = occluded ? sky_rays.first : 0;
    const bool stands = sky_made_.of == scene.environment && enough(sky_made_.rays, rays);
    const bool visible =
        !occluded || stands || (sky_visibility_ && enough(sky_visibility_->rays.first, rays));
    clock.run(PassKind::ambient_occlusion, !visible, [&] {
        sky_visibility_ =
            solve_sky_visibility(mesh_, tracer_, *map_, runs(Runs::fine), sky_rays, progress);
    });
    clock.run(PassKind::environment_irradiance, !stands, [&] {
        if (!same_map(diffused_, scene.environment)) {
            FilteredEnvironment filtered =
                filter_environment(*scene.environment, {false, true, true, false}, progress);
            filtered_.diffuse = std::move(filtered.diffuse);
            filtered_.blurred = std::move(filtered.blurred);
            filtered_.hardly_blurred = std::move(filtered.hardly_blurred);
        }
        diffused_ = scene.environment;
        sky_ = sky_at_fragments(mesh_,
                                *map_,
                                *scene.environment,
                                filtered_,
                                occluded ? &*sky_visibility_ : nullptr,
                                sky_rays.joints_only ? Hidden::share : Hidden::light,
                                runs(Runs::dragged));
        const bool draft = !occluded || sky_rays.joints_only;
        sky_made_ = {scene.environment, draft ? rays : sky_visibility_->rays.first};
        ++arriving_version_;
        sky_stale_ = diffuse_light_stale_ = true;
    });
}

void FragmentInputs::drop_exchange() {
    exchanged_.at_nodes = {};
    exchanged_.on_diffuser.clear();
    ++exchanged_.version;
    sky_stale_ = diffuse_light_stale_ = true;
}

void FragmentInputs::solve_exchange(const Scene& scene,
                                    const FramePlan& plan,
                                    StageClock& clock,
                                    const Progress& progress,
                                    bool keep) {
    Exchanged& made = exchanged_;
    if (!find_pass(plan, PassKind::interreflection)) {
        if (!made.on_diffuser.empty() && !keep) drop_exchange();
        return;
    }
    const auto environment =
        find_pass(plan, PassKind::environment_irradiance) ? scene.environment : nullptr;
    const bool same_light = !made.direct.on_diffuser.empty() && made.lights == scene.lights &&
                            made.environment == environment;
    const int bounces = rays_of(plan.levels).bounces;
    const bool same_paints =
        same_relief(made.artwork, scene.artwork) && std::equal(made.paints.begin(),
                                                               made.paints.end(),
                                                               scene.part_materials.begin(),
                                                               scene.part_materials.end(),
                                                               same_reflectance);
    const bool stands = keep || (same_light && !made.on_diffuser.empty() && same_paints &&
                                 enough(made.bounces, bounces));
    clock.run(PassKind::interreflection, !stands, [&] {
        made.nodes = shared_exchange_->of(mesh_, tracer_, progress);
        if (!same_paints) {
            made.paints.clear();  // a stop leaves neither
            made.reflectance =
                reflectance_at_nodes(scene, made.nodes->nodes, made.nodes->directions);
        }
        const NodeReflectance& reflectance = made.reflectance;
        if (!same_light || made.lobes != reflectance.lobes) {
            made.direct = direct_light_at_nodes(mesh_,
                                                tracer_,
                                                *made.nodes,
                                                scene.lights,
                                                environment.get(),
                                                filtered_,
                                                reflectance.lobes,
                                                progress);
            made.lobes = reflectance.lobes;
            made.lights = scene.lights;
            made.environment = environment;
        }
        made.at_nodes = exchanged_at_nodes(*made.nodes, made.direct, reflectance, bounces);
        made.on_diffuser = at_fragments(mesh_, *map_, made.nodes->nodes, made.at_nodes.on_diffuser);
        made.paints = scene.part_materials;
        made.artwork = scene.artwork;
        made.bounces = bounces;
        ++made.version;
        sky_stale_ = diffuse_light_stale_ = true;
    });
}

void FragmentInputs::solve_subsurface(const Scene& scene,
                                      const FramePlan& plan,
                                      StageClock& clock,
                                      const Progress& progress,
                                      bool keep) {
    if (!find_pass(plan, PassKind::subsurface)) {
        if (subsurface_.clear()) sky_stale_ = true;
        return;
    }
    SubsurfaceInputs::Wanted wanted;
    wanted.detail = rays_of(plan.levels).subsurface;
    wanted.lights = scene.lights;
    if (find_pass(plan, PassKind::environment_irradiance)) wanted.environment = scene.environment;
    wanted.exchange_version = exchanged_.version;
    wanted.arriving_version = arriving_version_;
    for (const Material& paint : scene.part_materials) {
        const bool translucent = paint.model == ReflectanceModel::translucent;
        wanted.media.push_back(
            translucent ? std::optional(on_mock_up(*paint.medium, scene.product->product_scale))
                        : std::nullopt);
    }
    if (keep) {
        // Who cannot wait for light that spreads has it leave where it enters meanwhile
        if (subsurface_.use_what_stands(wanted)) sky_stale_ = true;
        clock.run(PassKind::subsurface, false, [] {});
        return;
    }
    clock.run(PassKind::subsurface, !subsurface_.stands(wanted), [&] {
        subsurface_.solve(
            wanted,
            *map_,
            pixels_,
            [&](std::size_t i, const EnteredMedium& medium, float share, float curvature_per_mm) {
                return entering_at(i, medium, share, curvature_per_mm);
            },
            filtered_,
            exchanged_.at_nodes.on_diffuser.empty() ? nullptr : exchanged_.nodes,
            exchanged_.at_nodes.on_diffuser,
            progress);
        sky_stale_ = true;
    });
}

bool FragmentInputs::mirror_filtered(const std::shared_ptr<const Environment>& environment,
                                     int nodes) const {
    return same_map(nodes == kNoNodes ? look_up_of_ : layered_, environment);
}

void FragmentInputs::filter_for_mirror(const std::shared_ptr<const Environment>& environment,
                                       int nodes,
                                       const Progress& progress) {
    if (nodes == kNoNodes) {
        mirror_look_up_.emplace(
            filter_environment(*environment, {true, false, false, false}, progress));
        look_up_of_ = environment;
        return;
    }
    filtered_.gaussians =
        filter_environment(*environment, {false, false, false, true}, progress).gaussians;
    layered_ = environment;
}

void FragmentInputs::solve_mirror(const Scene& scene,
                                  const FramePlan& plan,
                                  StageClock& clock,
                                  const Progress& progress,
                                  bool keep_exchange) {
    // A scene whose paints do not mirror keeps what the next one may; one without anything to not.
    const bool ahead = find_pass(plan, mirrored_ahead_pass()) != nullptr;
    const bool sky = find_pass(plan, PassKind::environment_irradiance) != nullptr;
    if (!ahead && !find_pass(plan, PassKind::mirrored_environment)) {
        if (sky || parts_send_light(plan)) return;
        mirror_.clear();
        layered_ = look_up_of_ = nullptr;
        filtered_.gaussians.clear();
        mirror_look_up_.reset();
        return;
    }
    // Without what hides it, nothing is known of what other parts send into a mirror either
    const bool hides = plan.levels[Effect::reflected_occlusion] > 0;
    const int nodes = rays_of(plan.levels).mirror;
    const std::shared_ptr<const Environment>& environment =
        sky ? scene.environment : no_environment();
    const auto any = [](const MirrorInputs::LayersOfParts& layers) {
        return std::any_of(layers.begin(), layers.end(), [](const auto& of) { return of.any(); });
    };
    mirror_.hide_behind(exchanged_.at_nodes.sent.empty() ? nullptr : exchanged_.nodes,
                        exchanged_.at_nodes.sent,
                        exchanged_.version);
    MirrorInputs::Light light{
        environment, scene.eye_in_world_mm, hides ? nodes : std::min(nodes, 0)};
    // Who keeps light between parts, or drags a lamp, draws with what was mirrored behind other
    // light of it, too
    const bool draft = light.nodes == kNoNodes;
    const auto missing_in = [&](const MirrorInputs::Light& in) {
        return mirror_.missing(in, mirror_layers_of(scene, in.mixing()), !keep_exchange && !draft);
    };
    const MirrorInputs::Light& made = mirror_.light();
    if (made.environment == light.environment && made.eye_mm == light.eye_mm &&
        enough(made.nodes, light.nodes)) {
        const MirrorInputs::Light better{light.environment, light.eye_mm, made.nodes};
        // What is dragged does not wait for what better light lacks
        if (!draft || !any(missing_in(better))) light = better;
    }
    const auto worn = missing_in(light);
    const auto solve_layers = [&](const MirrorInputs::LayersOfParts& layers) {
        const SkyVisibility* joints = sky_visibility_ ? &*sky_visibility_ : nullptr;
        if (light.nodes == kNoNodes) {
            mirror_.look_up(light, layers, *mirror_look_up_, runs(Runs::dragged), joints, progress);
        } else {
            mirror_.solve(light, layers, filtered_, runs(Runs::fine), joints, progress);
        }
    };
    const bool filtered = mirror_filtered(environment, light.nodes);
    if (filtered) (light.nodes == kNoNodes ? look_up_of_ : layered_) = environment;
    clock.run(PassKind::environment_filter, !filtered, [&] {
        filter_for_mirror(environment, light.nodes, progress);
    });
    clock.run(PassKind::reflection_occlusion, mirror_.lacks_visibility(light, worn), [&] {
        mirror_.trace(light, worn, runs(Runs::of_rows), progress);
    });
    clock.run(PassKind::mirrored_environment, any(worn), [&] { solve_layers(worn); });
    if (!ahead) return;
    const auto others = mirror_.missing(
        light,
        MirrorInputs::LayersOfParts(scene.part_materials.size(), MirrorLayers().set()),
        false);
    const bool drag_ready = mirror_filtered(environment, kNoNodes) &&
                            runs_[static_cast<std::size_t>(Runs::dragged)].has_value();
    clock.run(mirrored_ahead_pass(), any(others) || !drag_ready, [&] {
        if (any(others)) {
            if (!mirror_filtered(environment, light.nodes))
                filter_for_mirror(environment, light.nodes, progress);
            if (mirror_.lacks_visibility(light, others))
                mirror_.trace(light, others, runs(Runs::of_rows), progress);
            solve_layers(others);
        }
        // The first step of a drag looks up what is filtered already
        if (!mirror_filtered(environment, kNoNodes))
            filter_for_mirror(environment, kNoNodes, progress);
        runs(Runs::dragged);
    });
}

SolvedMirror FragmentInputs::mirrored() const {
    SolvedMirror solved{mirror_.light().mixing(), {}};
    solved.of_part.assign(mesh_.parts.size(), MirrorLayers().set());
    const auto missing = mirror_.missing(mirror_.light(), solved.of_part, false);
    for (std::size_t p = 0; p < missing.size(); ++p) solved.of_part[p] &= ~missing[p];
    return solved;
}

}  // namespace livery
