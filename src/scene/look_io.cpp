#include <glm/geometric.hpp>

#include "core/json.h"
#include "scene/look.h"

namespace livery {

namespace {

constexpr int kFormatVersion = 1;
constexpr double kPi = 3.14159265358979323846;

DirectionalLight read_light(const JsonReader& field) {
    field.allow_only({"type", "direction", "radiance", "angle_rad"});
    if (field["type"].text() != "directional") {
        field["type"].fail(field["type"].found(), "\"directional\"");
    }
    DirectionalLight light;
    light.direction = field["direction"].vec3();
    const double length = glm::length(light.direction);
    if (!(length > 1e-12)) field["direction"].fail("a vector of no length", "a direction");
    light.direction /= length;
    light.radiance_rec709 = field["radiance"].vec3();
    for (std::size_t k = 0; k < 3; ++k) field["radiance"].at(k).number_between(-1e6, 1e6);
    if (field.has("angle_rad")) light.angle_rad = field["angle_rad"].number_between(0.0, kPi);
    return light;
}

}  // namespace

Look read_look_file(const std::filesystem::path& file) {
    const Json json = read_json_file(file);
    const JsonReader root(file, json);
    root.require_format_version(kFormatVersion);
    root.allow_only({"format_version", "name", "parts", "lights", "environment", "exposure_ev"});
    Look look;
    look.file = file;
    look.name = root.has("name") ? root["name"].text() : file.stem().string();
    if (root.has("parts")) {
        for (const auto& part : root["parts"].keys()) {
            const auto paint = root["parts"][part];
            look.parts[part] = paint.text();
            if (look.parts[part].empty()) paint.fail("an empty name", "a paint or a material file");
        }
    }
    if (root.has("lights")) {
        for (std::size_t k = 0; k < root["lights"].size(); ++k) {
            look.lights.push_back(read_light(root["lights"].at(k)));
        }
    }
    if (root.has("environment")) {
        const auto environment = root["environment"];
        environment.allow_only({"file", "rotation_rad", "scale"});
        look.environment.file = environment["file"].text();
        if (look.environment.file.empty()) environment["file"].fail("an empty name", "a picture");
        if (environment.has("rotation_rad")) {
            look.environment.rotation_rad =
                environment["rotation_rad"].number_between(-100.0, 100.0);
        }
        if (environment.has("scale")) {
            look.environment.scale = environment["scale"].number_between(0.0, 1e6);
        }
    }
    if (root.has("exposure_ev")) look.exposure_ev = root["exposure_ev"].number_between(-30.0, 30.0);
    return look;
}

void write_look_file(const std::filesystem::path& file, const Look& look) {
    Json json;
    json["format_version"] = kFormatVersion;
    json["name"] = look.name;
    json["parts"] = Json::object();
    for (const auto& [part, paint] : look.parts) json["parts"][part] = paint;
    json["lights"] = Json::array();
    for (const auto& light : look.lights) {
        json["lights"].push_back({{"type", "directional"},
                                  {"direction", json_from(light.direction)},
                                  {"radiance", json_from(light.radiance_rec709)},
                                  {"angle_rad", light.angle_rad}});
    }
    if (!look.environment.file.empty()) {
        json["environment"] = {{"file", look.environment.file},
                               {"rotation_rad", look.environment.rotation_rad},
                               {"scale", look.environment.scale}};
    }
    json["exposure_ev"] = look.exposure_ev;
    write_json_file(file, json);
}

}  // namespace livery
