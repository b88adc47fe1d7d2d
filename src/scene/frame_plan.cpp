#include "scene/frame_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "appearance/model_table.h"
#include "appearance/paint_bsdf.h"
#include "core/colour.h"
#include "core/error.h"
#include "scene/subsurface_reach.h"

namespace livery {
namespace {

void plan_pass(FramePlan& plan, PassId id, std::string why) {
    PlannedPass& pass = plan.passes.emplace_back();
    pass.id = std::move(id);
    pass.why = std::move(why);
}

bool is_black(const glm::dvec3& colour) { return colour == glm::dvec3(0.0); }

std::string degrees(double angle_rad) {
    return fmt::format("{:.3g}°", angle_rad * 180.0 / std::numbers::pi);
}

bool any_light(const Scene& scene) {
    return std::any_of(scene.lights.begin(), scene.lights.end(), [](const DirectionalLight& light) {
        return !is_black(light.radiance_rec709);
    });
}

/// Light from all around meets flakes of every slope: single ones are not seen.
bool draws_glints(const Scene& scene, const Material& material) {
    return has_glints(material) && any_light(scene);
}

/// What the passes depend on, read off the scene once.
struct Needs {
    bool environment = false;
    std::set<ReflectanceModel> models;
    std::set<std::string> sided_parts;   ///< that look different from different sides
    std::set<std::string> mirror_parts;  ///< that mirror the environment
};

Needs needs_of(const Scene& scene) {
    Needs needs;
    needs.environment = scene.environment && !scene.environment->radiance_working.empty() &&
                        scene.environment->scale != 0.0;
    const auto add = [&](const Material& material, std::size_t part) {
        const ModelInfo& model = model_info(material.model);
        const std::string& name = scene.product->mesh.parts[part].name;
        needs.models.insert(model.model);
        if (!model.same_from_all_sides) needs.sided_parts.insert(name);
        if (model.mirrors()) needs.mirror_parts.insert(name);
    };
    for (std::size_t i = 0; i < scene.part_materials.size(); ++i) add(scene.part_materials[i], i);
    for (const PartArtwork& artwork : scene.artwork) add(artwork.material, artwork.part);
    return needs;
}

void plan_lights(const Scene& scene, FramePlan& plan) {
    const int level = plan.levels[Effect::shadows];
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const DirectionalLight& light = scene.lights[i];
        const std::string name = light_name(i);
        const PassId pass = visibility_pass(i);
        if (is_black(light.radiance_rec709)) {
            plan.skipped.push_back({pass, fmt::format("the {} light is black", name)});
        } else if (level == 0) {
            plan.skipped.push_back(
                {pass, fmt::format("the {} light is drawn without shadows", name)});
        } else if (light.angle_rad <= 0.0) {
            plan_pass(
                plan, pass, fmt::format("the look has a {} light, a point: sharp shadows", name));
        } else {
            plan_pass(
                plan,
                pass,
                fmt::format("the look has a {} light {} wide{}",
                            name,
                            degrees(light.angle_rad),
                            level == 1 ? "; draft shows its shadows sharp" : ": soft shadows"));
        }
    }
    if (scene.lights.empty()) plan.skipped.push_back({visibility_pass(0), "the look has no light"});
}

constexpr std::array kMirrorPasses{
    PassKind::environment_filter, PassKind::reflection_occlusion, PassKind::mirrored_environment};

/// `what` parts mirror: "the environment".
void plan_mirrors(const Needs& needs, const char* what, FramePlan& plan) {
    const std::string& mirror = *needs.mirror_parts.begin();
    plan_pass(plan, PassKind::environment_filter, fmt::format("part {} mirrors {}", mirror, what));
    if (plan.levels[Effect::reflected_occlusion] == 0) {
        plan.skipped.push_back(
            {PassKind::reflection_occlusion, "draft mirrors the environment through other parts"});
    } else {
        plan_pass(plan,
                  PassKind::reflection_occlusion,
                  fmt::format("part {} may mirror other parts", mirror));
    }
    plan_pass(
        plan,
        PassKind::mirrored_environment,
        fmt::format("what {} mirror at the roughnesses worn, whatever the paint's colour",
                    needs.mirror_parts.size() == 1 ? fmt::format("fragments of part {}", mirror)
                                                   : fmt::format("fragments of part {} and {} more",
                                                                 mirror,
                                                                 needs.mirror_parts.size() - 1)));
}

void plan_environment(const Needs& needs, const char* why_not, FramePlan& plan) {
    if (!needs.environment) {
        for (const PassKind pass :
             {PassKind::environment_irradiance, PassKind::ambient_occlusion}) {
            plan.skipped.push_back({pass, why_not});
        }
        plan.skipped.push_back({mirrored_ahead_pass(), why_not});
        return;
    }
    plan_pass(plan,
              PassKind::environment_irradiance,
              "the look has an environment that lights every part");
    if (plan.levels[Effect::occlusion] == 0) {
        plan.skipped.push_back(
            {PassKind::ambient_occlusion, "the environment is drawn as if nothing hid it"});
    } else {
        plan_pass(plan,
                  PassKind::ambient_occlusion,
                  plan.levels[Effect::occlusion] == 1
                      ? "joints are darker than what they join; draft looks at nothing else"
                      : "parts hide the environment from one another");
    }
    plan.skipped.push_back({mirrored_ahead_pass(),
                            "other parts and roughnesses wait until the window is idle; no paint "
                            "of this frame mirrors so"});
    if (needs.mirror_parts.empty()) {
        for (const PassKind pass : kMirrorPasses) {
            plan.skipped.push_back({pass, "no part mirrors the environment: all are diffuse"});
        }
        return;
    }
    plan_mirrors(needs, "the environment", plan);
}

/// Without an environment: lamps are mirrored as they are shaded, and parts that they light by what
/// is known of light between parts.
void plan_lit_mirrors(const Needs& needs, const char* why_not, FramePlan& plan) {
    if (!needs.mirror_parts.empty() && parts_send_light(plan)) {
        plan_mirrors(needs, "parts in the light of lamps", plan);
        return;
    }
    for (const PassKind pass : kMirrorPasses) plan.skipped.push_back({pass, why_not});
}

/// Below this nobody sees it.
constexpr double kUnseen_de00 = 0.25;

void plan_interreflection(const Scene& scene, const Needs& needs, FramePlan& plan) {
    if (!needs.environment && !any_light(scene)) {
        plan.skipped.push_back({PassKind::interreflection, "no part has light to send on"});
        return;
    }
    const ExchangeBound bound = exchange_bound(scene);
    if (bound.share == 0.0) {
        plan.skipped.push_back({PassKind::interreflection, "no part faces another, or itself"});
        return;
    }
    const std::string most =
        fmt::format("part {} may get as much as {:.0f}% of its own light from parts",
                    scene.product->mesh.parts[bound.part].name,
                    100.0 * bound.share);
    if (bound.de00 < kUnseen_de00) {
        plan.skipped.push_back(
            {PassKind::interreflection, most + ": nobody sees that", bound.de00});
    } else if (plan.levels[Effect::interreflection] == 0) {
        plan.skipped.push_back({PassKind::interreflection, most + "; left out", bound.de00});
    } else {
        plan_pass(plan, PassKind::interreflection, most);
    }
}

void plan_subsurface(const Scene& scene, const Scene& whole, FramePlan& plan) {
    const auto skip = [&](std::string why) {
        plan.skipped.push_back({PassKind::subsurface, std::move(why)});
    };
    if (std::none_of(whole.part_materials.begin(), whole.part_materials.end(), is_translucent)) {
        return skip("no part is translucent");
    }
    const auto part = spreading_part(whole);
    if (!part) {
        return skip(
            fmt::format("of the light that enters translucent parts nine tenths leave "
                        "within {} mm, or less than {}% leaves at all",
                        kUnseenReach_mm,
                        100.0 * kUnseenAlbedo));
    }
    const std::string reach =
        fmt::format("nine tenths of the light that enters part {} leaves it within {:.2g} mm",
                    scene.product->mesh.parts[*part].name,
                    subsurface_reach_mm(whole.part_materials[*part], whole.product->product_scale));
    if (plan.levels[Effect::subsurface] == 0) return skip(reach + "; left out");
    if (!calls_for(scene, Effect::subsurface)) return skip("no light enters any part");
    plan_pass(plan, PassKind::subsurface, reach);
}

void plan_glints(const Scene& scene, const char* why_not, FramePlan& plan) {
    if (!any_paint(scene, has_glints)) {
        plan.skipped.push_back({PassKind::glint_places, why_not});
    } else if (!any_light(scene)) {
        plan.skipped.push_back(
            {PassKind::glint_places, "flakes glint under lights; the look has none"});
    } else {
        plan_pass(plan,
                  PassKind::glint_places,
                  "how much of the product a pixel covers, and how many flakes: once for a pose");
    }
}

/// "a car paint with flakes, which glint: 3000 on a square millimetre, physical".
std::string paint_in_words(const Scene& scene, const Material& material) {
    const std::string model = model_info(material.model).in_words;
    if (!draws_glints(scene, material)) return model;
    return fmt::format("{}, which glint: {:.4g} on a square millimetre, {}",
                       model,
                       material.glint_density_per_mm2,
                       glint_scale_text(material));
}

void plan_shading(const Scene& scene,
                  const Needs& needs,
                  const char* why_no_glints,
                  FramePlan& plan) {
    if (needs.sided_parts.empty()) {
        plan.skipped.push_back(
            {PassKind::directions, "every paint looks the same from every side"});
    } else {
        plan_pass(plan,
                  PassKind::directions,
                  needs.mirror_parts.empty()
                      ? fmt::format("the shade of part {} depends on where the eye is",
                                    *needs.sided_parts.begin())
                      : fmt::format("the gloss of part {} depends on where the eye is",
                                    *needs.mirror_parts.begin()));
    }
    const bool plain =
        std::any_of(needs.models.begin(), needs.models.end(), [](ReflectanceModel model) {
            return model_info(model).same_from_all_sides;
        });
    if (plain) {
        plan_pass(
            plan, PassKind::diffuse_light, "plain diffuse parts need only the sum of all light");
    } else {
        plan.skipped.push_back({PassKind::diffuse_light, "no part is plain diffuse"});
    }
    if (scene.artwork.empty()) {
        plan.skipped.push_back({PassKind::artwork, "nothing lies over the parts' paints"});
    } else {
        plan_pass(plan,
                  PassKind::artwork,
                  "how much of each fragment artwork covers, once a pose and place of it");
    }
    plan_glints(scene, why_no_glints, plan);
    for (std::size_t i = 0; i < scene.part_materials.size(); ++i) {
        const Material& material = scene.part_materials[i];
        const std::string in_words = paint_in_words(scene, material);
        plan_pass(
            plan,
            shade_pass(scene, i),
            material.name.empty() ? in_words : fmt::format("{} is {}", material.name, in_words));
    }
    for (std::size_t k = 0; k < scene.artwork.size(); ++k) {
        const PartArtwork& artwork = scene.artwork[k];
        const char* shape = kArtworkShapes[static_cast<std::size_t>(artwork.artwork.shape)];
        const std::size_t coats = coats_of(artwork).size();
        plan_pass(plan,
                  artwork_pass(scene, k),
                  fmt::format("{} ({}) lies over it in {}{}",
                              artwork.artwork.name.empty() ? "artwork" : artwork.artwork.name,
                              shape,
                              artwork.material.name,
                              coats == 1 ? "" : fmt::format(", mixed of {}", coats)));
    }
    for (const ModelInfo& model : model_table()) {
        if (needs.models.contains(model.model)) continue;
        plan.skipped.push_back({PassId(PassKind::shade, "*", model.model), model.unused});
    }
}

}  // namespace

