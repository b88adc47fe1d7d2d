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
#include "scene/effects.h"

namespace livery {

namespace {

struct PassInfo {
    PassKind kind;
    const char* name;
    std::optional<Effect> effect{};  ///< none: it runs at any level of any
};
constexpr std::array kPasses{
    PassInfo{PassKind::path_tracer, "path-tracer"},
    PassInfo{PassKind::surface_map, "surface-map", Effect::sub_samples},
    PassInfo{PassKind::relief, "relief", Effect::relief},
    PassInfo{PassKind::light_visibility, "visibility", Effect::shadows},
    PassInfo{PassKind::environment_irradiance, "environment-irradiance", Effect::environment},
    PassInfo{PassKind::ambient_occlusion, "ambient-occlusion", Effect::occlusion},
    PassInfo{PassKind::interreflection, "interreflection", Effect::interreflection},
    PassInfo{PassKind::subsurface, "subsurface", Effect::subsurface},
    PassInfo{PassKind::environment_filter, "environment-filter", Effect::environment},
    PassInfo{PassKind::reflection_occlusion, "reflection-occlusion", Effect::reflected_occlusion},
    PassInfo{PassKind::mirrored_environment, "mirrored-environment", Effect::mirrored_environment},
    PassInfo{PassKind::directions, "directions"},
    PassInfo{PassKind::diffuse_light, "diffuse-light"},
    PassInfo{PassKind::artwork, "artwork"},
    PassInfo{PassKind::glint_places, "glint-places", Effect::glints},
    PassInfo{PassKind::shade, "shade"},
    PassInfo{PassKind::resolve, "resolve"},
    PassInfo{PassKind::compensation, "compensation"},
    PassInfo{PassKind::prepare, "prepare"},
};

const PassInfo& info_of(PassKind kind) {
    const auto found = std::find_if(
        kPasses.begin(), kPasses.end(), [&](const PassInfo& info) { return info.kind == kind; });
    check_argument(found != kPasses.end(), fmt::format("pass kind {}", static_cast<int>(kind)));
    return *found;
}

}  // namespace

std::string to_string(const PassId& pass) {
    std::string text = info_of(pass.kind).name;
    if (pass.kind == PassKind::light_visibility) {
        return (pass.light ? light_name(*pass.light) : "light") + "-" + text;
    }
    if (!pass.part.empty()) text += ":" + pass.part;
    if (pass.artwork) text += fmt::format(":artwork-{}", *pass.artwork + 1);
    if (pass.ahead) text += std::string(":") + info_of(*pass.ahead).name;
    if (pass.model) text += fmt::format(":{}", model_info(*pass.model).name);
    return pass.glints ? text + "+glints" : text;
}

std::string light_name(std::size_t light) {
    if (light == 0) return "key";
    if (light == 1) return "fill";
    return fmt::format("light-{}", light + 1);
}

namespace {

/// Lists passes, and says why where somebody asks: a reason is a text, or what makes one.
struct Planner {
    const Scene& scene;  ///< at the plan's levels
    FramePlan& plan;
    bool says_why = false;

    template <typename Why>
    void run(PassId id, const Why& why) const {
        PlannedPass& pass = plan.passes.emplace_back();
        pass.id = std::move(id);
        if (says_why) pass.why = text_of(why);
    }
    template <typename Why>
    void skip(PassId id, const Why& why, std::optional<double> error_bound = {}) const {
        SkippedPass& pass = plan.skipped.emplace_back();
        pass.id = std::move(id);
        if (says_why) pass.why = text_of(why);
        pass.error_bound = error_bound;
    }
    int level(Effect effect) const { return plan.levels[effect]; }

