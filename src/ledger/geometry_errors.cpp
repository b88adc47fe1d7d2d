#include "ledger/geometry_errors.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "compensation/compensation.h"
#include "core/colour.h"
#include "core/parallel.h"
#include "core/random.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/comparison.h"
#include "radiance/renderer.h"
#include "scene/library.h"
#include "scene/mockup_mask.h"
#include "twin/bench.h"

namespace livery {

namespace {

constexpr const char* kBench = "default";
constexpr const char* kLook = "blue-metallic";

/// What the program believes: where the projector stands and how its lens is, and the mesh.
struct Belief {
    View projector;
    std::shared_ptr<const Product> product;
};

struct Perturbation {
    std::string effect, level;
    std::function<Belief(const Belief& truth)> apply;
};

/// All three axes alike, so that nothing is left out: across, along and around the view.
const glm::dvec3 kDirection = glm::normalize(glm::dvec3(1.0, 1.0, 1.0));

/// The mock-up turned about its middle, and moved, both in the projector's frame.
Belief with_pose_error(const Belief& truth, double angle_rad, double shift_mm) {
    const Bounds bounds = bounds_of(truth.product->mesh);
    const Rigid3& view_from_world = truth.projector.view_from_world;
    const glm::dvec3 middle = view_from_world * (0.5 * (bounds.low + bounds.high));
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), angle_rad, kDirection));
    Belief belief = truth;
    belief.projector.view_from_world =
        Rigid3{turn, middle - turn * middle + shift_mm * kDirection} * view_from_world;
    return belief;
}

/// The lens alone, the pose as it is.
Belief with_lens_error(const Belief& truth, double focal, double principal_px, double k1) {
    Belief belief = truth;
    belief.projector.focal_px *= 1.0 + focal;
    belief.projector.principal_px += principal_px * glm::normalize(glm::dvec2(1.0));
    belief.projector.distortion[0] += k1;
    return belief;
}

/// A displacement that is smooth in space: plane waves of `feature_mm`, each component with an rms
/// of `rms_mm`, so that the surface is off by that along its normal. Normals turn with it.
Belief with_mesh_error(const Belief& truth, double rms_mm, double feature_mm, std::uint64_t seed) {
    constexpr int kWaves = 48;
    struct Wave {
        glm::dvec3 per_mm, amplitude_mm;
        double phase;
    };
    Random random(seed, 14);
    std::vector<Wave> waves(kWaves);
    for (Wave& wave : waves) {
        glm::dvec3 direction, amplitude;
        for (int k = 0; k < 3; ++k) {
            direction[k] = random.normal();
            amplitude[k] = random.normal();
        }
        wave.per_mm = 2.0 * std::numbers::pi / feature_mm * glm::normalize(direction);
        wave.amplitude_mm = rms_mm * std::sqrt(2.0 / kWaves) * amplitude;
        wave.phase = 2.0 * std::numbers::pi * random.uniform();
    }
    auto product = std::make_shared<Product>(*truth.product);
    Mesh& mesh = product->mesh;
    parallel_for(mesh.positions_mm.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 at(mesh.positions_mm[i]), normal(mesh.normals[i]);
            glm::dvec3 moved = at, turned = normal;
            for (const Wave& wave : waves) {
                const double phase = glm::dot(wave.per_mm, at) + wave.phase;
                moved += std::sin(phase) * wave.amplitude_mm;
                // Normals follow the inverse transpose of 1 + J, to first order 1 - J^T.
                turned -= std::cos(phase) * glm::dot(wave.amplitude_mm, normal) * wave.per_mm;
            }
            mesh.positions_mm[i] = glm::vec3(moved);
            mesh.normals[i] = glm::vec3(glm::normalize(turned));
        }
    });
    return {truth.projector, product};
}

/// A mesh that is too large, about the mock-up's middle.
Belief with_size_error(const Belief& truth, double factor) {
    auto product = std::make_shared<Product>(*truth.product);
    const Bounds bounds = bounds_of(product->mesh);
    const glm::vec3 middle(0.5 * (bounds.low + bounds.high));
    for (glm::vec3& position : product->mesh.positions_mm) {
        position = middle + static_cast<float>(1.0 + factor) * (position - middle);
    }
    return {truth.projector, product};
}

std::vector<Perturbation> perturbations(bool quick, std::uint64_t seed) {
    std::vector<Perturbation> all = {
        {"none", "as it is", [](const Belief& truth) { return truth; }}};
    const auto add = [&](const char* effect,
                         const char* level,
                         std::vector<double> amounts,
                         const std::function<Belief(const Belief&, double)>& apply) {
        if (quick && amounts.size() > 2) amounts = {amounts.front(), amounts.back()};
        for (const double amount : amounts) {
            all.push_back({effect,
                           fmt::format(fmt::runtime(level), amount),
                           [=](const Belief& truth) { return apply(truth, amount); }});
        }
    };
    add("pose: turned", "{} degrees", {0.02, 0.05, 0.1, 0.2, 0.5}, [](const Belief& t, double a) {
        return with_pose_error(t, a * std::numbers::pi / 180.0, 0.0);
    });
    add("pose: moved", "{} mm", {0.05, 0.1, 0.2, 0.5, 1.0}, [](const Belief& t, double a) {
        return with_pose_error(t, 0.0, a);
    });
    add("lens: focal length", "{}%", {0.05, 0.1, 0.3, 1.0}, [](const Belief& t, double a) {
        return with_lens_error(t, 0.01 * a, 0.0, 0.0);
    });
    add("lens: principal point", "{} px", {0.3, 1.0, 3.0}, [](const Belief& t, double a) {
        return with_lens_error(t, 0.0, a, 0.0);
    });
    add("lens: distortion k1", "{}", {0.003, 0.01, 0.03}, [](const Belief& t, double a) {
        return with_lens_error(t, 0.0, 0.0, a);
    });
    add("mesh", "{} mm rms", {0.03, 0.1, 0.3, 1.0}, [seed](const Belief& t, double a) {
        return with_mesh_error(t, a, 20.0, seed);
    });
    add("size", "{}%", {0.05, 0.1, 0.3, 1.0}, [](const Belief& t, double a) {
        return with_size_error(t, 0.01 * a);
    });
    return all;
}

}  // namespace

