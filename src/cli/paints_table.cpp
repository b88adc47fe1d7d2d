#include "cli/paints_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "appearance/material_json.h"
#include "appearance/model_table.h"
#include "core/parallel.h"

namespace livery {

namespace {

/// "measured" or "designed": the first word of a provenance.
std::string origin_of(const Material& material) {
    const std::string& text = material.provenance;
    for (const char* origin : {"measured", "designed"}) {
        if (text.starts_with(std::string(origin) + ":")) return origin;
    }
    return "";
}

std::string flop_text(const std::optional<double>& flop) {
    return flop ? fmt::format("{:.1f}", *flop) : "-";
}

/// "32, 53, 33"; nothing is -0.
std::string whole(const glm::dvec3& v) {
    const auto rounded = [](double value) { return std::lround(value); };
    return fmt::format("{}, {}, {}", rounded(v.x), rounded(v.y), rounded(v.z));
}

Json lab_numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::vector<ListedPaint> listed(const std::vector<Material>& paints, const Progress& progress) {
    std::vector<ListedPaint> list(paints.size());
    progress.update(0.0, "figures of paints");
    const std::vector<PassCost> costs = known_pass_costs().passes;
    parallel_for(paints.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            list[i] = {paints[i], paint_figures(paints[i]), paint_cost(paints[i], costs)};
        }
    });
    return list;
}

std::string list_of(const std::vector<ListedPaint>& paints) {
    std::size_t widest = 5;
    for (const ListedPaint& paint : paints) {
        widest = std::max(widest, paint.material.name.size());
    }
    const bool near = std::any_of(
        paints.begin(), paints.end(), [](const ListedPaint& paint) { return paint.de00; });
    std::string text = fmt::format("{:<{}}  {:<9} {:<9} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6}{}\n",
                                   "paint",
                                   widest,
                                   "family",
                                   "origin",
                                   "L* 45",
                                   "a*",
                                   "b*",
                                   "flop",
                                   "GU 20",
                                   "GU 60",
                                   near ? "  CIEDE2000" : "");
    for (const ListedPaint& paint : paints) {
        const glm::dvec3& face = paint.figures.lab[kFaceAngle];
        text +=
            fmt::format("{:<{}}  {:<9} {:<9} {:>6.1f} {:>6.1f} {:>6.1f} {:>6} {:>6.1f} {:>6.1f}",
                        paint.material.name,
                        widest,
                        paint.material.family,
                        origin_of(paint.material),
                        face.x,
                        face.y,
                        face.z,
                        flop_text(paint.figures.flop),
                        paint.figures.gloss_20,
                        paint.figures.gloss_60);
        text += paint.de00 ? fmt::format("  {:>9.2f}\n", *paint.de00) : "\n";
    }
    return text;
}

std::string page_of(const ListedPaint& paint) {
    const Material& material = paint.material;
    std::string text =
        fmt::format("{} ({}), model {}\n{}\n\n",
                    material.name,
                    material.family.empty() ? "no family" : material.family,
                    model_info(material.model).name,
                    material.provenance.empty() ? "origin not told" : material.provenance);
    text += "light at 45 degrees, D65, 10 degree observer:\n";
    text += fmt::format("  {:<18} {:>8} {:>8} {:>8}\n", "from the mirror", "L*", "a*", "b*");
    for (std::size_t k = 0; k < kAspecularAngles_deg.size(); ++k) {
        const glm::dvec3& lab = paint.figures.lab[k];
        text += fmt::format("  {:>3.0f} degrees        {:>8.2f} {:>8.2f} {:>8.2f}\n",
                            kAspecularAngles_deg[k],
                            lab.x,
                            lab.y,
                            lab.z);
    }
    text += fmt::format("flop index: {}\n",
                        paint.figures.flop ? fmt::format("{:.2f}", *paint.figures.flop)
                                           : "none, too dark at 45 degrees");
    text += fmt::format("gloss at 20 degrees: {:.1f} GU, at 60 degrees: {:.1f} GU\n",
                        paint.figures.gloss_20,
                        paint.figures.gloss_60);
    if (has_glints(material)) {
        text += fmt::format("glints: {:.4g} flakes on a square millimetre, {}\n",
                            material.glint_density_per_mm2,
                            glint_scale_text(material));
    }
    text += paint.cost.ns_a_pixel
                ? fmt::format("shading: {:.1f} ns a pixel, predicted\n", *paint.cost.ns_a_pixel)
                : fmt::format("shading: cost unknown, {}\n", paint.cost.why_not);
    if (paint.de00)
        text += fmt::format("CIEDE2000 from the colour asked for: {:.2f}\n", *paint.de00);
    return text;
}

Json json_of(const ListedPaint& paint) {
    const Material& material = paint.material;
    Json json = json_of(material);
    json["file"] = material.file.string();
    json["origin"] = origin_of(material);
    json["aspecular_deg"] = kAspecularAngles_deg;
    json["lab"] = Json::array();
    for (const glm::dvec3& lab : paint.figures.lab) json["lab"].push_back(lab_numbers(lab));
    json["lab_45"] = lab_numbers(paint.figures.lab[kFaceAngle]);
    json["flop_index"] = paint.figures.flop ? Json(*paint.figures.flop) : Json(nullptr);
    json["gloss_20"] = paint.figures.gloss_20;
    json["gloss_60"] = paint.figures.gloss_60;
    json["shading_ns_a_pixel"] =
        paint.cost.ns_a_pixel ? Json(*paint.cost.ns_a_pixel) : Json(nullptr);
    if (!paint.cost.ns_a_pixel) json["shading_unknown_because"] = paint.cost.why_not;
    if (paint.de00) json["de00"] = *paint.de00;
    return json;
}

std::string markdown_of(const std::vector<ListedPaint>& paints) {
    std::string text =
        "| paint | family | origin | model | L\\*a\\*b\\* at 15 degrees | 25 | 45 | 75 | 110 | "
        "flop | "
        "gloss 20 | 60 |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const ListedPaint& paint : paints) {
        text += fmt::format("| {} | {} | {} | `{}` |",
                            paint.material.name,
                            paint.material.family,
                            origin_of(paint.material),
                            model_info(paint.material.model).name);
        for (const glm::dvec3& lab : paint.figures.lab) {
            text += fmt::format(" {} |", whole(lab));
        }
        text += fmt::format(" {} | {:.0f} | {:.0f} |\n",
                            flop_text(paint.figures.flop),
                            paint.figures.gloss_20,
                            paint.figures.gloss_60);
    }
    return text;
}

}  // namespace livery
