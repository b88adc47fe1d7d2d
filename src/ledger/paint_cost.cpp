#include "ledger/paint_cost.h"

#include <fmt/format.h>

#include "appearance/model_table.h"

namespace livery {

PaintCost paint_cost(const Material& material, const std::optional<std::vector<PassCost>>& costs) {
    if (!costs) return {std::nullopt, "no bench has run on this machine"};
    const PassId shading(PassKind::shade, "", material.model, has_glints(material));
    for (const PassCost& cost : *costs) {
        if (cost.pass == shading && cost.work_items > 0.0) {
            return {1e6 * cost.ms / cost.work_items, ""};
        }
    }
    return {std::nullopt,
            fmt::format("the last bench shaded nothing with {}{}",
                        model_info(material.model).name,
                        shading.glints ? "+glints" : "")};
}

}  // namespace livery