PassId visibility_pass(std::size_t light) {
    PassId pass(PassKind::light_visibility);
    pass.light = light;
    return pass;
}

PassId shade_pass(const Scene& scene, std::size_t part) {
    const Material& material = scene.part_materials.at(part);
    return {PassKind::shade,
            scene.product->mesh.parts.at(part).name,
            material.model,
            draws_glints(scene, material)};
}

PassId artwork_pass(const Scene& scene, std::size_t artwork) {
    const PartArtwork& one = scene.artwork.at(artwork);
    PassId pass(PassKind::shade,
                scene.product->mesh.parts.at(one.part).name,
                one.material.model,
                draws_glints(scene, one.material));
    pass.artwork = artwork;
    return pass;
}

PassId mirrored_ahead_pass() {
    PassId pass(PassKind::prepare);
    pass.ahead = PassKind::mirrored_environment;
    return pass;
}

bool parts_send_light(const FramePlan& plan) {
    constexpr int kNodesThatTrace = 2;
    return find_pass(plan, PassKind::interreflection) &&
           plan.levels[Effect::reflected_occlusion] > 0 &&
           plan.levels[Effect::mirrored_environment] >= kNodesThatTrace;
}

void plan_ahead(FramePlan& plan) {
    const auto skipped =
        std::find_if(plan.skipped.begin(), plan.skipped.end(), [](const SkippedPass& pass) {
            return pass.id == mirrored_ahead_pass();
        });
    const bool environment = find_pass(plan, PassKind::environment_irradiance) != nullptr;
    if (skipped == plan.skipped.end() || (!environment && !parts_send_light(plan))) return;
    plan.skipped.erase(skipped);
    plan_pass(
        plan,
        mirrored_ahead_pass(),
        "other parts or roughnesses may mirror next, or the eye be dragged: solved while idle");
}

