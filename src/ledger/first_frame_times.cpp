#include "ledger/first_frame_times.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include <fmt/format.h>

#include "compensation/compensation.h"
#include "jobs/synthetic_calibration.h"
#include "radiance/renderer.h"
#include "scene/library.h"
#include "twin/description.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

/// One part after the other, in the order in which they run.
class Parts {
  public:
    template <typename Work>
    void time(const std::string& name, const Work& work) {
        const auto start = Clock::now();
        work();
        add(name, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    void add(const std::string& name, double ms) {
        const auto known = std::find_if(
            parts_.begin(), parts_.end(), [&](const auto& part) { return part.first == name; });
        (known == parts_.end() ? parts_.emplace_back(name, std::vector<double>()) : *known)
            .second.push_back(ms);
    }
    /// The whole first, then its parts where they are asked for.
    void append_levels(const std::string& name, bool with_parts, LedgerEffect& effect) const {
        std::vector<double> whole(parts_.front().second.size(), 0.0);
        for (const auto& [part, ms] : parts_) {
            for (std::size_t k = 0; k < whole.size(); ++k) whole[k] += ms[k];
        }
        effect.levels.push_back(level_of(name, whole));
        if (!with_parts) return;
        for (const auto& [part, ms] : parts_) {
            effect.levels.push_back(level_of(fmt::format("{}: {}", name, part), ms));
        }
    }

  private:
    std::vector<std::pair<std::string, std::vector<double>>> parts_;
};

void run_once(const View& view,
              Quality quality,
              const glm::dvec3& eye_mm,
              std::optional<CompensationTable>& table,
              Parts& parts) {
    Scene scene;
    parts.time("mesh load", [&] { scene.product = find_product("car"); });
    parts.time("environment load", [&] {
        scene = make_scene(scene.product, find_look(shipped_looks().front()), eye_mm, nullptr);
    });
    const auto geometry = std::make_shared<const FrameGeometry>(
        scene.product, view, Progress{}, sub_samples_of(quality));
    parts.add("tree of triangles", geometry->tracer_ms);
    parts.add("surface map", geometry->ms - geometry->tracer_ms);
    RadianceRenderer renderer(geometry);
    FramePlan plan = plan_frame(scene, quality, FrameStage::radiance);
    parts.time("light", [&] { renderer.solve(scene, plan); });
    parts.time("programs and what they read", [&] { renderer.prepare(scene, plan); });
    ImageF radiance;
    parts.time("shading", [&] {
        renderer.render(scene, plan);
        radiance = renderer.read_back();
    });
    if (!table) {
        const ColourCalibration calibration = synthetic_calibration(geometry->map.coverage);
        table = bake(calibration, design_white_luminance(calibration, kDesignWhitePercentile, {}));
    }
    parts.time("correction", [&] { compensate(*table, radiance); });
}

}  // namespace

LedgerEffect measure_first_frame(const Progress& progress) {
    constexpr int kRepeats = 5;
    struct Case {
        int width, height;
        Quality quality;
        bool with_parts;
    };
    LedgerEffect effect{"load to first frame", {}};
    const BenchDescription bench = read_bench_file("default");
    for (const Case& c : {Case{1280, 800, Quality::draft, true},
                          Case{1280, 800, Quality::normal, true},
                          Case{3840, 2160, Quality::draft, false}}) {
        const View view = resized(bench.projector.view, c.width, c.height);
        const std::string name = fmt::format("{}x{}, {}", c.width, c.height, to_string(c.quality));
        std::optional<CompensationTable> table;
        Parts parts;
        for (int k = 0; k < kRepeats; ++k) {
            progress.update(static_cast<double>(k) / kRepeats, "loading for " + name);
            progress.check_stop();
            run_once(view, c.quality, bench.eye_mm, table, parts);
        }
        parts.append_levels(name, c.with_parts, effect);
    }
    return effect;
}

}  // namespace livery
