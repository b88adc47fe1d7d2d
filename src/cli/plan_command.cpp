// livery plan

#include <memory>

#include "cli/frame_options.h"
#include "ledger/predictions.h"

namespace livery {

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
        const std::string note = predict(plan, request.scene, request.view, progress);
        Outcome outcome;
        outcome.figures = json_of(plan);
        double total = 0.0;
        bool complete = true;
        for (const PlannedPass& pass : plan.passes) {
            total += pass.predicted_ms.value_or(0.0);
            complete = complete && pass.predicted_ms.has_value();
        }
        outcome.figures["ms_total"] = nullptr;
        outcome.figures["predicted_ms_total"] = complete ? Json(total) : Json(nullptr);
        if (!note.empty()) outcome.figures["note"] = note;
        outcome.text = text_of(plan) + frame.budget_note + (note.empty() ? "" : note + "\n");
        tell_design_white(frame, outcome);
        tell_notes(frame.notes, outcome);
        return outcome;
    };
    return command;
}

}  // namespace livery
