// livery brdf

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "cli/reflectance_options.h"
#include "core/colour.h"
#include "core/paths.h"

namespace livery {

namespace {

bool is_valid(const glm::dvec3& working) {
    return std::isfinite(working.x) && std::isfinite(working.y) && std::isfinite(working.z) &&
           std::min({working.x, working.y, working.z}) >= 0.0;
}

}  // namespace

Command brdf_command() {
    struct Arguments : ReflectanceArguments {
        std::string in, out;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "brdf";
    command.summary = "reflectance of a paint for given directions, per steradian, no cosine";
    command.example = "livery brdf --material \"solid red\" --in dirs.csv --out values.csv";
    command.options = reflectance_options(*arguments);
    command.options.insert(command.options.begin() + 1,
                           {{"--in",
                             "FILE",
                             "CSV with the columns theta_i,phi_i,theta_o,phi_o in radians",
                             &arguments->in,
                             true,
                             {}},
                            {"--out",
                             "FILE",
                             "CSV with the columns r,g,b: linear signed Rec.709 under D65",
                             &arguments->out,
                             true,
                             {}}});
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        const Material material = find_material(arguments->material);
        const auto pairs = read_directions_csv(arguments->in);
        const auto values =
            reflectance_values(material, pairs, reflectance_settings(*arguments, common), progress);
        std::size_t invalid = 0;
        fmt::memory_buffer text;
        fmt::format_to(std::back_inserter(text), "r,g,b\n");
        for (const glm::dvec3& working : values) {
            if (!is_valid(working)) ++invalid;
            const glm::dvec3 rec709 = rec709_from_working() * working;
            fmt::format_to(std::back_inserter(text), "{},{},{}\n", rec709.x, rec709.y, rec709.z);
        }
        progress.check_stop();
        write_text_file(arguments->out, {text.data(), text.size()});
        Outcome outcome;
        outcome.figures = {{"count", values.size()},
                           {"invalid", invalid},
                           {"material", material.name},
                           {"precision", arguments->precision},
                           {"space", "linear Rec.709, D65"},
                           {"file", arguments->out}};
        outcome.text = fmt::format("{}: {} values, {} of them not finite or negative; wrote {}\n",
                                   material.name,
                                   values.size(),
                                   invalid,
                                   arguments->out);
        return outcome;
    };
    return command;
}

}  // namespace livery
