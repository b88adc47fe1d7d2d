#include "cli/render/frame_options.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "compensation/compensation.h"
#include "core/error.h"
#include "core/json.h"
#include "jobs/calibrate/calibration_folder.h"
#include "ledger/pass_costs.h"
#include "scene/library.h"
#include "scene/mockup_mask.h"
#include "twin/description.h"

namespace livery {

DesignWhite design_white_of(const ColourCalibration& calibration,
                            double percentile,
                            const Image8& counted,
                            std::string mask) {
    DesignWhite white{design_white_luminance(calibration, percentile, counted),
                      percentile,
                      std::move(mask),
                      0,
                      pixel_shares(calibration, counted)};
    for (std::size_t i = 0; i < calibration.status.values.size(); ++i) {
        const bool valid = is_valid(static_cast<PixelStatus>(calibration.status.values[i]));
        white.pixels += valid && (counted.empty() || counted.values[i] != 0);
    }
    return white;
}

std::string text_of(const DesignWhite& white) {
    return fmt::format("design white {:.4g}, the {:g}th percentile of {} pixels: {} ({})",
                       white.y,
                       white.percentile,
                       white.pixels,
                       white.mask,
                       text_of(white.shares));
}

void tell(const DesignWhite& white, Outcome& outcome) {
    outcome.figures["design_white_y"] = white.y;
    outcome.figures["design_white_mask"] = white.mask;
    outcome.figures["design_white_pixels"] = white.pixels;
    outcome.figures["pixel_fractions"] = json_of(white.shares);
}

Json json_of(const PixelShares& shares) {
    return {{"measured", shares.measured},
            {"predicted", shares.predicted},
            {"interpolated", shares.interpolated},
            {"faded", shares.faded},
            {"black", shares.black}};
}

namespace {

/// Vertical field of view that holds a product seen from default_eye_mm().
constexpr double kWholeProduct_rad = 0.5;
/// 8K, 7680 x 4320, and a little more.
constexpr std::int64_t kMostPixels = std::int64_t{1} << 25;

}  // namespace

std::vector<Option> frame_options(FrameArguments& arguments) {
    return {
        {"--product",
         "FILE",
         "a mesh or product file, or car, player, sphere (default car)",
         &arguments.product},
        unit_option(arguments.unit),
        {"--look",
         "FILE|NAME",
         "a look file, a shipped look's name or a variant of the product (default solid-red)",
         &arguments.look},
        {"--calibration",
         "DIR",
         "calibration folder: corrects, and says where the projector stands",
         &arguments.calibration},
        {"--anyway", "", "even where it was made for another product", &arguments.anyway},
        {"--camera",
         "FILE",
         "camera file to draw from (default: the bench's projector; all of your own product)",
         &arguments.camera},
        {"--eye",
         "X,Y,Z",
         "the audience's eye, mm (default: the bench's; in front of your own product)",
         &arguments.eye},
        {"--quality",
         "LEVEL",
         "draft, normal, high or reference (default normal)",
         &arguments.quality,
         false,
         {"draft", "normal", "high", "reference"}},
        {"--levels",
         "EFFECT=LEVEL,...",
         "levels of single effects instead of the quality's (shadows=sharp,interreflection=none)",
         &arguments.levels},
        {"--budget-ms",
         "N",
         "levels of each effect with the least error that is predicted within N ms",
         &arguments.budget_ms},
        {"--swap-budget-ms",
         "N",
         "the same for what runs with every paint; both may be given",
         &arguments.swap_budget_ms},
        {"--stage",
         "STAGE",
         "radiance, or projector: the corrected input (default radiance)",
         &arguments.stage,
         false,
         {"radiance", "projector"}},
        {"--gamut",
         "HOW",
         "colours out of reach, strict: clip; preserve: keep the hue (default strict)",
         &arguments.gamut,
         false,
         {"strict", "preserve"}},
        {"--design-white",
         "PERCENT",
         "percentile of the brightest neutral that becomes 1 (default 20)",
         &arguments.design_white},
    };
}

ResolvedFrame resolve_frame(const FrameArguments& arguments, const CommonOptions& common) {
    ResolvedFrame frame;
    RenderRequest& request = frame.request;
    request.gl_device = common.gl_device();
    request.seed = static_cast<std::uint64_t>(common.seed);
    request.stage = arguments.stage == "projector" ? FrameStage::projector : FrameStage::radiance;
    const bool budgeted = arguments.budget_ms != 0.0 || arguments.swap_budget_ms != 0.0;
    if (!arguments.quality.empty() && budgeted) {
        throw std::invalid_argument("--budget-ms: found --quality as well, expected one of them");
    }
    for (const auto& [option, ms] : {std::pair("--budget-ms", arguments.budget_ms),
                                     std::pair("--swap-budget-ms", arguments.swap_budget_ms)}) {
        if (std::isfinite(ms) && ms >= 0.0) continue;
        throw std::invalid_argument(
            fmt::format("{}: found {}, expected milliseconds, more than 0", option, ms));
    }
    check_percentile("--design-white", arguments.design_white);

    // The view and the eye.
    std::optional<View> view;
    if (!arguments.camera.empty()) view = read_camera_file(arguments.camera);
    if (!arguments.calibration.empty()) {
        frame.projector = projector_view_of(arguments.calibration);
        if (!view) view = frame.projector;
        if (!view) {
            throw FileError(std::filesystem::path(arguments.calibration) / "projector.json",
                            "",
                            "no such file",
                            "the projector's camera file there, or --camera FILE");
        }
    } else if (request.stage == FrameStage::projector) {
        throw std::invalid_argument(
            "--stage projector: found no --calibration, expected the folder to correct with");
    }
    const auto product = find_product(arguments.product, parse_unit(arguments.unit));
    frame.notes = product->notes;
    if (!arguments.calibration.empty() && !arguments.anyway) {
        const auto origin = read_origin(arguments.calibration, false);
        const std::string other = origin ? another_product(*origin, *product) : "";
        if (!other.empty()) {
            throw Refused(other, "choose a calibration of this product, or say --anyway");
        }
    }
    glm::dvec3 eye_mm;
    if (const auto name = bench_of_shipped_product(arguments.product)) {
        const BenchDescription bench = read_bench_file(*name);
        if (!frame.projector) frame.projector = bench.projector.view;
        if (!view) view = bench.projector.view;
        eye_mm = bench.eye_mm;
    } else {
        // No bench was made for a product of somebody's own: the eye sees all of it, and so does
        // the picture.
        eye_mm = default_eye_mm(*product);
        const Bounds bounds = bounds_of(product->mesh);
        if (!view) {
            view = look_at(eye_mm, 0.5 * (bounds.low + bounds.high), kWholeProduct_rad, 1280, 800);
        }
    }
    if (std::int64_t{view->width} * view->height > kMostPixels) {
        throw FileError(arguments.camera,
                        "width, height",
                        fmt::format("{} x {}", view->width, view->height),
                        fmt::format("at most {} pixels to draw", kMostPixels));
    }
    request.view = *view;
    if (!arguments.calibration.empty()) {
        const ColourCalibration calibration = read_calibration(arguments.calibration);
        // A view of another size is refused where the projector's picture is asked for.
        const bool of_view = calibration.width == view->width && calibration.height == view->height;
        const Image8 mockup = of_view ? mockup_mask(product->mesh, *view) : Image8();
        frame.design_white = design_white_of(
            calibration,
            arguments.design_white,
            mockup,
            of_view ? "the mock-up" : "every valid pixel: the view has another size");
        frame.compensation =
            bake(calibration, frame.design_white->y, parse_gamut_mapping(arguments.gamut));
    }
    if (!arguments.eye.empty()) {
        const auto numbers = parse_numbers("--eye", arguments.eye, 3);
        eye_mm = {numbers[0], numbers[1], numbers[2]};
        for (int c = 0; c < 3; ++c) {
            if (std::abs(eye_mm[c]) <= kFarthest_mm) continue;
            throw std::invalid_argument(fmt::format(
                "--eye: found \"{}\", expected places within 1e9 mm of 0", arguments.eye));
        }
    }
    request.scene = make_scene(product, find_look_for(arguments.look, product->mesh), eye_mm);

    if (budgeted) {
        const PriceList list = make_price_list(request.scene,
                                               request.stage,
                                               covered_areas(request.scene, request.view),
                                               known_pass_costs().passes,
                                               known_effect_errors());
        Budget budget;
        if (arguments.budget_ms > 0.0) budget.first_frame_ms = arguments.budget_ms;
        if (arguments.swap_budget_ms > 0.0) budget.swap_ms = arguments.swap_budget_ms;
        request.levels = levels_within(list, budget);
        request.quality = nearest_quality(*request.levels);
        frame.priced = priced(list, *request.levels);
    } else if (!arguments.quality.empty()) {
        request.quality = parse_quality(arguments.quality);
    }
    if (!arguments.levels.empty()) {
        if (request.quality == Quality::reference) {
            throw std::invalid_argument(
                "--levels: found --quality reference, expected draft, normal or high");
        }
        try {
            request.levels = parse_levels(
                arguments.levels, request.levels ? *request.levels : levels_of(request.quality));
            frame.priced.reset();
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(std::string("--levels: ") + error.what());
        }
    }
    return frame;
}

void tell_design_white(const ResolvedFrame& frame, Outcome& outcome) {
    if (!frame.design_white) return;
    tell(*frame.design_white, outcome);
    outcome.text += text_of(*frame.design_white) + "\n";
}

Json json_of(const FramePlan& plan) {
    const auto or_null = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json(nullptr);
    };
    Json passes = Json::array(), skipped = Json::array();
    double total = 0.0;
    for (const PlannedPass& pass : plan.passes) {
        Json entry = {{"name", to_string(pass.id)},
                      {"ms", or_null(pass.ms)},
                      {"why", pass.why},
                      {"predicted_ms", or_null(pass.predicted_ms)},
                      {"predicted_error", or_null(pass.predicted_error)}};
        if (!pass.unpredicted_because.empty()) {
            entry["unpredicted_because"] = pass.unpredicted_because;
        }
        passes.push_back(entry);
        total += pass.ms.value_or(0.0);
    }
    for (const SkippedPass& pass : plan.skipped) {
        skipped.push_back({{"name", to_string(pass.id)},
                           {"why", pass.why},
                           {"error_bound_de00", or_null(pass.error_bound)}});
    }
    return {{"quality", to_string(plan.quality)},
            {"levels", plan.quality == Quality::reference ? "" : to_string(plan.levels)},
            {"passes", passes},
            {"skipped", skipped},
            {"ms_total", total}};
}

