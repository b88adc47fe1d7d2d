#include <fmt/format.h>
#include <fmt/ranges.h>

#include "appearance/bsdf.h"
#include "appearance/material.h"
#include "appearance/material_json.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
#include "appearance/subsurface/scattering_medium.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr int kFormatVersion = 1;
constexpr std::size_t kLargestMaterial_bytes = std::size_t{1} << 20u;

const ModelInfo& read_model(const JsonReader& material) {
    const JsonReader reader = material["model"];
    const std::string name = reader.text();
    if (const ModelInfo* model = find_model(name)) return *model;
    reader.fail(fmt::format("'{}'", name), "one of " + model_names());
}

void read_value(const JsonReader& reader,
                const ModelInfo& model,
                const ParameterInfo& parameter,
                Material& material) {
    const Components<double> to = parameter.in_material(material);
    const auto number = [&](const JsonReader& value) {
        return value.number_between(parameter.low, parameter.high);
    };
    switch (parameter.kind) {
        case ParameterKind::colour: {
            const glm::dvec3 colour = reader.vec3();
            for (int c = 0; c < 3; ++c) *to[static_cast<std::size_t>(c)] = colour[c];
            break;
        }
        case ParameterKind::number:
            *to[0] = number(reader);
            break;
        case ParameterKind::pair:
            if (reader.is_array() && !model.anisotropic) {
                reader.fail(reader.found(), fmt::format("one number: {} has no grain", model.name));
            }
            if (reader.is_array() && reader.size() != 2) {
                reader.fail(reader.found(), "one number or two");
            }
            *to[0] = number(reader.is_array() ? reader.at(0) : reader);
            *to[1] = number(reader.is_array() ? reader.at(1) : reader);
            break;
    }
}

Json json_of_value(const ParameterInfo& parameter, const Material& material) {
    const glm::dvec3 value = value_of(parameter, material);
    if (parameter.kind == ParameterKind::colour) return json_from(value);
    const bool two = parameter.kind == ParameterKind::pair && value.x != value.y;
    if (two && model_info(material.model).anisotropic) return {value.x, value.y};
    return value.x;
}

/// The measured file, absolute or beside the material's own. An absolute place is written: the
/// material may be kept elsewhere than the file.
void read_measured(const JsonReader& reader, Material& material) {
    if (!reader.is_object()) reader.fail(reader.found(), "an object");
    reader.allow_only({"file"});
    const std::filesystem::path named = reader["file"].text();
    if (named.empty()) reader["file"].fail("empty text", "a file of measured reflectance");
    material.measured = unread_measured_paint(reader.file().parent_path() / named);
}

/// Beyond, Fresnel's term of the reflectance models is not an interface's (microfacet.glsl).
constexpr double kLeastEta = 1.0, kLargestEta = 2.5;

/// One number for all channels, or three.
glm::dvec3 read_coefficients(const JsonReader& value) {
    constexpr double kLargest = 1e6;
    if (value.is_number()) return glm::dvec3(value.number_between(0.0, kLargest));
    const auto three = numbers_between(value, 3, 0.0, kLargest);
    return {three[0], three[1], three[2]};
}

void read_medium(const JsonReader& reader, Material& material) {
    if (!reader.is_object()) reader.fail(reader.found(), "an object");
    reader.allow_only({"sigma_a_per_mm", "sigma_s_per_mm", "g", "eta", "thickness_mm", "alpha"});
    TranslucentMaterial medium;
    medium.name = material.name;
    medium.provenance = material.provenance;
    medium.sigma_a_per_mm = read_coefficients(reader["sigma_a_per_mm"]);
    if (reader.has("g")) medium.g = reader["g"].number_between(-0.9999, 0.9999);
    medium.sigma_s_prime_per_mm = read_coefficients(reader["sigma_s_per_mm"]) * (1.0 - medium.g);
    medium.eta = reader["eta"].number_between(kLeastEta, kLargestEta);
    if (reader.has("thickness_mm")) {
        medium.thickness_mm = reader["thickness_mm"].number_between(1e-9, kThickest_mm);
    }
    double alpha = kSmoothAlpha;
    if (reader.has("alpha")) {
        const ParameterInfo& info = parameter_info("alpha");
        alpha = reader["alpha"].number_between(info.low, info.high);
    }
    const std::string family = material.family;
    material = translucent_paint(medium, alpha);
    if (!family.empty()) material.family = family;
}