GeometryErrorLedger measure_geometry_errors(GlDevice device,
                                            bool quick,
                                            std::uint64_t seed,
                                            const Progress& progress) {
    using Clock = std::chrono::steady_clock;
    GeometryErrorLedger result;
    result.bench = kBench;
    result.look = kLook;
    const HeadlessContext context(device);
    result.renderer = context.renderer();

    // The bench, its colours calibrated once: they belong to the projector's pixels, whatever the
    // pose is thought to be.
    BenchDescription description = read_bench_file(kBench);
    description.seed = seed;
    const Belief truth{description.projector.view, find_product(description.product.string())};
    Bench bench(description, truth.product, progress, EyePicture::traced);
    const ColourCalibration calibration =
        calibrate_through_ports(bench.ports(), settings_of(description, truth.product), progress)
            .calibration;
    const double white_y = design_white_luminance(
        calibration, kDesignWhitePercentile, mockup_mask(truth.product->mesh, truth.projector));
    const CompensationTable table = bake(calibration, white_y);

    const Look look = find_look_for(kLook, part_names(truth.product->mesh));
    std::shared_ptr<const Environment> environment;
    const Progress quiet{nullptr, progress.stop};
    const auto drawn = [&](const Belief& belief, const View& view) {
        const Scene scene = make_scene(belief.product, look, description.eye_mm, environment);
        environment = scene.environment;
        RadianceRenderer renderer(belief.product, view, quiet);
        FramePlan plan = plan_frame(scene, Quality::normal, FrameStage::radiance);
        renderer.render(scene, plan, quiet);
        return renderer.read_back();
    };
    const ImageF wanted_xyz = xyz_from_wanted(drawn(truth, bench.eye().view), white_y);
    const ComparisonMasks masks = masks_of_eye(
        bench, corrected_pixels(calibration), corrected_pixels(calibration, true), wanted_xyz);

    const std::vector<Perturbation> all = perturbations(quick, seed);
    for (std::size_t k = 0; k < all.size(); ++k) {
        progress.update(static_cast<double>(k) / static_cast<double>(all.size()),
                        fmt::format("{}, {}", all[k].effect, all[k].level));
        const auto start = Clock::now();
        GeometryErrorRow& row = result.rows.emplace_back();
        row.effect = all[k].effect;
        row.level = all[k].level;
        const Belief belief = all[k].apply(truth);
        const ErrorStatistics off = picture_offset(truth.projector,
                                                   truth.product->mesh,
                                                   belief.projector,
                                                   belief.product->mesh,
                                                   bench.truth().lit);
        row.off_median_px = off.median;
        row.off_p95_px = off.p95;
        const Image8 drive = compensate(table, drawn(belief, belief.projector));
        const Comparison comparison =
            compare_xyz(wanted_xyz, bench.observe_from_eye(drive), white_y * d65_xyz(), masks);
        row.seen = comparison.interior;
        row.edge_band = comparison.edge;
        row.ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    }
    return result;
}

std::vector<LedgerEffect> effects_of(const GeometryErrorLedger& result) {
    std::vector<LedgerEffect> effects;
    for (const GeometryErrorRow& row : result.rows) {
        if (effects.empty() || effects.back().name != row.effect) {
            effects.push_back({row.effect, {}});
        }
        LedgerLevel& level = effects.back().levels.emplace_back();
        level.name = row.level;
        level.ms = level.fastest_ms = row.ms;
        level.repeats = 1;
        level.work_items = static_cast<double>(row.seen.pixels);
        level.error = row.seen.median;
        level.error_p95 = row.seen.p95;
        level.unit = "CIEDE2000";
    }
    return effects;
}

namespace {

template <typename Line>
std::string lines_of(const GeometryErrorLedger& result, const Line& line) {
    std::string text;
    for (const GeometryErrorRow& row : result.rows) text += line(row);
    return text;
}

}  // namespace

std::string markdown_of(const GeometryErrorLedger& result) {
    return fmt::format(
               "Look `{}` on the simulated bench `{}`, median / 95th percentile. OpenGL: {}.\n\n"
               "| what is off | by | picture off its place, px | CIEDE2000 | within 2 px of an "
               "edge |\n| --- | --- | --- | --- | --- |\n",
               result.look,
               result.bench,
               result.renderer) +
           lines_of(result, [](const GeometryErrorRow& row) {
               return fmt::format(
                   "| {} | {} | {:.2f} / {:.2f} | {:.2f} / {:.2f} | {:.2f} / {:.2f} |\n",
                   row.effect,
                   row.level,
                   row.off_median_px,
                   row.off_p95_px,
                   row.seen.median,
                   row.seen.p95,
                   row.edge_band.median,
                   row.edge_band.p95);
           });
}

}  // namespace livery
