// livery render
// livery plan
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "cli/render/frame_options.h"
#include "core/colour.h"
#include "jobs/render/render.h"
#include "ledger/budget.h"

namespace livery {

namespace {

/// Of the picture's area, how much the product fills.
double covered_fraction(const ImageF& picture) {
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
        sum += static_cast<double>(picture.values[4 * i + 3]);
    }
    return sum / static_cast<double>(picture.pixel_count());
}

/// Covered pixels whose colour is NaN or infinite; a picture for the projector has them black.
std::size_t not_finite_pixels(const ImageF& picture) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
        const float* v = picture.values.data() + 4 * i;
        count += std::isfinite(v[0] + v[1] + v[2]) ? 0u : 1u;
    }
    return count;
}

/// The middle one of the covered pixels' relative half widths.
double median_confidence(const RenderedFrame& rendered) {
    std::vector<double> relative;
    const glm::dvec3 weights = glm::transpose(xyz_from_working())[1];
    for (std::size_t i = 0; i < rendered.radiance_working.pixel_count(); ++i) {
        const float* v = rendered.radiance_working.values.data() + 4 * i;
        if (v[3] == 0.0f) continue;
        const double luminance = glm::dot(weights, glm::dvec3(v[0], v[1], v[2]));
        const auto half_width = static_cast<double>(rendered.traced->confidence.values[i]);
        if (luminance > 0.0) relative.push_back(half_width / luminance);
    }
    if (relative.empty()) return 0.0;
    const auto middle = relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2);
    std::nth_element(relative.begin(), middle, relative.end());
    return *middle;
}

/// How many samples it took, and how sure they are.
void tell_traced(const RenderedFrame& rendered, double error, Outcome& outcome) {
    const ReferenceResult& traced = *rendered.traced;
    const double confidence = median_confidence(rendered);
    outcome.figures["spp"] = traced.samples_per_pixel;
    outcome.figures["mean_spp"] = traced.mean_samples;
    outcome.figures["median_relative_confidence_95"] = confidence;
    outcome.text += fmt::format("{:.0f} samples a pixel, {} at most; median 95% confidence {:.2g}%",
                                traced.mean_samples,
                                traced.samples_per_pixel,
                                100.0 * confidence);
    if (error > 0.0) {
        outcome.figures["unresolved_fraction"] = traced.unresolved_fraction;
        outcome.text += fmt::format("; {:.2g}% of the pixels did not reach {:.2g}%",
                                    100.0 * traced.unresolved_fraction,
                                    100.0 * error);
    }
    outcome.text += "\n";
}

/// The picture in the place of the look's light, drawn as it is seen from the eye or the camera.
void project(const std::string& picture,
             const std::string& projector,
             bool from_camera,
             ResolvedFrame& frame) {
    RenderRequest& request = frame.request;
    if (request.backend != RenderBackend::reference || request.stage == FrameStage::projector) {
        throw std::invalid_argument(
            "--projects: found --backend gl or --stage projector, expected --backend reference and "
            "--stage radiance");
    }
    const Mesh& mesh = request.scene.product->mesh;
    if (!projector.empty()) frame.projector = read_camera_file(projector);
    if (!frame.projector) {
        throw std::invalid_argument(
            "--projects: found a product without a bench, expected --projector FILE or "
            "--calibration DIR");
    }
    if (!from_camera) {
        const auto [low, high] = bounds_of(mesh);
        if (request.scene.eye_in_world_mm == 0.5 * (low + high)) {
            throw std::invalid_argument(
                "--eye: found the middle of the product, expected a place to see it from");
        }
        request.view = view_of_all(
            mesh, request.scene.eye_in_world_mm, request.view.width, request.view.height);
    }
    request.projected = read_projected_picture(picture, *frame.projector, mesh);
    request.scene.lights.clear();
    request.scene.environment.reset();
    request.scene.eye_in_world_mm = centre_in_world(request.view);
}

std::string nothing_seen(const Mesh& mesh) {
    const auto [low, high] = bounds_of(mesh);
    return fmt::format(
        "the picture is empty: the view meets nothing of the product, which reaches from "
        "({:.0f}, {:.0f}, {:.0f}) to ({:.0f}, {:.0f}, {:.0f}) mm; give a --camera that looks at it",
        low.x,
        low.y,
        low.z,
        high.x,
        high.y,
        high.z);
}

}  // namespace

