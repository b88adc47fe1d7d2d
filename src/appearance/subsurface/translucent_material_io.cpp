#include <algorithm>

#include "appearance/parameter_table.h"
#include "appearance/subsurface/translucent_material.h"
#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr int kNewestVersion = 1;
constexpr const char* kFolder = "materials/translucent";

/// One number for all channels, or three.
glm::dvec3 coefficients(const JsonReader& value) {
    if (value.is_number()) return glm::dvec3(value.number_between(0.0, kLargestCoefficient_per_mm));
    const auto three = numbers_between(value, 3, 0.0, kLargestCoefficient_per_mm);
    return {three[0], three[1], three[2]};
}

Json json_of(const glm::dvec3& coefficients) {
    const bool grey = coefficients.x == coefficients.y && coefficients.y == coefficients.z;
    return grey ? Json(coefficients.x) : json_from(coefficients);
}

}  // namespace

bool same_medium(const TranslucentMaterial& a, const TranslucentMaterial& b) {
    return a.sigma_a_per_mm == b.sigma_a_per_mm &&
           a.sigma_s_prime_per_mm == b.sigma_s_prime_per_mm && a.g == b.g && a.eta == b.eta &&
           a.thickness_mm == b.thickness_mm;
}

ScatteringMedium medium_of(const TranslucentMaterial& material, int channel) {
    check_argument(channel >= 0 && channel < 3, "medium_of: a channel from 0 to 2");
    return {material.sigma_a_per_mm[channel],
            material.sigma_s_prime_per_mm[channel] / (1.0 - material.g),
            material.g,
            material.eta,
            material.thickness_mm};
}

TranslucentMaterial read_translucent_material(const std::filesystem::path& file_or_name) {
    std::filesystem::path file = file_or_name;
    // A bare name is a shipped material's, whatever lies in the folder where the program runs.
    if (file.extension() != ".json" && !file.has_parent_path()) {
        std::string stem = file.string();
        std::replace(stem.begin(), stem.end(), ' ', '-');
        const auto names = shipped_names(kFolder);
        if (std::find(names.begin(), names.end(), stem) == names.end()) {
            throw FileError(file, "name", "no such material", list_of(names) + ", or a file");
        }
        file = shipped_path(std::filesystem::path(kFolder) / (stem + ".json"));
    }
    return parse_translucent_material(read_text_file(file, 1u << 20u), file);
}

TranslucentMaterial parse_translucent_material(const std::string& text,
                                               const std::filesystem::path& file) {
    const Json content = parse_json(text, file);
    const JsonReader json(file, content);
    json.require_format_version(kNewestVersion);
    json.allow_only({"format_version",
                     "kind",
                     "name",
                     "family",
                     "sigma_a_per_mm",
                     "sigma_s_prime_per_mm",
                     "g",
                     "eta",
                     "thickness_mm",
                     "alpha",
                     "provenance"});
    if (const std::string kind = json["kind"].text(); kind != "translucent") {
        json["kind"].fail("'" + kind + "'", "'translucent'");
    }
    TranslucentMaterial material;
    material.name = json["name"].text();
    if (json.has("family")) material.family = json["family"].text();
    material.sigma_a_per_mm = coefficients(json["sigma_a_per_mm"]);
    material.sigma_s_prime_per_mm = coefficients(json["sigma_s_prime_per_mm"]);
    if (json.has("g")) material.g = json["g"].number_between(-kLargestG, kLargestG);
    material.eta = json["eta"].number_between(0.5, 4.0);
    if (json.has("thickness_mm")) {
        material.thickness_mm = json["thickness_mm"].number_between(1e-9, kThickest_mm);
    }
    if (json.has("alpha")) {
        const ParameterInfo& alpha = parameter_info("alpha");
        material.alpha = json["alpha"].number_between(alpha.low, alpha.high);
    }
    if (json.has("provenance")) material.provenance = json["provenance"].text();
    for (int channel = 0; channel < 3; ++channel) {
        // Strongly forward scattering multiplies what a file says of sigma_s'.
        if (medium_of(material, channel).sigma_s_per_mm <= kLargestCoefficient_per_mm) continue;
        json["sigma_s_prime_per_mm"].fail("more than 1000000 per mm over 1 - g", "less");
    }
    return material;
}

void write_translucent_material(const std::filesystem::path& file,
                                const TranslucentMaterial& material) {
    for (int channel = 0; channel < 3; ++channel) check_medium(medium_of(material, channel));
    Json json = {{"format_version", kNewestVersion},
                 {"kind", "translucent"},
                 {"name", material.name},
                 {"sigma_a_per_mm", json_of(material.sigma_a_per_mm)},
                 {"sigma_s_prime_per_mm", json_of(material.sigma_s_prime_per_mm)},
                 {"g", material.g},
                 {"eta", material.eta}};
    if (material.family != TranslucentMaterial{}.family) json["family"] = material.family;
    if (material.thickness_mm) json["thickness_mm"] = *material.thickness_mm;
    if (material.alpha != kSmoothAlpha) json["alpha"] = material.alpha;
    if (!material.provenance.empty()) json["provenance"] = material.provenance;
    write_json_file(file, json);
}

}  // namespace livery
