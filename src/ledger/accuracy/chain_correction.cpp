#include "ledger/accuracy/chain_correction.h"

#include <array>
#include <memory>

#include <fmt/format.h>

#include "compensation/compensation.h"
#include "core/colour.h"
#include "core/hash.h"
#include "core/paths.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/comparison.h"
#include "ledger/accuracy/chain_precision.h"
#include "ledger/accuracy/chain_steps.h"
#include "radiance/renderer.h"
#include "scene/library.h"
#include "scene/mockup_mask.h"
#include "twin/bench.h"

namespace livery {

namespace {

struct WayToCalibrate {
    const char* mode_name;
    ColourMode mode;
    int photographs;  ///< of each colour picture
};
constexpr std::array kCalibrations{WayToCalibrate{"paper", ColourMode::paper, 2},
                                   WayToCalibrate{"robust", ColourMode::robust, 1},
                                   WayToCalibrate{"robust", ColourMode::robust, 2},
                                   WayToCalibrate{"robust", ColourMode::robust, 4}};
/// As `livery calibrate` is without options: its design white and gamut serve all rows.
constexpr std::size_t kUsual = 2;
constexpr std::array kMappings{GamutMapping::strict, GamutMapping::preserve};

struct WantedLight {
    ImageF working, xyz;
    ComparisonMasks masks;
};

/// Errors of all looks together.
struct Judge {
    const Bench& bench;
    const std::vector<WantedLight>& looks;
    double white_y;

