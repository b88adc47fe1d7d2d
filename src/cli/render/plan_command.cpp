// livery plan

#include <memory>
#include <string>

#include "cli/render/frame_options.h"
#include "ledger/budget.h"

namespace livery {

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