Json json_of_medium(const Material& material) {
    const TranslucentMaterial& medium = *material.medium;
    Json json{{"sigma_a_per_mm", json_from(medium.sigma_a_per_mm)},
              {"sigma_s_per_mm", json_from(medium.sigma_s_prime_per_mm / (1.0 - medium.g))},
              {"g", medium.g},
              {"eta", medium.eta}};
    if (medium.thickness_mm) json["thickness_mm"] = *medium.thickness_mm;
    return json;
}

/// A file of a medium alone (translucent_material.h) is a paint, too.
Material paint_of_medium(const std::string& text, const std::filesystem::path& file) {
    const TranslucentMaterial medium = parse_translucent_material(text, file);
    if (!(medium.eta >= kLeastEta && medium.eta <= kLargestEta)) {
        throw FileError(file,
                        "eta",
                        fmt::format("{:.4g}", medium.eta),
                        fmt::format("{} to {} for a paint", kLeastEta, kLargestEta));
    }
    Material material = translucent_paint(medium, medium.alpha);
    material.file = file;
    return material;
}

/// A model's parameters, no others, and all that are not optional.
void read_parameters(const JsonReader& reader, const ModelInfo& model, Material& material) {
    if (!reader.is_object()) reader.fail(reader.found(), "an object");
    const auto& known = model.parameters;
    for (const std::string& key : reader.keys()) {
        if (!model.has(key)) {
            reader.fail(
                fmt::format("parameter '{}'", key),
                fmt::format("the parameters of {}: {}", model.name, fmt::join(known, ", ")));
        }
    }
    for (const char* key : known) {
        const ParameterInfo& parameter = parameter_info(key);
        if (parameter.optional && !reader.has(key)) continue;
        read_value(reader[key], model, parameter, material);
    }
}

}  // namespace

Material read_material(const JsonReader& reader) {
    Material material;
    material.name = reader["name"].text();
    if (material.name.empty()) reader["name"].fail("empty text", "a name");
    if (reader.has("family")) material.family = reader["family"].text();
    if (reader.has("provenance")) material.provenance = reader["provenance"].text();
    const ModelInfo& model = read_model(reader);
    material.model = model.model;
    const JsonReader parameters = reader["parameters"];
    if (model.model == ReflectanceModel::measured) {
        read_measured(parameters, material);
        return material;
    }
    if (model.model == ReflectanceModel::translucent) {
        read_medium(parameters, material);
        return material;
    }
    read_parameters(parameters, model, material);
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
    const ModelInfo& model = model_info(material.model);
    if (material.model == ReflectanceModel::measured) {
        check_argument(material.measured != nullptr,
                       "json_of: paint '" + material.name + "' is measured, but by no file");
        parameters["file"] = material.measured->file.string();
    }
    if (material.model == ReflectanceModel::translucent) parameters = json_of_medium(material);
    for (const char* key : model.parameters) {
        const ParameterInfo& parameter = parameter_info(key);
        const bool as_always = value_of(parameter, material) == value_of(parameter, Material{});
        if (parameter.optional && as_always) continue;
        parameters[key] = json_of_value(parameter, material);
    }
    Json json = Json::object();
    json["name"] = material.name;
    json["family"] = material.family;
    json["model"] = model.name;
    json["parameters"] = parameters;
    json["provenance"] = material.provenance;
    return json;
}

Material read_material_file(const std::filesystem::path& file) {
    return with_measured_read(parse_material(read_text_file(file, kLargestMaterial_bytes), file));
}

Material read_paint_file(const std::filesystem::path& file) {
    if (!is_measured_file(file)) {
        return parse_material(read_text_file(file, kLargestMaterial_bytes), file);
    }
    Material material;
    material.name = file.stem().string();
    material.model = ReflectanceModel::measured;
    material.measured = unread_measured_paint(file);
    material.file = file;
    return material;
}

Material parse_material(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader reader(file, json);
    if (reader.is_object() && reader.has("kind")) return paint_of_medium(text, file);
    reader.require_format_version(kFormatVersion);
    reader.allow_only({"format_version", "name", "family", "model", "parameters", "provenance"});
    Material material = read_material(reader);
    material.file = file;
    return material;
}

namespace {

Json file_json_of(const Material& material) {
    Json json = Json::object();
    json["format_version"] = kFormatVersion;
    json.update(json_of(material));
    return json;
}

}  // namespace

std::string text_of(const Material& material) { return file_json_of(material).dump(); }

void write_material_file(const std::filesystem::path& file, const Material& material) {
    write_json_file(file, file_json_of(material));
}

}  // namespace livery
