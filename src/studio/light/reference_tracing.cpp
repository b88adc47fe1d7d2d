#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "studio/light/lighting_panel.h"
#include "studio/studio.h"

namespace livery {

namespace {

constexpr double kFade_s = 0.6;

ReferenceTracing& tracing(const Studio& studio) { return studio.panels.of<ReferenceTracing>(); }

FramePicture<Image8> with_texture(TexturePool& textures, std::shared_ptr<const Image8> drive) {
    auto slot = textures.lend(drive->width, drive->height);
    slot->texture.upload(std::span<const std::uint8_t>(opaque(*drive).values));
    slot->ready = Fence::after_everything_so_far();
    return {std::move(drive), std::move(slot)};
}

/// The frame that was drawn, with the traced picture in its place.
std::shared_ptr<const FinishedFrame> frame_of(const TracedFrame& traced,
                                              const FinishedFrame& drawn,
                                              TexturePool& textures) {
    auto pictures = std::make_shared<FramePictures>();
    pictures->drive = with_texture(textures, traced.drive);
    pictures->radiance[0] = {traced.radiance_working, nullptr};
    auto frame = std::make_shared<FinishedFrame>(drawn);
    const auto& slot = pictures->drive.slot;
    frame->drive_texture = slot->texture.name();
    frame->ready = {slot, &slot->ready};
    frame->fade_s = kFade_s;
    frame->plan = traced.plan;
    frame->compensation = traced.compensation;
    frame->shade_ms = frame->compensate_ms = 0.0;
    frame->ms_total = traced.ms_total;
    frame->pictures = std::move(pictures);
    frame->done_at = std::chrono::steady_clock::now();
    return frame;
}

std::string text_of(const TracedFrame& traced) {
    std::string text = fmt::format(
        "The mock-up shows the reference, to within {:.0f}% of each pixel's luminance: {:.0f} "
        "paths "
        "a pixel.",
        100.0 * traced.error,
        traced.mean_samples);
    if (traced.unresolved_fraction >= 0.001) {
        text += fmt::format(" {:.1f}% of its pixels are not as near.",
                            100.0 * traced.unresolved_fraction);
    }
    return text;
}

}  // namespace

std::string why_not_traced(const Studio& studio) {
    if (!studio.frame || !studio.setup) return "There is no picture on the mock-up yet.";
    if (!studio.frame->unfinished.empty()) return "Its light is still being solved.";
    if (studio.wiping) return "Two looks are shown beside one another.";
    if (is_editing_locked(studio)) return "A vote is presented.";
    return "";
}

void trace_reference_of(Studio& studio) {
    if (const std::string why = why_not_traced(studio); !why.empty()) {
        throw Refused("the reference cannot be traced now: " + why, "wait, or change that");
    }
    ReferenceTracing& state = tracing(studio);
    if (!state.thread) state.thread = std::make_unique<ReferenceThread>(wake_main_thread);
    TraceRequest request;
    request.number = state.asked = studio.frame->number;
    request.scene = studio.frame->scene;
    request.setup = studio.setup;
    state.thread->trace(std::move(request));
}

bool is_tracing(const Studio& studio) {
    const ReferenceTracing& state = tracing(studio);
    return state.thread && state.thread->state().running;
}

void take_traced(Studio& studio) {
    ReferenceTracing& state = tracing(studio);
    if (!state.thread) return;
    // Something else is to be shown
    if (state.asked != studio.frame_number) state.thread->stop();
    const auto newest = state.thread->state().newest;
    if (!newest || newest == state.taken) return;
    state.taken = newest;
    // Of something that was shown before
    if (!studio.frame || newest->number != studio.frame_number ||
        newest->number != studio.frame->number) {
        return;
    }
    if (!state.textures) state.textures = std::make_unique<TexturePool>(TexelFormat::rgba8);
    studio.results->take(frame_of(*newest, *studio.frame, *state.textures));
    studio.frame = studio.results->newest_drawn();
}

void draw_reference_row(Studio& studio) {
    const ReferenceTracing& state = tracing(studio);
    const auto now = state.thread ? state.thread->state() : ReferenceThread::State();
    if (now.running) {
        if (button("Stop", "reference:stop")) state.thread->stop();
        ImGui::SameLine();
        progress_bar(now.fraction, fmt::format("Reference, to within {:.0f}%", 100.0 * now.error));
    } else {
        const std::string why = why_not_traced(studio);
        begin_disabled(!why.empty());
        if (button("Trace the reference", "reference")) {
            try {
                trace_reference_of(studio);
            } catch (const Refused&) {
                notify_failure(studio, "The reference was not traced.", std::current_exception());
            }
        }
        end_disabled();
        tooltip(why.empty()
                    ? "The path tracer's picture of this look, corrected like any other, takes the "
                      "mock-up's place when it is done: first to within 6%, then to within 2%. It "
                      "takes minutes on a few cores, beside everything else. The next change ends "
                      "it."
                    : why);
    }
    if (shows_reference(studio) && state.taken) dim_text(text_of(*state.taken));
    if (!now.problem.empty()) warning_text(sentence(now.problem));
}

}  // namespace livery
