#include "scene/pass_id.h"

#include <stdexcept>

#include <fmt/format.h>

#include "appearance/model_table.h"

namespace livery {

namespace {

const char* name_of(PassKind kind) {
    switch (kind) {
        case PassKind::path_tracer:
            return "path-tracer";
        case PassKind::surface_map:
            return "surface-map";
        case PassKind::relief:
            return "relief";
        case PassKind::light_visibility:
            return "visibility";
        case PassKind::environment_irradiance:
            return "environment-irradiance";
        case PassKind::ambient_occlusion:
            return "ambient-occlusion";
        case PassKind::interreflection:
            return "interreflection";
        case PassKind::subsurface:
            return "subsurface";
        case PassKind::environment_filter:
            return "environment-filter";
        case PassKind::reflection_occlusion:
            return "reflection-occlusion";
        case PassKind::mirrored_environment:
            return "mirrored-environment";
        case PassKind::directions:
            return "directions";
        case PassKind::diffuse_light:
            return "diffuse-light";
        case PassKind::artwork:
            return "artwork";
        case PassKind::glint_places:
            return "glint-places";
        case PassKind::shade:
            return "shade";
        case PassKind::resolve:
            return "resolve";
        case PassKind::compensation:
            return "compensation";
        case PassKind::prepare:
            return "prepare";
    }
    throw std::invalid_argument(fmt::format("pass kind {}", static_cast<int>(kind)));
}

}  // namespace

std::string to_string(const PassId& pass) {
    std::string text = name_of(pass.kind);
    if (pass.kind == PassKind::light_visibility) {
        return (pass.light ? light_name(*pass.light) : "light") + "-" + text;
    }
    if (!pass.part.empty()) text += ":" + pass.part;
    if (pass.artwork) text += fmt::format(":artwork-{}", *pass.artwork + 1);
    if (pass.ahead) text += std::string(":") + name_of(*pass.ahead);
    if (pass.model) text += fmt::format(":{}", model_info(*pass.model).name);
    return pass.glints ? text + "+glints" : text;
}

std::string light_name(std::size_t light) {
    if (light == 0) return "key";
    if (light == 1) return "fill";
    return fmt::format("light-{}", light + 1);
}

}  // namespace livery
