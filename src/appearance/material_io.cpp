#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "appearance/bsdf.h"
#include "appearance/material.h"
#include "appearance/material_json.h"
#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr int kFormatVersion = 1;

struct ModelDescription {
    ReflectanceModel model;
    std::string name;
    std::vector<std::string> parameters;
};

const std::vector<ModelDescription>& models() {
    static const std::vector<ModelDescription> list = {
        {ReflectanceModel::lambert, "lambert", {"diffuse"}},
        {ReflectanceModel::ggx, "ggx", {"diffuse", "f0", "alpha"}},
        {ReflectanceModel::clearcoat,
         "clearcoat",
         {"diffuse", "f0", "alpha", "coat_alpha", "coat_f0", "coat_transmittance"}}};
    return list;
}

const ModelDescription& read_model(const JsonReader& reader) {
    const std::string name = reader.text();
    std::vector<std::string> names;
    for (const ModelDescription& description : models()) {
        if (description.name == name) return description;
        names.push_back(description.name);
    }
    reader.fail(fmt::format("'{}'", name), fmt::format("one of {}", fmt::join(names, ", ")));
}

/// A model's parameters, all of them and no others.
void read_parameters(const JsonReader& reader,
                     const ModelDescription& description,
                     Material& material) {
    if (!reader.is_object()) reader.fail(reader.found(), "an object");
    const auto& known = description.parameters;
    for (const std::string& key : reader.keys()) {
        if (std::find(known.begin(), known.end(), key) == known.end()) {
            reader.fail(
                fmt::format("parameter '{}'", key),
                fmt::format("the parameters of {}: {}", description.name, fmt::join(known, ", ")));
        }
    }
    for (const std::string& key : known) {
        const JsonReader value = reader[key];
        if (key == "diffuse") material.diffuse = value.vec3();
        if (key == "f0") material.f0 = value.vec3();
        if (key == "alpha") {
            if (value.is_array()) {
                if (value.size() != 2) value.fail(value.found(), "one number or two");
                material.alpha = {value.at(0).number_between(1e-4, 1.0),
                                  value.at(1).number_between(1e-4, 1.0)};
            } else {
                material.alpha = glm::dvec2(value.number_between(1e-4, 1.0));
            }
        }
        if (key == "coat_alpha") material.coat_alpha = value.number_between(1e-4, 1.0);
        if (key == "coat_f0") material.coat_f0 = value.number_between(0.0, 0.2);
        if (key == "coat_transmittance") material.coat_transmittance = value.vec3();
    }
}

}  // namespace

Material read_material(const JsonReader& reader) {
    Material material;
    material.name = reader["name"].text();
    if (material.name.empty()) reader["name"].fail("empty text", "a name");
    if (reader.has("family")) material.family = reader["family"].text();
    if (reader.has("provenance")) material.provenance = reader["provenance"].text();
    const ModelDescription& description = read_model(reader["model"]);
    material.model = description.model;
    const JsonReader parameters = reader["parameters"];
    read_parameters(parameters, description, material);
    try {
        parameters_of_f64(material);
    } catch (const std::invalid_argument& mistake) {
        parameters.fail(mistake.what(),
                        "colours in [0, 1] of the working space (docs/materials.md)");
    }
    return material;
}

Json json_of(const Material& material) {
    parameters_of_f64(material);
    Json parameters = Json::object();
    const ModelDescription& description = models()[static_cast<std::size_t>(material.model)];
    for (const std::string& key : description.parameters) {
        if (key == "diffuse") parameters[key] = json_from(material.diffuse);
        if (key == "f0") parameters[key] = json_from(material.f0);
        if (key == "alpha") {
            if (material.alpha.x == material.alpha.y) {
                parameters[key] = material.alpha.x;
            } else {
                parameters[key] = {material.alpha.x, material.alpha.y};
            }
        }
        if (key == "coat_alpha") parameters[key] = material.coat_alpha;
        if (key == "coat_f0") parameters[key] = material.coat_f0;
        if (key == "coat_transmittance") {
            parameters[key] = json_from(material.coat_transmittance);
        }
    }
    Json json = Json::object();
    json["name"] = material.name;
    json["family"] = material.family;
    json["model"] = description.name;
    json["parameters"] = parameters;
    json["provenance"] = material.provenance;
    return json;
}

Material read_material_file(const std::filesystem::path& file) {
    return parse_material(read_text_file(file, std::size_t{1} << 20u), file);
}

Material parse_material(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader reader(file, json);
    reader.require_format_version(kFormatVersion);
    reader.allow_only({"format_version", "name", "family", "model", "parameters", "provenance"});
    Material material = read_material(reader);
    material.file = file;
    return material;
}

void write_material_file(const std::filesystem::path& file, const Material& material) {
    Json json = Json::object();
    json["format_version"] = kFormatVersion;
    json.update(json_of(material));
    write_json_file(file, json);
}

}  // namespace livery