  private:
    static std::string text_of(const char* text) { return text; }
    template <typename Why>
    static std::string text_of(const Why& why) {
        return why();
    }
};

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

void plan_lights(const Planner& planner) {
    const int level = planner.level(Effect::shadows);
    const auto& lights = planner.scene.lights;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const DirectionalLight& light = lights[i];
        const PassId pass = visibility_pass(i);
        if (is_black(light.radiance_rec709)) {
            planner.skip(pass, [&] { return fmt::format("the {} light is black", light_name(i)); });
        } else if (level == 0) {
            planner.skip(pass, [&] {
                return fmt::format("the {} light is drawn without shadows", light_name(i));
            });
        } else if (light.angle_rad <= 0.0) {
            planner.run(pass, [&] {
                return fmt::format("the look has a {} light, a point: sharp shadows",
                                   light_name(i));
            });
        } else {
            planner.run(pass, [&] {
                return fmt::format(
                    "the look has a {} light {} wide{}",
                    light_name(i),
                    degrees(light.angle_rad),
                    level == 1 ? "; draft shows its shadows sharp" : ": soft shadows");
            });
        }
    }
    if (lights.empty()) planner.skip(visibility_pass(0), "the look has no light");
}

constexpr std::array kMirrorPasses{
    PassKind::environment_filter, PassKind::reflection_occlusion, PassKind::mirrored_environment};

/// `what` parts mirror: "the environment".
void plan_mirrors(const Planner& planner, const Needs& needs, const char* what) {
    const std::string& mirror = *needs.mirror_parts.begin();
    planner.run(PassKind::environment_filter,
                [&] { return fmt::format("part {} mirrors {}", mirror, what); });
    if (planner.level(Effect::reflected_occlusion) == 0) {
        planner.skip(PassKind::reflection_occlusion,
                     "draft mirrors the environment through other parts");
    } else {
        planner.run(PassKind::reflection_occlusion,
                    [&] { return fmt::format("part {} may mirror other parts", mirror); });
    }
    planner.run(PassKind::mirrored_environment, [&] {
        const std::size_t more = needs.mirror_parts.size() - 1;
        return fmt::format(
            "what fragments of part {}{} mirror at the roughnesses worn, whatever the paint's "
            "colour",
            mirror,
            more == 0 ? "" : fmt::format(" and {} more", more));
    });
}

void plan_environment(const Planner& planner, const Needs& needs, const char* why_not) {
    if (!needs.environment) {
        planner.skip(PassKind::environment_irradiance, why_not);
        planner.skip(PassKind::ambient_occlusion, why_not);
        planner.skip(mirrored_ahead_pass(), why_not);
        return;
    }
    planner.run(PassKind::environment_irradiance,
                "the look has an environment that lights every part");
    const int level = planner.level(Effect::occlusion);
    if (level == 0) {
        planner.skip(PassKind::ambient_occlusion, "the environment is drawn as if nothing hid it");
    } else {
        planner.run(PassKind::ambient_occlusion,
                    level == 1
                        ? "joints are darker than what they join; draft looks at nothing else"
                        : "parts hide the environment from one another");
    }
    planner.skip(
        mirrored_ahead_pass(),
        "other parts and roughnesses wait until the window is idle; no paint of this frame "
        "mirrors so");
    if (needs.mirror_parts.empty()) {
        for (const PassKind pass : kMirrorPasses) {
            planner.skip(pass, "no part mirrors the environment: all are diffuse");
        }
        return;
    }
    plan_mirrors(planner, needs, "the environment");
}

/// Without an environment: lamps are mirrored as they are shaded, and parts that they light by what
/// is known of light between parts.
void plan_lit_mirrors(const Planner& planner, const Needs& needs, const char* why_not) {
    if (!needs.mirror_parts.empty() && parts_send_light(planner.plan)) {
        plan_mirrors(planner, needs, "parts in the light of lamps");
        return;
    }
    for (const PassKind pass : kMirrorPasses) planner.skip(pass, why_not);
}

/// Below this nobody sees it.
constexpr double kUnseen_de00 = 0.25;

void plan_interreflection(const Planner& planner, const Needs& needs) {
    constexpr PassKind pass = PassKind::interreflection;
    if (!needs.environment && !any_light(planner.scene)) {
        return planner.skip(pass, "no part has light to send on");
    }
    const ExchangeBound bound = exchange_bound(planner.scene);
    if (bound.share == 0.0) return planner.skip(pass, "no part faces another, or itself");
    const auto most = [&](const char* so) {
        return [&, so] {
            return fmt::format("part {} may get as much as {:.0f}% of its own light from parts{}",
                               planner.scene.product->mesh.parts[bound.part].name,
                               100.0 * bound.share,
                               so);
        };
    };
    if (bound.de00 < kUnseen_de00) {
        planner.skip(pass, most(": nobody sees that"), bound.de00);
    } else if (planner.level(Effect::interreflection) == 0) {
        planner.skip(pass, most("; left out"), bound.de00);
    } else {
        planner.run(pass, most(""));
    }
}

void plan_subsurface(const Planner& planner, const Scene& whole) {
    constexpr PassKind pass = PassKind::subsurface;
    if (std::none_of(whole.part_materials.begin(), whole.part_materials.end(), is_translucent)) {
        return planner.skip(pass, "no part is translucent");
    }
    const auto part = spreading_part(whole);
    if (!part) {
        return planner.skip(pass, [] {
            return fmt::format(
                "of the light that enters translucent parts nine tenths leave "
                "within {} mm, or less than {}% leaves at all",
                kUnseenReach_mm,
                100.0 * kUnseenAlbedo);
        });
    }
    const auto reach = [&](const char* so) {
        return [&, so] {
            return fmt::format(
                "nine tenths of the light that enters part {} leaves it within {:.2g} mm{}",
                whole.product->mesh.parts[*part].name,
                subsurface_reach_mm(whole.part_materials[*part], whole.product->product_scale),
                so);
        };
    };
    if (planner.level(Effect::subsurface) == 0) return planner.skip(pass, reach("; left out"));
    if (!calls_for(planner.scene, Effect::subsurface)) {
        return planner.skip(pass, "no light enters any part");
    }
    planner.run(pass, reach(""));
}

void plan_glints(const Planner& planner, const char* why_not) {
    if (!any_paint(planner.scene, has_glints)) {
        planner.skip(PassKind::glint_places, why_not);
    } else if (!any_light(planner.scene)) {
        planner.skip(PassKind::glint_places, "flakes glint under lights; the look has none");
    } else {
        planner.run(PassKind::glint_places,
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

void plan_shading(const Planner& planner, const Needs& needs, const char* why_no_glints) {
    const Scene& scene = planner.scene;
    if (needs.sided_parts.empty()) {
        planner.skip(PassKind::directions, "every paint looks the same from every side");
    } else {
        planner.run(PassKind::directions, [&] {
            return needs.mirror_parts.empty()
                       ? fmt::format("the shade of part {} depends on where the eye is",
                                     *needs.sided_parts.begin())
                       : fmt::format("the gloss of part {} depends on where the eye is",
                                     *needs.mirror_parts.begin());
        });
    }
    const bool plain =
        std::any_of(needs.models.begin(), needs.models.end(), [](ReflectanceModel model) {
            return model_info(model).same_from_all_sides;
        });
    if (plain) {
        planner.run(PassKind::diffuse_light, "plain diffuse parts need only the sum of all light");
    } else {
        planner.skip(PassKind::diffuse_light, "no part is plain diffuse");
    }
    if (scene.artwork.empty()) {
        planner.skip(PassKind::artwork, "nothing lies over the parts' paints");
    } else {
        planner.run(PassKind::artwork,
                    "how much of each fragment artwork covers, once a pose and place of it");
    }
    plan_glints(planner, why_no_glints);
    for (std::size_t i = 0; i < scene.part_materials.size(); ++i) {
        planner.run(shade_pass(scene, i), [&] {
            const Material& material = scene.part_materials[i];
            const std::string in_words = paint_in_words(scene, material);
            return material.name.empty() ? in_words
                                         : fmt::format("{} is {}", material.name, in_words);
        });
    }
    for (std::size_t k = 0; k < scene.artwork.size(); ++k) {
        planner.run(artwork_pass(scene, k), [&] {
            const PartArtwork& artwork = scene.artwork[k];
            const std::size_t coats = coats_of(artwork).size();
            return fmt::format("{} ({}) lies over it in {}{}",
                               artwork.artwork.name.empty() ? "artwork" : artwork.artwork.name,
                               kArtworkShapes[static_cast<std::size_t>(artwork.artwork.shape)],
                               artwork.material.name,
                               coats == 1 ? "" : fmt::format(", mixed of {}", coats));
        });
    }
    for (const ModelInfo& model : model_table()) {
        if (needs.models.contains(model.model)) continue;
        planner.skip(PassId(PassKind::shade, "*", model.model), model.unused);
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
    plan.passes.emplace_back().id = mirrored_ahead_pass();
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

void plan_stage(const Planner& planner, FrameStage stage) {
    if (stage == FrameStage::projector) {
        planner.run(PassKind::compensation, "the frame goes to the projector");
    } else {
        planner.skip(PassKind::compensation, "the frame stops at radiance");
    }
}

}  // namespace

std::optional<Effect> effect_of(const PassId& pass) { return info_of(pass.kind).effect; }

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

namespace {

FramePlan plan_traced(const Scene& scene, FrameStage stage, bool says_why) {
    check_scene(scene);
    FramePlan plan;
    plan.quality = Quality::reference;
    const Planner planner{scene, plan, says_why};
    planner.run(PassKind::path_tracer, "the ground truth was asked for");
    planner.skip(PassKind::surface_map, "the path tracer finds what it sees by itself");
    plan_stage(planner, stage);
    return plan;
}

FramePlan plan_drawn(const Scene& whole,
                     const EffectLevels& levels,
                     FrameStage stage,
                     bool says_why) {
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
    const Planner planner{scene, plan, says_why};
    planner.run(PassKind::surface_map, "what each projector pixel lights, once for a pose");
    if (scene.relief.empty()) {
        planner.skip(PassKind::relief,
                     left_out(Effect::relief) ? "the surface is drawn without its relief"
                                              : "no part has a relief");
    } else {
        planner.run(PassKind::relief, [&] {
            return fmt::format("the relief of part {} tilts its surface before light is solved",
                               scene.product->mesh.parts[scene.relief.front().part].name);
        });
    }
    plan_lights(planner);
    const char* why_no_environment = left_out(Effect::environment) ? "the environment is left out"
                                                                   : "no environment in the look";
    plan_environment(planner, needs, why_no_environment);
    plan_interreflection(planner, needs);
    if (!needs.environment) plan_lit_mirrors(planner, needs, why_no_environment);
    plan_subsurface(planner, whole);
    plan_shading(planner,
                 needs,
                 left_out(Effect::glints) ? "flakes are drawn as a smooth lobe"
                                          : "no paint of the scene has glints");
    planner.run(PassKind::resolve, "fragments of a pixel are mixed by their coverage");
    plan_stage(planner, stage);
    return plan;
}

}  // namespace

FramePlan plan_frame(const Scene& scene, Quality quality, FrameStage stage) {
    if (quality == Quality::reference) return plan_traced(scene, stage, false);
    return plan_frame(scene, levels_of(quality), stage);
}

FramePlan plan_frame(const Scene& scene, const EffectLevels& levels, FrameStage stage) {
    return plan_drawn(scene, levels, stage, false);
}

void say_why(const Scene& scene, FramePlan& plan) {
    const FrameStage stage =
        find_pass(plan, PassKind::compensation) ? FrameStage::projector : FrameStage::radiance;
    const FramePlan anew = plan.quality == Quality::reference
                               ? plan_traced(scene, stage, true)
                               : plan_drawn(scene, plan.levels, stage, true);
    for (PlannedPass& pass : plan.passes) {
        if (!pass.why.empty()) continue;
        if (const PlannedPass* same = find_pass(anew, pass.id)) pass.why = same->why;
        if (pass.id == mirrored_ahead_pass()) {
            pass.why =
                "other parts or roughnesses may mirror next, or the eye be dragged: solved while "
                "idle";
        }
    }
    for (SkippedPass& pass : plan.skipped) {
        const auto same = std::find_if(anew.skipped.begin(),
                                       anew.skipped.end(),
                                       [&](const SkippedPass& one) { return one.id == pass.id; });
        if (same != anew.skipped.end()) pass.why = same->why;
    }
}

bool sends_light_on(const Scene& whole, const EffectLevels& levels) {
    if (levels[Effect::interreflection] == 0) return false;
    const Scene scene = at_levels(whole, levels);
    FramePlan plan;
    plan.levels = levels;
    plan_interreflection(Planner{scene, plan}, needs_of(scene));
    return !plan.passes.empty();
}

}  // namespace livery
