#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/json.h"
#include "core/paths.h"
#include "scene/look.h"
#include "scene/look_json.h"

namespace livery {

namespace {

constexpr int kLookVersion = 1;

DirectionalLight read_light(const JsonReader& field) {
    field.allow_only({"type", "direction", "radiance", "angle_rad"});
    if (field["type"].text() != "directional") {
        field["type"].fail(field["type"].found(), "\"directional\"");
    }
    DirectionalLight light;
    light.direction = vec3_within(field["direction"], kLongestDirection);
    if (!(glm::length(light.direction) > 1e-12)) {
        field["direction"].fail("a vector of no length", "a direction");
    }
    light.direction = unit_direction(light.direction);
    light.radiance_rec709 = vec3_within(field["radiance"], 1e6);
    if (field.has("angle_rad"))
        light.angle_rad = field["angle_rad"].number_between(0.0, std::numbers::pi);
    return light;
}

EnvironmentReference read_environment_reference(const JsonReader& environment) {
    environment.allow_only({"file", "rotation_rad", "scale"});
    EnvironmentReference reference;
    reference.file = environment["file"].text();
    if (reference.file.empty()) environment["file"].fail("an empty name", "a picture");
    if (environment.has("rotation_rad")) {
        reference.rotation_rad = environment["rotation_rad"].number_between(-100.0, 100.0);
    }
    if (environment.has("scale")) {
        reference.scale = environment["scale"].number_between(0.0, 1e6);
    }
    return reference;
}

}  // namespace

glm::dvec3 unit_direction(const glm::dvec3& direction) {
    const double length = glm::length(direction);
    return std::abs(length - 1.0) < 1e-12 ? direction : direction / length;
}

std::vector<DirectionalLight> read_lights(const JsonReader& list) {
    std::vector<DirectionalLight> lights;
    for (std::size_t k = 0; k < list.size(); ++k) lights.push_back(read_light(list.at(k)));
    return lights;
}

Json json_of(const std::vector<DirectionalLight>& lights) {
    Json json = Json::array();
    for (const auto& light : lights) {
        json.push_back({{"type", "directional"},
                        {"direction", json_from(light.direction)},
                        {"radiance", json_from(light.radiance_rec709)},
                        {"angle_rad", light.angle_rad}});
    }
    return json;
}

EnvironmentReference read_environment(const JsonReader& parent) {
    if (!parent.has("environment")) return {};
    return read_environment_reference(parent["environment"]);
}

Json json_of(const EnvironmentReference& environment) {
    return {{"file", environment.file},
            {"rotation_rad", environment.rotation_rad},
            {"scale", environment.scale}};
}

Look read_look(const JsonReader& root) {
    Look look;
    if (root.has("name")) look.name = root["name"].text();
    if (root.has("parts")) {
        for (const auto& part : root["parts"].keys()) {
            const auto paint = root["parts"][part];
            look.parts[part] = paint.text();
            if (look.parts[part].empty()) paint.fail("an empty name", "a paint or a material file");
        }
    }
    if (root.has("variant")) look.variant = root["variant"].text();
    if (root.has("artwork")) look.artwork = read_artwork(root["artwork"]);
    if (root.has("lights")) look.lights = read_lights(root["lights"]);
    look.environment = read_environment(root);
    if (root.has("exposure_ev")) look.exposure_ev = root["exposure_ev"].number_between(-30.0, 30.0);
    return look;
}

Json json_of(const Look& look) {
    Json json = Json::object();
    json["name"] = look.name;
    json["parts"] = Json::object();
    for (const auto& [part, paint] : look.parts) json["parts"][part] = paint;
    if (!look.variant.empty()) json["variant"] = look.variant;
    if (!look.artwork.empty()) json["artwork"] = json_of(look.artwork);
    json["lights"] = json_of(look.lights);
    if (!look.environment.file.empty()) json["environment"] = json_of(look.environment);
    json["exposure_ev"] = look.exposure_ev;
    return json;
}

void for_each_paint(Look& look, const std::function<void(std::string&)>& change) {
    for (auto& [part, paint] : look.parts) change(paint);
    for (Artwork& artwork : look.artwork) {
        if (!artwork.paint.empty()) change(artwork.paint);
    }
}

void for_each_file(Look& look, const std::function<void(std::string&)>& change) {
    for_each_paint(look, change);
    for (Artwork& artwork : look.artwork) {
        if (!artwork.picture.empty()) change(artwork.picture);
    }
    if (!look.environment.file.empty()) change(look.environment.file);
}

Look read_look_file(const std::filesystem::path& file) {
    return parse_look(read_text_file(file), file);
}

Look parse_look(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.require_format_version(kLookVersion);
    root.allow_only({"format_version",
                     "name",
                     "parts",
                     "variant",
                     "artwork",
                     "lights",
                     "environment",
                     "exposure_ev"});
    Look look = read_look(root);
    if (!root.has("name")) look.name = file.stem().string();
    look.file = file;
    return look;
}

void write_look_file(const std::filesystem::path& file, const Look& look) {
    Json json;
    json["format_version"] = kLookVersion;
    json.update(json_of(look));
    write_json_file(file, json);
}

}  // namespace livery
