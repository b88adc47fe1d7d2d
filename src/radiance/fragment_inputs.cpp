#include "radiance/fragment_inputs.h"

#include <algorithm>
#include <utility>

#include "appearance/subsurface/translucent_paint.h"
#include "radiance/renderer.h"

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

bool FragmentInputs::PaintsFrom::operator==(const PaintsFrom& other) const {
    return same_relief(artwork, other.artwork) && std::equal(paints.begin(),
                                                             paints.end(),
                                                             other.paints.begin(),
                                                             other.paints.end(),
                                                             same_reflectance);
}

FragmentInputs::FragmentInputs(const FrameGeometry& geometry,
                               const PackedLayout& layout,
                               ShadingDevice device,
                               bool keep_better,
                               InputLayers::Precision light_precision)
    : mesh_(geometry.product->mesh),
      tracer_(*geometry.tracer),
      shared_exchange_(geometry.exchange),
      pixels_(pixel_size_of(geometry.view)),
      map_(&geometry.map),
      layout_(layout),
      device_(device),
      keep_better_(keep_better),
      light_precision_(light_precision),
      mirror_(mesh_, tracer_, geometry.map, layout),
      subsurface_(mesh_, tracer_, geometry.transports) {}

void FragmentInputs::use(const SurfaceMap& map) {
    map_ = &map;
    ++map_version_;
    lights_.clear();
    ++lights_version_;
    sky_visibility_.reset();
    sky_.drop();
    mirror_.use(map);
    subsurface_.clear();
    exchanged_.drop();
    runs_ = {};
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
    const Solve now{scene, plan, clock, progress, keep_exchange};
    solve_lights(now);
    solve_sky(now);
    solve_exchange(now);
    solve_subsurface(now);
    solve_mirror(now);
}

void FragmentInputs::solve_lights(const Solve& now) {
    const int rays = now.rays.light;
    std::size_t planned = 0;
    for (std::size_t i = 0; i < now.scene.lights.size(); ++i) {
        const DirectionalLight& light = now.scene.lights[i];
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
        now.clock.run(visibility_pass(i), stale, [&] {
            next.at = light_at_fragments(mesh_,
                                         tracer_,
                                         *map_,
                                         runs(rays == 1 ? Runs::dragged : Runs::fine),
                                         light,
                                         rays,
                                         now.progress);
        });
        lights_.insert(lights_.begin() + static_cast<std::ptrdiff_t>(planned++), std::move(next));
        if (changed) ++lights_version_;
    }
    if (planned == lights_.size()) return;
    lights_.resize(planned);
    ++lights_version_;
}

void FragmentInputs::solve_sky(const Solve& now) {
    if (!now.plans(PassKind::environment_irradiance)) {
        sky_.drop();
        diffused_ = nullptr;
        filtered_.diffuse = filtered_.blurred = filtered_.hardly_blurred = {};
        return;
    }
    const auto& environment = now.scene.environment;
    const bool occluded = now.plans(PassKind::ambient_occlusion);
    const SkyRays sky_rays = now.rays.sky;
    const int rays = occluded ? sky_rays.first : 0;
    const bool stands =
        sky_.from && sky_.from->environment == environment && enough(sky_.from->rays, rays);
    const bool visible =
        !occluded || stands || (sky_visibility_ && enough(sky_visibility_->rays.first, rays));
    now.clock.run(PassKind::ambient_occlusion, !visible, [&] {
        sky_visibility_ =
            solve_sky_visibility(mesh_, tracer_, *map_, runs(Runs::fine), sky_rays, now.progress);
    });
    now.clock.run(PassKind::environment_irradiance, !stands, [&] {
        if (!same_map(diffused_, environment)) {
            FilteredEnvironment filtered =
                filter_environment(*environment, {false, true, true, false}, now.progress);
            filtered_.diffuse = std::move(filtered.diffuse);
            filtered_.blurred = std::move(filtered.blurred);
            filtered_.hardly_blurred = std::move(filtered.hardly_blurred);
        }
        diffused_ = environment;
        const bool draft = !occluded || sky_rays.joints_only;
        sky_.take({environment, draft ? rays : sky_visibility_->rays.first},
                  sky_at_fragments(mesh_,
                                   *map_,
                                   *environment,
                                   filtered_,
                                   occluded ? &*sky_visibility_ : nullptr,
                                   sky_rays.joints_only ? Hidden::share : Hidden::light,
                                   runs(Runs::dragged)));
    });
}

