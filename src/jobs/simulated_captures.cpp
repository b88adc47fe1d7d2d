#include "jobs/simulated_captures.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "capture/patterns_folder.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/json.h"
#include "core/paths.h"
#include "scene/library.h"
#include "scene/view.h"
#include "twin/bench.h"

namespace livery {

namespace {

Image8 uniform(const BenchDescription& bench, int red, int green, int blue) {
    Image8 drive(bench.projector.view.width, bench.projector.view.height, 3);
    const int rgb[] = {red, green, blue};
    for (std::size_t i = 0; i < drive.values.size(); ++i) {
        drive.values[i] = static_cast<std::uint8_t>(rgb[i % 3]);
    }
    return drive;
}

/// The lit projector pixel nearest the middle of the mock-up.
glm::dvec2 measuring_point(const Bench& bench) {
    const Image8& lit = bench.truth().lit;
    std::vector<glm::dvec2> places;
    for (int y = 0; y < lit.height; ++y) {
        for (int x = 0; x < lit.width; ++x) {
            if (lit.at(x, y)) places.emplace_back(x, y);
        }
    }
    if (places.empty()) {
        throw Refused("the bench's projector does not light the mock-up",
                      "check its pose in the bench file");
    }
    const glm::dvec2 middle = std::accumulate(places.begin(), places.end(), glm::dvec2(0.0)) /
                              static_cast<double>(places.size());
    std::erase_if(places, [&](glm::dvec2 at) {
        return bench.truth().edge.at(static_cast<int>(at.x), static_cast<int>(at.y)) != 0;
    });
    const auto nearest = std::min_element(places.begin(), places.end(), [&](auto a, auto b) {
        return glm::dot(a - middle, a - middle) < glm::dot(b - middle, b - middle);
    });
    return (nearest == places.end() ? middle : *nearest) + 0.5;
}

void write_primaries(const std::filesystem::path& file,
                     const Bench& bench,
                     const BenchPorts& ports) {
    const glm::dvec2 pixel = measuring_point(bench);
    const auto reading = [&](int red, int green, int blue) {
        ports.show(uniform(bench.description(), red, green, blue));
        return json_from(ports.measure_xyz(pixel));
    };
    write_json_file(file,
                    {{"format_version", 1},
                     {"primaries_xyz",
                      {{"red", reading(255, 0, 0)},
                       {"green", reading(0, 255, 0)},
                       {"blue", reading(0, 0, 255)},
                       {"black", reading(0, 0, 0)}}},
                     {"measured_at_px", {pixel.x, pixel.y}},
                     {"note", "simulated colorimeter at the eye, on the mock-up"}});
}

}  // namespace

SimulatedCaptures photograph_patterns(const SimulatedCapturesRequest& request,
                                      const Progress& progress) {
    const PatternsManifest manifest = read_patterns_manifest(request.patterns / "manifest.json");
    const View& projector = request.bench.projector.view;
    if (manifest.projector_width != projector.width ||
        manifest.projector_height != projector.height) {
        throw FileError(request.patterns / "manifest.json",
                        "projector",
                        fmt::format("{}x{}", manifest.projector_width, manifest.projector_height),
                        fmt::format("the bench's {}x{}", projector.width, projector.height));
    }
    make_output_folder(request.out);
    Bench bench(request.bench, find_product(request.bench.product.string()), progress);
    const BenchPorts ports = bench.ports();

    // Until every photograph is there: a stop must not leave an older manifest over a mixture.
    std::filesystem::remove(request.out / "manifest.json");

    SimulatedCaptures result;
    Json captures = Json::array();
    for (const PatternEntry& pattern : manifest.patterns) {
        progress.update(
            static_cast<double>(result.photographs) / static_cast<double>(manifest.patterns.size()),
            "photographing " + pattern.role);
        const Image8 shown =
            read_pattern(request.patterns / pattern.file, projector.width, projector.height);
        ports.show(shown);
        const Photograph photograph = ports.photograph(request.exposure_s);
        const std::string name = fmt::format("{:03}.exr", result.photographs);
        write_exr(request.out / name, photograph.image);
        // The pattern lies beside the photograph so that the folder can be moved as a whole, under
        // a name of ours: what the manifest calls it may lie anywhere.
        const std::string pattern_name = fmt::format("{:03}.png", result.photographs);
        write_png(request.out / pattern_name, shown);
        Json entry = {{"file", name},
                      {"pattern", pattern_name},
                      {"role", pattern.role},
                      {"exposure_s", photograph.exposure_s},
                      {"transfer", "linear"},
                      {"black_level", photograph.black_level},
                      {"saturates_at", photograph.saturates_at}};
        if (!pattern.drive.empty()) entry["drive"] = pattern.drive;
        captures.push_back(entry);
        result.exposure_s = photograph.exposure_s;
        ++result.photographs;
    }
    write_json_file(request.out / "manifest.json",
                    {{"format_version", 1},
                     {"projector", {projector.width, projector.height}},
                     {"captures", captures}});
    write_primaries(request.out / "camera-to-xyz.json", bench, ports);
    write_camera_file(request.out / "projector.json", bench.description().projector.view);
    return result;
}

}  // namespace livery