const PlannedPass* find_pass(const FramePlan& plan, const PassId& id) {
    const auto found = std::find_if(plan.passes.begin(),
                                    plan.passes.end(),
                                    [&](const PlannedPass& pass) { return pass.id == id; });
    return found == plan.passes.end() ? nullptr : &*found;
}

PlannedPass* find_pass(FramePlan& plan, const PassId& id) {
    return const_cast<PlannedPass*>(find_pass(std::as_const(plan), id));
}

namespace {

void check_scene(const Scene& scene) {
    check_argument(scene.product != nullptr, "plan_frame: the scene has no product");
    check_argument(scene.part_materials.size() == scene.product->mesh.parts.size(),
                   fmt::format("plan_frame: {} materials for {} parts",
                               scene.part_materials.size(),
                               scene.product->mesh.parts.size()));
}

void plan_stage(FrameStage stage, FramePlan& plan) {
    if (stage == FrameStage::projector) {
        plan_pass(plan, PassKind::compensation, "the frame goes to the projector");
    } else {
        plan.skipped.push_back({PassKind::compensation, "the frame stops at radiance"});
    }
}

}  // namespace

std::optional<Effect> effect_of(const PassId& pass) {
    switch (pass.kind) {
        case PassKind::surface_map:
            return Effect::sub_samples;
        case PassKind::light_visibility:
            return Effect::shadows;
        case PassKind::environment_irradiance:
        case PassKind::environment_filter:
            return Effect::environment;
        case PassKind::ambient_occlusion:
            return Effect::occlusion;
        case PassKind::mirrored_environment:
            return Effect::mirrored_environment;
        case PassKind::reflection_occlusion:
            return Effect::reflected_occlusion;
        case PassKind::interreflection:
            return Effect::interreflection;
        case PassKind::subsurface:
            return Effect::subsurface;
        case PassKind::glint_places:
            return Effect::glints;
        case PassKind::relief:
            return Effect::relief;
        default:
            return std::nullopt;
    }
}