    template <typename DriveOf>
    std::vector<float> errors(bool reachable, const DriveOf& drive_of) const {
        std::vector<float> all;
        for (const WantedLight& look : looks) {
            const Comparison comparison = compare_xyz(look.xyz,
                                                      bench.observe_xyz(drive_of(look.working)),
                                                      white_y * d65_xyz(),
                                                      look.masks);
            const std::vector<float> some = interior_errors(comparison, look.masks, reachable);
            all.insert(all.end(), some.begin(), some.end());
        }
        return all;
    }
};

std::vector<ImageF> drawn(const std::vector<std::string>& looks,
                          const BenchDescription& description,
                          const std::shared_ptr<const Product>& product,
                          Quality quality,
                          const Progress& progress) {
    RadianceRenderer renderer(product, description.projector.view, progress);
    std::shared_ptr<const Environment> environment;
    std::vector<ImageF> pictures;
    for (const std::string& name : looks) {
        const Look look = find_look_for(name, product->mesh);
        const Scene scene = make_scene(product, look, description.eye_mm, environment);
        environment = scene.environment;
        FramePlan plan = plan_frame(scene, quality, FrameStage::radiance);
        renderer.render(scene, plan, progress);
        pictures.push_back(renderer.read_back());
    }
    return pictures;
}

/// In the order of kCalibrations. Places are photographed once, in a calibration before them.
std::vector<CalibrationResult> calibrations(Bench& bench,
                                            const std::shared_ptr<const Product>& product,
                                            const Progress& progress) {
    CalibrationSettings request = settings_of(bench.description(), product);
    request.data_sheets.reset();
    request.turned_as.reset();
    request.projector = bench.description().projector.view;
    request.shots = 1;
    const BenchPorts ports = bench.ports();
    request.map = calibrate_through_ports(ports, request, progress.part(0.0, 0.5)).map;
    std::vector<CalibrationResult> all;
    for (const WayToCalibrate& one : kCalibrations) {
        request.mode = one.mode;
        request.shots = one.photographs;
        all.push_back(calibrate_through_ports(ports, request, Progress{{}, progress.stop}));
    }
    return all;
}

/// 255 where all of them correct.
Image8 corrected_by_all(const std::vector<CalibrationResult>& all) {
    Image8 mask = corrected_pixels(all.front().calibration);
    for (const CalibrationResult& one : all) {
        const Image8 its = corrected_pixels(one.calibration);
        for (std::size_t i = 0; i < mask.values.size(); ++i) mask.values[i] &= its.values[i];
    }
    return mask;
}

}  // namespace

std::vector<float> interior_errors(const Comparison& comparison,
                                   const ComparisonMasks& masks,
                                   bool reachable) {
    std::vector<float> errors;
    for (std::size_t i = 0; i < comparison.de00.values.size(); ++i) {
        const bool interior =
            masks.lit.values[i] != 0 && masks.valid.values[i] != 0 && masks.edge.values[i] == 0;
        if (interior && (masks.reachable.values[i] != 0) == reachable) {
            errors.push_back(comparison.de00.values[i]);
        }
    }
    return errors;
}

std::vector<ChainRow> correction_rows(const std::string& bench_name) {
    const std::string against = "the wanted light, simulated";
    const std::string on = fmt::format(", bench {} (simulated)", bench_name);
    std::vector<ChainRow> rows{{"correction" + on, "none", against}};
    for (const WayToCalibrate& one : kCalibrations) {
        rows.push_back({"correction" + on,
                        fmt::format("{}, {} photograph{} a picture",
                                    one.mode_name,
                                    one.photographs,
                                    one.photographs == 1 ? "" : "s"),
                        against});
    }
    for (const char* reach : {"gamut, colours within reach", "gamut, colours beyond reach"}) {
        for (const GamutMapping mapping : kMappings) {
            rows.push_back({reach + on, to_string(mapping), against});
        }
    }
    return rows;
}

void measure_corrections(const BenchDescription& description,
                         const std::vector<std::string>& looks,
                         Quality quality,
                         std::vector<ChainRow>& rows,
                         const Progress& progress) {
    const auto product = find_product(description.product.string());
    Bench bench(description, product, progress.part(0.0, 0.1));
    const std::vector<CalibrationResult> all =
        calibrations(bench, product, progress.part(0.1, 0.7));
    const ColourCalibration& usual = all.at(kUsual).calibration;
    const double white_y = design_white_luminance(
        usual, kDesignWhitePercentile, mockup_mask(product->mesh, description.projector.view));
    const Image8 valid = corrected_by_all(all);
    std::vector<WantedLight> wanted;
    for (ImageF& picture : drawn(looks, description, product, quality, progress.part(0.7, 0.9))) {
        WantedLight& one = wanted.emplace_back();
        one.working = std::move(picture);
        one.xyz = xyz_from_wanted(one.working, white_y);
        one.masks = {
            bench.truth().lit, bench.truth().edge, valid, bench.reachable(one.xyz), Image8()};
    }

    const Judge judge{bench, wanted, white_y};
    auto row = rows.begin();
    set_errors(*row++, judge.errors(true, [](const ImageF& working) {
        return srgb_from_working(working);
    }));
    for (const CalibrationResult& one : all) {
        progress.check_stop();
        const CompensationTable table = bake(one.calibration, white_y);
        row->ms = 1000.0 * (one.solve_seconds + one.predict_seconds);
        set_errors(*row++, judge.errors(true, [&](const ImageF& working) {
            return compensate(table, working);
        }));
    }
    for (const bool reachable : {true, false}) {
        for (const GamutMapping mapping : kMappings) {
            const CompensationTable table = bake(usual, white_y, mapping);
            row->ms = compensation_ms(table, wanted.front().working);
            set_errors(*row++, judge.errors(reachable, [&](const ImageF& working) {
                return compensate(table, working);
            }));
        }
    }
}

std::vector<ChainPart> correction_parts(const AccuracyOptions& options) {
    std::vector<ChainPart> parts;
    for (const std::string name : {"default", "hard"}) {
        const auto description = [name, seed = options.seed] {
            BenchDescription bench = read_bench_file(name);
            bench.seed = seed;
            return bench;
        };
        ChainPart& part = parts.emplace_back();
        part.slow = true;
        part.rows = correction_rows(name);
        part.inputs = [description, name] {
            // Its file, what that is based on, and what is drawn
            Hasher hasher;
            for (const char* file : {"calibration/default.json", "calibration/hard.json"}) {
                hasher.add(read_text_file(shipped_path(file)));
            }
            const BenchDescription bench = description();
            hasher.add(fmt::format("{} {}", name, bench.seed));
            hasher.add(hash_of(accuracy_scenes(true).front()));
            for (const Spectrum& spectrum : bench.camera.sensitivities) {
                hasher.add(std::span<const double>(spectrum));
            }
            return hasher.hex();
        };
        part.measure = [description](std::vector<ChainRow>& rows, const Progress& progress) {
            measure_corrections(
                description(), {"solid-red", "silver-metallic"}, Quality::normal, rows, progress);
        };
    }
    return parts;
}

}  // namespace livery
