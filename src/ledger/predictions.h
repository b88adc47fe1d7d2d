// What a frame will cost on this machine: from the last `livery bench` here, never from a guess.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/frame_plan.h"
#include "scene/view.h"

namespace livery {

/// One kind of pass as the last ledger has it: milliseconds for so many work items.
struct PassCost {
    PassId pass;  ///< as cost_key() has it
    Quality quality = Quality::normal;
    double ms = 0.0;
    double work_items = 0.0;  ///< 0: cost does not depend on the picture
    /// At the pass that ends the frame: the whole frame's CIEDE2000 against the path tracer, its
    /// 95th percentile over the mock-up.
    std::optional<double> error;
};

/// Where the ledger leaves its costs: the user's folder.
std::filesystem::path ledger_file();
void write_pass_costs(const std::filesystem::path& file,
                      const std::string& renderer,
                      const std::vector<PassCost>& costs);
/// Nothing when `livery bench` never ran on this machine. Throws FileError for a malformed file.
std::optional<std::vector<PassCost>> read_pass_costs(const std::filesystem::path& file);
/// The same of ledger_file(); nothing, too, without a home folder to keep one in.
std::optional<std::vector<PassCost>> known_pass_costs();
/// The same of its text.
std::vector<PassCost> parse_pass_costs(const std::string& text, const std::filesystem::path& file);

/// What the cost of a pass depends on: the same of any part, artwork and light, "shade:clearcoat".
PassId cost_key(const PassId& pass);

/// Fills predicted_ms and the reasons for those that stay empty; returns a note for people (empty
/// when everything is predicted). Counts the mock-up's pixels with a coarse ray cast.
std::string predict(FramePlan& plan,
                    const Scene& scene,
                    const View& view,
                    const Progress& progress = {});

/// The same from costs at hand, for a plan whose passes know their work items (a drawn frame's):
/// casts no ray.
std::string predict_drawn(FramePlan& plan, const std::vector<PassCost>& costs);

struct BudgetChoice {
    Quality quality = Quality::draft;
    std::string why;
};
/// The best quality whose predicted frame fits. Throws Refused without a ledger.
BudgetChoice quality_within(const Scene& scene,
                            const View& view,
                            FrameStage stage,
                            double budget_ms);

}  // namespace livery