bool runs_every_frame(const PassId& pass) {
    return pass.kind == PassKind::shade || pass == PassKind::resolve ||
           pass == PassKind::compensation;
}

ExchangeBound exchange_bound(const Scene& scene) {
    const Product& product = *scene.product;
    const PartExchange exchange =
        product.exchange.parts == 0 ? part_exchange(product.mesh) : product.exchange;
    std::vector<double> albedo;
    for (const Material& material : scene.part_materials) {
        const glm::vec3 rgb = hemispherical_albedo(bsdf_of(material));
        albedo.push_back(static_cast<double>(std::max({rgb.x, rgb.y, rgb.z})));
    }
    ExchangeBound bound;
    for (std::size_t to = 0; to < albedo.size(); ++to) {
        double share = 0.0;
        for (std::size_t from = 0; from < albedo.size(); ++from) {
            share += albedo[from] * static_cast<double>(exchange.of(to, from));
        }
        if (share > bound.share) bound = {to, share, 0.0};
    }
    // Of a middle grey
    const glm::dvec3 white = xyz_from_working() * glm::dvec3(1.0), grey = 0.2 * white;
    bound.de00 = ciede2000(lab_from_xyz(grey, white),
                           lab_from_xyz(grey * (1.0 + std::min(bound.share, 1.0)), white));
    return bound;
}

FramePlan plan_frame(const Scene& scene, Quality quality, FrameStage stage) {
    if (quality != Quality::reference) return plan_frame(scene, levels_of(quality), stage);
    check_scene(scene);
    FramePlan plan;
    plan.quality = quality;
    plan_pass(plan, PassKind::path_tracer, "the ground truth was asked for");
    plan.skipped.push_back({PassKind::surface_map, "the path tracer finds what it sees by itself"});
    plan_stage(stage, plan);
    return plan;
}

FramePlan plan_frame(const Scene& whole, const EffectLevels& levels, FrameStage stage) {
    check_scene(whole);
    check_levels(levels);
    const Scene scene = at_levels(whole, levels);
    const auto left_out = [&](Effect effect) {
        return levels[effect] == 0 && calls_for(whole, effect);
    };
    const Needs needs = needs_of(scene);
    FramePlan plan;
    plan.quality = nearest_quality(levels);
    plan.levels = levels;
    plan_pass(plan, PassKind::surface_map, "what each projector pixel lights, once for a pose");
    if (scene.relief.empty()) {
        plan.skipped.push_back({PassKind::relief,
                                left_out(Effect::relief) ? "the surface is drawn without its relief"
                                                         : "no part has a relief"});
    } else {
        plan_pass(plan,
                  PassKind::relief,
                  fmt::format("the relief of part {} tilts its surface before light is solved",
                              scene.product->mesh.parts[scene.relief.front().part].name));
    }
    plan_lights(scene, plan);
    const char* why_no_environment = left_out(Effect::environment) ? "the environment is left out"
                                                                   : "no environment in the look";
    plan_environment(needs, why_no_environment, plan);
    plan_interreflection(scene, needs, plan);
    if (!needs.environment) plan_lit_mirrors(needs, why_no_environment, plan);
    plan_subsurface(scene, whole, plan);
    plan_shading(scene,
                 needs,
                 left_out(Effect::glints) ? "flakes are drawn as a smooth lobe"
                                          : "no paint of the scene has glints",
                 plan);
    plan_pass(plan, PassKind::resolve, "fragments of a pixel are mixed by their coverage");
    plan_stage(stage, plan);
    return plan;
}

}  // namespace livery