Json json_of(const PricedFrame& frame) {
    const auto level = [](const EffectInfo& info, const LevelPrice& price) {
        return Json{{"level", info.levels.at(static_cast<std::size_t>(price.level)).name},
                    {"ms", price.time.all_ms},
                    {"swap_ms", price.time.swap_ms},
                    {"error", price.error}};
    };
    Json effects = Json::array();
    for (const EffectPrice& price : frame.effects) {
        const EffectInfo& info = effect_info(price.effect);
        Json entry = {{"name", info.name},
                      {"called_for", price.called_for},
                      {"level", nullptr},
                      {"ms", nullptr},
                      {"error", nullptr},
                      {"error_bound", price.bound ? Json(*price.bound) : Json(nullptr)},
                      {"next", price.next ? level(info, *price.next) : Json(nullptr)},
                      {"without", price.off ? level(info, *price.off) : Json(nullptr)},
                      {"unit", "CIEDE2000, 95th percentile"}};
        if (price.called_for) {
            entry["level"] = info.levels.at(static_cast<std::size_t>(price.chosen.level)).name;
            entry["ms"] = price.own_ms;
            entry["error"] = price.added;
        }
        effects.push_back(std::move(entry));
    }
    return effects;
}

std::string text_of(const FramePlan& plan) {
    std::string text;
    for (const PlannedPass& pass : plan.passes) {
        std::string cost = pass.ms ? fmt::format("{:8.2f} ms", *pass.ms) : "";
        if (!pass.ms && pass.predicted_ms) {
            cost = fmt::format("{:8.2f} ms predicted", *pass.predicted_ms);
        }
        text += fmt::format("runs  {:<30} {:<12} {}\n", to_string(pass.id), cost, pass.why);
    }
    for (const SkippedPass& pass : plan.skipped) {
        if (is_of_other_paints(pass)) continue;
        const std::string most =
            pass.error_bound ? fmt::format(" (CIEDE2000 {:.1f} at most)", *pass.error_bound) : "";
        text += fmt::format("skips {:<30} {:<12} {}{}\n", to_string(pass.id), "", pass.why, most);
    }
    return text;
}

}  // namespace livery