Command render_command() {
    struct Arguments {
        FrameArguments frame;
        std::string backend = "gl", out;
        std::string projects, projector;
        int samples = 0, bounces = kReferenceBounces;
        double seconds = 0.0, error = 0.0;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "render";
    command.summary = "draw a look in the projector's view, shaded for the audience's eyes";
    command.example = "livery render --look blue-metallic --out blue.png";
    command.options = frame_options(arguments->frame);
    command.options.insert(
        command.options.end(),
        {{"--backend",
          "NAME",
          "gl, or reference: the path tracer (default gl)",
          &arguments->backend,
          false,
          {"gl", "reference"}},
         {"--spp", "N", "reference: samples a pixel", &arguments->samples},
         {"--seconds", "S", "reference: stop after S seconds", &arguments->seconds},
         {"--error",
          "E",
          "reference: stop where 95% confidence reaches E of a pixel's luminance",
          &arguments->error},
         {"--bounces",
          "N",
          fmt::format("reference: scatterings after the first (default {}; 0: direct light only)",
                      kReferenceBounces),
          &arguments->bounces},
         {"--projects",
          "FILE",
          "reference: picture (.exr: light, .png: sRGB) that a projector throws on the product in "
          "the place of the look's lights; seen from the eye, or --camera",
          &arguments->projects},
         {"--projector",
          "FILE",
          "that projector's camera file (default: the calibration's, else the bench's)",
          &arguments->projector},
         {"--out", "FILE", "picture, .exr (linear Rec.709) or .png", &arguments->out, true}});
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        check_frame_file(
            arguments->out,
            arguments->frame.stage == "projector" ? FrameStage::projector : FrameStage::radiance);
        ResolvedFrame frame = resolve_frame(arguments->frame, common);
        RenderRequest& request = frame.request;
        if (arguments->samples < 0 || arguments->seconds < 0.0 || arguments->error < 0.0 ||
            arguments->bounces < 0) {
            throw std::invalid_argument(
                "--spp, --seconds, --error, --bounces: found a negative number, expected 0 or "
                "more");
        }
        request.backend = arguments->backend == "reference" || request.quality == Quality::reference
                              ? RenderBackend::reference
                              : RenderBackend::gl;
        if (request.backend == RenderBackend::gl &&
            (arguments->samples > 0 || arguments->seconds > 0.0 || arguments->error > 0.0)) {
            throw std::invalid_argument(
                "--spp, --seconds, --error: found --backend gl, expected --backend reference");
        }
        request.samples_per_pixel = arguments->samples;
        request.seconds = arguments->seconds;
        request.error = arguments->error;
        request.bounces = arguments->bounces;
        if (!arguments->projector.empty() && arguments->projects.empty()) {
            throw std::invalid_argument("--projector: found no --projects, expected what it shows");
        }
        if (!arguments->projects.empty()) {
            project(
                arguments->projects, arguments->projector, !arguments->frame.camera.empty(), frame);
        }
        if (frame.compensation) request.compensation = &*frame.compensation;
        RenderedFrame rendered = render_frame(request, progress);
        say_why(request.scene, rendered.plan);
        write_frame(arguments->out, rendered, request.stage);

        const double covered = covered_fraction(rendered.radiance_working);
        Outcome outcome;
        outcome.figures = json_of(rendered.plan);
        outcome.figures["covered_fraction"] = covered;
        outcome.figures["ms_total"] = rendered.ms_total;
        outcome.figures["renderer"] = rendered.renderer;
        outcome.figures["file"] = arguments->out;
        outcome.text = text_of(rendered.plan);
        if (frame.priced) {
            outcome.figures["effects"] = json_of(*frame.priced);
            outcome.text += text_of(*frame.priced);
        }
        if (rendered.traced) tell_traced(rendered, arguments->error, outcome);
        outcome.text += fmt::format("{:.0f} ms in all with {}; wrote {}\n",
                                    rendered.ms_total,
                                    rendered.renderer,
                                    arguments->out);
        tell_design_white(frame, outcome);
        tell_notes(frame.notes, outcome);
        std::vector<std::string> warnings;
        if (covered == 0.0) warnings.push_back(nothing_seen(request.scene.product->mesh));
        const std::size_t not_finite = not_finite_pixels(rendered.radiance_working);
        outcome.figures["not_finite_pixels"] = not_finite;
        if (not_finite > 0) {
            warnings.push_back(fmt::format(
                "{} pixels are no number; they are black on the projector", not_finite));
        }
        if (!warnings.empty()) outcome.figures["warnings"] = warnings;
        for (const std::string& warning : warnings) outcome.text += "warning: " + warning + "\n";
        return outcome;
    };
    return command;
}

namespace {

std::string origin_text(CostOrigin origin) {
    switch (origin) {
        case CostOrigin::shipped:
            return "Times are those that come with the program, for as many threads as there are "
                   "here. livery bench --suite costs --quick scales them to this machine.\n";
        case CostOrigin::scaled:
            return "Times are those that come with the program, scaled to this machine.\n";
        case CostOrigin::measured:
            return "Times are those of the last livery bench on this machine.\n";
    }
    return "";
}

}  // namespace

Command plan_command() {
    const auto arguments = std::make_shared<FrameArguments>();
    Command command;
    command.name = "plan";
    command.summary = "which effects the scene calls for, and what each would cost here";
    command.example = "livery plan --look blue-metallic --quality high";
    command.options = frame_options(*arguments);
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        const ResolvedFrame frame = resolve_frame(*arguments, common);
        const RenderRequest& request = frame.request;
        FramePlan plan = request.levels ? plan_frame(request.scene, *request.levels, request.stage)
                                        : plan_frame(request.scene, request.quality, request.stage);
        const PassCosts costs = known_pass_costs();
        std::optional<PricedFrame> frame_price = frame.priced;
        std::string note;
        if (plan.quality == Quality::reference) {
            note = predict_times(plan, costs.passes);
        } else {
            const PriceList list =
                make_price_list(request.scene,
                                request.stage,
                                covered_areas(request.scene, request.view, progress),
                                costs.passes,
                                known_effect_errors());
            note = predict(plan, list);
            if (!frame_price) frame_price = priced(list, plan.levels);
        }
        say_why(request.scene, plan);
        const PredictedTime time = predicted_time(plan);
        Outcome outcome;
        outcome.figures = json_of(plan);
        outcome.figures["ms_total"] = nullptr;
        outcome.figures["predicted_ms_total"] = time.complete ? Json(time.all_ms) : Json(nullptr);
        outcome.figures["predicted_from"] = to_string(costs.origin);
        if (!note.empty()) outcome.figures["note"] = note;
        outcome.text = text_of(plan);
        if (frame_price) {
            outcome.figures["effects"] = json_of(*frame_price);
            outcome.figures["predicted_error"] = frame_price->error;
            outcome.text += text_of(*frame_price);
        }
        outcome.text += origin_text(costs.origin);
        if (!note.empty()) outcome.text += note + "\n";
        tell_design_white(frame, outcome);
        tell_notes(frame.notes, outcome);
        return outcome;
    };
    return command;
}

}  // namespace livery
