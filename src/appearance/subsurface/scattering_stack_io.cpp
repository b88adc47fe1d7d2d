#include <stdexcept>

#include <fmt/format.h>

#include "appearance/subsurface/scattering_stack.h"
#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr int kNewestStackVersion = 1;
constexpr double kThinnest_mm = 1e-9;

ScatteringMedium layer_of(const JsonReader& json, double eta, bool last) {
    json.allow_only(
        {"sigma_a_per_mm", "sigma_s_per_mm", "sigma_s_prime_per_mm", "g", "thickness_mm", "eta"});
    ScatteringMedium layer;
    layer.eta = eta;
    // Rays would bend and mirror between the layers, which no model here knows.
    if (json.has("eta") && json["eta"].number_between(0.5, 4.0) != eta) {
        json["eta"].fail("another index than the stack's", fmt::format("{} in all layers", eta));
    }
    if (json.has("g")) layer.g = json["g"].number_between(-kLargestG, kLargestG);
    layer.sigma_a_per_mm = json["sigma_a_per_mm"].number_between(0.0, kLargestCoefficient_per_mm);
    if (json.has("sigma_s_prime_per_mm")) {
        const JsonReader reduced = json["sigma_s_prime_per_mm"];
        if (json.has("sigma_s_per_mm")) {
            reduced.fail("beside sigma_s_per_mm", "one or the other");
        }
        layer.sigma_s_per_mm =
            reduced.number_between(0.0, kLargestCoefficient_per_mm) / (1.0 - layer.g);
        if (layer.sigma_s_per_mm > kLargestCoefficient_per_mm) {
            reduced.fail("more than 1000000 per mm over 1 - g", "less");
        }
    } else {
        layer.sigma_s_per_mm =
            json["sigma_s_per_mm"].number_between(0.0, kLargestCoefficient_per_mm);
    }
    if (json.has("thickness_mm")) {
        layer.thickness_mm = json["thickness_mm"].number_between(kThinnest_mm, kThickest_mm);
    } else if (!last) {
        json.fail("no thickness_mm", "a thickness of every layer but the last");
    }
    return layer;
}

}  // namespace

ScatteringStack read_scattering_stack(const std::filesystem::path& file) {
    return parse_scattering_stack(read_text_file(file, 1u << 20u), file);
}

ScatteringStack parse_scattering_stack(const std::string& text, const std::filesystem::path& file) {
    const Json content = parse_json(text, file);
    const JsonReader json(file, content);
    json.require_format_version(kNewestStackVersion);
    json.allow_only({"format_version", "kind", "name", "eta", "layers", "provenance"});
    if (json.has("kind") && json["kind"].text() != "layers") {
        json["kind"].fail("'" + json["kind"].text() + "'", "'layers', or none");
    }
    for (const char* words : {"name", "provenance"}) {
        if (json.has(words)) json[words].text();
    }
    const double eta = json["eta"].number_between(0.5, 4.0);
    const JsonReader layers = json["layers"];
    ScatteringStack stack;
    for (std::size_t k = 0; k < layers.size(); ++k) {
        stack.layers.push_back(layer_of(layers.at(k), eta, k + 1 == layers.size()));
    }
    try {
        check_stack(stack);
    } catch (const std::invalid_argument& error) {
        throw FileError(file, "layers", error.what(), "layers that fit one another");
    }
    return stack;
}

}  // namespace livery
