// livery render

#include <memory>

#include <fmt/format.h>

#include "cli/frame_options.h"

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
        int samples = 0, bounces = 0;
        double seconds = 0.0;
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
         {"--spp", "N", "reference: samples a pixel", &arguments->samples, false, {}},
         {"--seconds", "S", "reference: stop after S seconds", &arguments->seconds, false, {}},
         {"--bounces",
          "N",
          "reference: scatterings after the first (default 0)",
          &arguments->bounces,
          false,
          {}},
         {"--out", "FILE", "picture, .exr (linear Rec.709) or .png", &arguments->out, true, {}}});
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        check_frame_file(
            arguments->out,
            arguments->frame.stage == "projector" ? FrameStage::projector : FrameStage::radiance);
        ResolvedFrame frame = resolve_frame(arguments->frame, common);
        RenderRequest& request = frame.request;
        if (arguments->samples < 0 || arguments->seconds < 0.0 || arguments->bounces < 0) {
            throw std::invalid_argument(
                "--spp, --seconds, --bounces: found a negative number, expected 0 or more");
        }
        request.backend = arguments->backend == "reference" || request.quality == Quality::reference
                              ? RenderBackend::reference
                              : RenderBackend::gl;
        if (request.backend == RenderBackend::gl &&
            (arguments->samples > 0 || arguments->seconds > 0.0)) {
            throw std::invalid_argument(
                "--spp, --seconds: found --backend gl, expected --backend reference");
        }
        request.samples_per_pixel = arguments->samples;
        request.seconds = arguments->seconds;
        request.bounces = arguments->bounces;
        if (frame.compensation) request.compensation = &*frame.compensation;
        const RenderedFrame rendered = render_frame(request, progress);
        write_frame(arguments->out, rendered, request.stage);

        const double covered = covered_fraction(rendered.radiance_working);
        Outcome outcome;
        outcome.figures = json_of(rendered.plan);
        outcome.figures["covered_fraction"] = covered;
        outcome.figures["ms_total"] = rendered.ms_total;
        outcome.figures["renderer"] = rendered.renderer;
        outcome.figures["file"] = arguments->out;
        if (rendered.samples_per_pixel > 0) outcome.figures["spp"] = rendered.samples_per_pixel;
        outcome.text = text_of(rendered.plan) + frame.budget_note +
                       fmt::format("{:.0f} ms in all with {}; wrote {}\n",
                                   rendered.ms_total,
                                   rendered.renderer,
                                   arguments->out);
        tell_notes(frame.notes, outcome);
        if (covered == 0.0) {
            const std::string warning = nothing_seen(request.scene.product->mesh);
            outcome.figures["warnings"] = {warning};
            outcome.text += "warning: " + warning + "\n";
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