void FragmentInputs::solve_exchange(const Solve& now) {
    if (!now.plans(PassKind::interreflection)) {
        if (!now.keep_exchange) exchanged_.drop();
        return;
    }
    DirectFrom light{now.scene.lights, nullptr, reflectance_.value.lobes};
    if (now.plans(PassKind::environment_irradiance)) light.environment = now.scene.environment;
    PaintsFrom paints{now.scene.part_materials, now.scene.artwork};
    const int bounces = now.rays.bounces;
    const auto stands = [&] {
        return exchanged_.from && direct_.is_from(light) && reflectance_.is_from(paints) &&
               exchanged_.from->direct == direct_.version &&
               exchanged_.from->reflectance == reflectance_.version &&
               enough(exchanged_.from->bounces, bounces);
    };
    now.clock.run(PassKind::interreflection, !now.keep_exchange && !stands(), [&] {
        nodes_ = shared_exchange_->of(mesh_, tracer_, now.progress);
        if (!reflectance_.is_from(paints)) {
            reflectance_.take(std::move(paints),
                              reflectance_at_nodes(now.scene, nodes_->nodes, nodes_->directions));
        }
        const NodeReflectance& reflectance = reflectance_.value;
        light.lobes = reflectance.lobes;
        if (!direct_.is_from(light)) {
            DirectLight direct = direct_light_at_nodes(mesh_,
                                                       tracer_,
                                                       *nodes_,
                                                       light.lights,
                                                       light.environment.get(),
                                                       filtered_,
                                                       light.lobes,
                                                       now.progress);
            direct_.take(std::move(light), std::move(direct));
        }
        Exchanged exchanged;
        exchanged.at_nodes = exchanged_at_nodes(*nodes_, direct_.value, reflectance, bounces);
        exchanged.on_diffuser =
            at_fragments(mesh_, *map_, nodes_->nodes, exchanged.at_nodes.on_diffuser);
        exchanged_.take({direct_.version, reflectance_.version, bounces}, std::move(exchanged));
    });
}

void FragmentInputs::solve_subsurface(const Solve& now) {
    if (!now.plans(PassKind::subsurface)) {
        subsurface_.clear();
        return;
    }
    SubsurfaceInputs::Wanted wanted;
    wanted.detail = now.rays.subsurface;
    wanted.lights = now.scene.lights;
    if (now.plans(PassKind::environment_irradiance)) wanted.environment = now.scene.environment;
    wanted.exchange_version = exchanged_.version;
    wanted.arriving_version = lights_version_ + sky_.version;
    for (const Material& paint : now.scene.part_materials) {
        const bool translucent = paint.model == ReflectanceModel::translucent;
        wanted.media.push_back(
            translucent ? std::optional(on_mock_up(*paint.medium, now.scene.product->product_scale))
                        : std::nullopt);
    }
    if (now.keep_exchange) {
        // Who cannot wait for light that spreads has it leave where it enters meanwhile
        subsurface_.use_what_stands(wanted);
        now.clock.run(PassKind::subsurface, false, [] {});
        return;
    }
    now.clock.run(PassKind::subsurface, !subsurface_.stands(wanted), [&] {
        const std::vector<glm::vec3>& between = exchanged_.value.at_nodes.on_diffuser;
        subsurface_.solve(
            wanted,
            *map_,
            pixels_,
            [&](std::size_t i, const EnteredMedium& medium, float share, float curvature_per_mm) {
                return entering_at(i, medium, share, curvature_per_mm);
            },
            filtered_,
            between.empty() ? nullptr : nodes_,
            between,
            now.progress);
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

void FragmentInputs::solve_mirror(const Solve& now) {
    const Scene& scene = now.scene;
    const FramePlan& plan = now.plan;
    const Progress& progress = now.progress;
    // A scene whose paints do not mirror keeps what the next one may; one without anything to not.
    const bool ahead = now.plans(mirrored_ahead_pass());
    const bool sky = now.plans(PassKind::environment_irradiance);
    if (!ahead && !now.plans(PassKind::mirrored_environment)) {
        if (sky || parts_send_light(plan)) return;
        mirror_.clear();
        layered_ = look_up_of_ = nullptr;
        filtered_.gaussians.clear();
        mirror_look_up_.reset();
        return;
    }
    // Without what hides it, nothing is known of what other parts send into a mirror either
    const bool hides = plan.levels[Effect::reflected_occlusion] > 0;
    const int nodes = now.rays.mirror;
    const std::shared_ptr<const Environment>& environment =
        sky ? scene.environment : no_environment();
    const auto any = [](const MirrorInputs::LayersOfParts& layers) {
        return std::any_of(layers.begin(), layers.end(), [](const auto& of) { return of.any(); });
    };
    const NodeLight& sent = exchanged_.value.at_nodes.sent;
    mirror_.hide_behind(sent.empty() ? nullptr : nodes_, sent, exchanged_.version);
    MirrorInputs::Light light{
        environment, scene.eye_in_world_mm, hides ? nodes : std::min(nodes, 0)};
    // Who keeps light between parts, or drags a lamp, draws with what was mirrored behind other
    // light of it, too
    const bool draft = light.nodes == kNoNodes;
    const auto missing_in = [&](const MirrorInputs::Light& in) {
        return mirror_.missing(
            in, mirror_layers_of(scene, in.mixing()), !now.keep_exchange && !draft);
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
    now.clock.run(PassKind::environment_filter, !filtered, [&] {
        filter_for_mirror(environment, light.nodes, progress);
    });
    now.clock.run(PassKind::reflection_occlusion, mirror_.lacks_visibility(light, worn), [&] {
        mirror_.trace(light, worn, runs(Runs::of_rows), progress);
    });
    now.clock.run(PassKind::mirrored_environment, any(worn), [&] { solve_layers(worn); });
    if (!ahead) return;
    const auto others = mirror_.missing(
        light,
        MirrorInputs::LayersOfParts(scene.part_materials.size(), MirrorLayers().set()),
        false);
    const bool drag_ready = mirror_filtered(environment, kNoNodes) &&
                            runs_[static_cast<std::size_t>(Runs::dragged)].has_value();
    now.clock.run(mirrored_ahead_pass(), any(others) || !drag_ready, [&] {
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
